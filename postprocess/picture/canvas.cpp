// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/picture/picture.hpp"

#include <cairo.h>

#include <cstring>
#include <new>
#include <stdexcept>

#include "common/deflate.hpp"

namespace talus::postprocess {
namespace {

constexpr const char* font = "DejaVu Sans";

void set_colour(cairo_t* cairo, const Colour& c, double opacity = 1) {
  cairo_set_source_rgba(cairo, c.r, c.g, c.b, opacity);
}

void trace(cairo_t* cairo, const Pixels& points) {
  cairo_new_path(cairo);
  for (const auto& [x, y] : points) cairo_line_to(cairo, x, y);
  if (points.size() > 2 && points.front() == points.back()) cairo_close_path(cairo);
}

void stroke(cairo_t* cairo, const Pen& pen) {
  set_colour(cairo, pen.colour, pen.opacity);
  cairo_set_line_width(cairo, pen.width);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_set_dash(cairo, pen.dashes.data(), static_cast<int>(pen.dashes.size()), 0);
  cairo_stroke(cairo);
}

void set_font(cairo_t* cairo, const TextStyle& style) {
  cairo_select_font_face(cairo, font, CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, style.size);
}

/// Cairo draws no more after a fault, and says so only when asked.
void require_drawn(cairo_status_t status) {
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS) throw std::runtime_error(std::string("Cairo: ") + cairo_status_to_string(status));
}

constexpr int effort = 6;  // of libdeflate, for PNG

/// A number as PNG writes it, in four bytes.
std::string big_endian(std::size_t number) {
  return {static_cast<char>(number >> 24), static_cast<char>(number >> 16), static_cast<char>(number >> 8),
          static_cast<char>(number)};
}

/// Adds a chunk of PNG: its length without the four letters of its kind, both, and their checksum.
void put_chunk(std::string& bytes, const std::string& kind_and_data) {
  bytes += big_endian(kind_and_data.size() - 4) + kind_and_data + big_endian(crc32_of(kind_and_data));
}

}  // namespace

struct Canvas::Handles {
  cairo_surface_t* surface;
  cairo_t* cairo;
};

Canvas::Canvas(int width, int height) : handles_(std::make_unique<Handles>()) {
  handles_->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  handles_->cairo = cairo_create(handles_->surface);
  set_colour(handles_->cairo, {1, 1, 1});
  cairo_paint(handles_->cairo);
}

Canvas::Canvas(Canvas&& other) noexcept = default;

Canvas::~Canvas() {
  if (!handles_) return;
  cairo_destroy(handles_->cairo);
  cairo_surface_destroy(handles_->surface);
}

void Canvas::line(const Pixels& points, const Pen& pen) {
  trace(handles_->cairo, points);
  stroke(handles_->cairo, pen);
}

void Canvas::fill(const Pixels& points, const Colour& colour) {
  trace(handles_->cairo, points);
  set_colour(handles_->cairo, colour);
  cairo_fill(handles_->cairo);
}

void Canvas::fill(const Box& box, const Colour& colour) {
  cairo_rectangle(handles_->cairo, box.x, box.y, box.width, box.height);
  set_colour(handles_->cairo, colour);
  cairo_fill(handles_->cairo);
}

void Canvas::frame(const Box& box, const Pen& pen) {
  cairo_rectangle(handles_->cairo, box.x, box.y, box.width, box.height);
  stroke(handles_->cairo, pen);
}

double Canvas::text_width(const std::string& words, const TextStyle& style) {
  set_font(handles_->cairo, style);
  cairo_text_extents_t extents;
  cairo_text_extents(handles_->cairo, words.c_str(), &extents);
  return extents.x_advance;
}

double Canvas::text(const std::string& words, double x, double y, const TextStyle& style) {
  auto* cairo = handles_->cairo;
  const double width = text_width(words, style);
  const double shift = style.align == Align::left ? 0 : style.align == Align::centre ? -0.5 * width : -width;
  cairo_save(cairo);
  cairo_translate(cairo, x, y);
  cairo_rotate(cairo, -style.angle);
  cairo_new_path(cairo);
  cairo_move_to(cairo, shift, 0);
  cairo_text_path(cairo, words.c_str());
  if (style.halo > 0) {
    set_colour(cairo, {1, 1, 1}, 0.85);
    cairo_set_line_width(cairo, 2 * style.halo);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_dash(cairo, nullptr, 0, 0);
    cairo_stroke_preserve(cairo);
  }
  set_colour(cairo, style.colour);
  cairo_fill(cairo);
  cairo_restore(cairo);
  return width;
}

void Canvas::image(int x, int y, int width, int height, const std::vector<std::uint32_t>& pixels) {
  auto* part = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(part));
  unsigned char* data = cairo_image_surface_get_data(part);
  for (std::size_t row = 0; data != nullptr && row < static_cast<std::size_t>(height); ++row) {
    std::memcpy(data + row * stride, pixels.data() + row * static_cast<std::size_t>(width),
                static_cast<std::size_t>(width) * 4);
  }
  cairo_surface_mark_dirty(part);
  cairo_set_source_surface(handles_->cairo, part, x, y);
  cairo_paint(handles_->cairo);
  cairo_surface_destroy(part);
}

void Canvas::clip(const Box& box) {
  cairo_save(handles_->cairo);
  cairo_rectangle(handles_->cairo, box.x, box.y, box.width, box.height);
  cairo_clip(handles_->cairo);
}

void Canvas::unclip() { cairo_restore(handles_->cairo); }

std::string Canvas::pixels() const {
  require_drawn(cairo_status(handles_->cairo));
  cairo_surface_flush(handles_->surface);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(handles_->surface));
  const auto* data = reinterpret_cast<const char*>(cairo_image_surface_get_data(handles_->surface));
  const auto row_bytes = static_cast<std::size_t>(width()) * 4;
  std::string bytes;
  bytes.reserve(row_bytes * static_cast<std::size_t>(height()));
  for (int row = 0; row < height(); ++row) bytes.append(data + static_cast<std::size_t>(row) * stride, row_bytes);
  return bytes;
}

int Canvas::width() const { return cairo_image_surface_get_width(handles_->surface); }
int Canvas::height() const { return cairo_image_surface_get_height(handles_->surface); }

/// PNG (ISO/IEC 15948:2004), 8 bits for red, green and blue each. Cairo's own writer takes three times as long.
std::string Canvas::png() const {
  const std::string from = pixels();
  const auto columns = static_cast<std::size_t>(width()), rows = static_cast<std::size_t>(height());
  std::string plain;
  plain.reserve(rows * (1 + 3 * columns));
  for (std::size_t row = 0; row < rows; ++row) {
    plain += '\0';  // no filter
    for (std::size_t pixel = row * columns; pixel < (row + 1) * columns; ++pixel)
      plain.append({from[4 * pixel + 2], from[4 * pixel + 1], from[4 * pixel]});
  }
  std::string bytes = "\x89PNG\r\n\x1a\n";
  constexpr char colours[] = {8, 2, 0, 0, 0};
  put_chunk(bytes, "IHDR" + big_endian(columns) + big_endian(rows) + std::string(colours, sizeof colours));
  put_chunk(bytes, "IDAT" + deflated(plain, effort));
  put_chunk(bytes, "IEND");
  return bytes;
}

}  // namespace talus::postprocess
