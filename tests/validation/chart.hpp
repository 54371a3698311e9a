// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Line charts for the pictures of the validation.
#pragma once

#include <optional>

#include "postprocess/picture/picture.hpp"

namespace talus::validation {

/// Points of one curve. Colours and marks are numbered; equal numbers look equal.
struct Series {
  std::string name;  // empty: not in the legend
  std::vector<double> x, y;
  int colour = 0;
  bool line = true;
  bool marks = false;
  bool dashed = false;
  double width = 3;
  double mark_size = 7;
  void add(double x_at, double y_at) {
    x.push_back(x_at);
    y.push_back(y_at);
  }
};

/// Marks without a line, and a line with marks, of points that are yet to be added.
inline Series marks_of(const std::string& name, int colour, double size) {
  return {name, {}, {}, colour, false, true, false, 3, size};
}
inline Series marked_line(const std::string& name, int colour) { return {name, {}, {}, colour, true, true}; }

struct Limits {
  double low, high;
};

struct Chart {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  bool equal_scales = false;   // one metre is as long across as up
  std::optional<Limits> x, y;  // else what the series span
  std::vector<Series> series;
};

/// One chart as a PNG's bytes.
std::string png_of(const Chart& chart, int width = 1400, int height = 1000);

/// Charts with equal scales below one another, each as high as its limits ask for.
std::string png_of_panels(const std::vector<Chart>& panels, int width = 1400);

/// An empty chart, and one that is logarithmic both ways.
Chart plain_chart(const std::string& title, const std::string& x_label, const std::string& y_label);
Chart log_chart(const std::string& title, const std::string& x_label, const std::string& y_label);

/// "quadratic (order 1.93)": a series of errors over cell sizes, with marks and the observed order in its name.
Series convergence(const Series& errors);

/// A dashed line of a given order from the first of the errors, for the eye.
Series slope_line(double order, const Series& errors);

}  // namespace talus::validation
