// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/frames.hpp"

#include <fmt/format.h>

#include "common/run/hdf5.hpp"
#include "common/run/sealed_file.hpp"
#include "common/stage/inside.hpp"
#include "common/stage/stage.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {
namespace {

template <class T>
std::span<const T> flat(const std::vector<std::array<T, 3>>& rows) {
  return {rows.empty() ? nullptr : rows.front().data(), rows.size() * 3};
}

template <class T>
std::vector<std::array<T, 3>> rows_of(const std::vector<T>& values) {
  std::vector<std::array<T, 3>> rows(values.size() / 3);
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = {values[3 * r], values[3 * r + 1], values[3 * r + 2]};
  return rows;
}

/// A whole dataset of this shape whose values are allowed.
template <class T>
std::vector<T> read_all(const h5::File& in, const std::string& path, const h5::Dims& shape,
                        const h5::Allowed& allowed = h5::finite) {
  auto values = in.read<T>(path, shape);
  h5::check_values<T>(in, path, values, allowed);
  return values;
}

/// The points of a frame, all lists as long as the first.
PointFrame points_in(const h5::File& in) {
  PointFrame f;
  f.time = h5::checked_number(in, "/", "time", h5::a_time);
  const auto count = static_cast<hsize_t>(in.length("/id"));
  f.position = rows_of(read_all<double>(in, "/position", {count, 3}));
  f.velocity = rows_of(read_all<float>(in, "/velocity", {count, 3}));
  f.volume = read_all<float>(in, "/volume", {count}, h5::not_negative);
  f.pressure = read_all<float>(in, "/pressure", {count});
  f.id = read_all<std::int32_t>(in, "/id", {count}, h5::not_negative);
  f.release = read_all<std::int32_t>(in, "/release", {count}, h5::not_negative);
  return f;
}

}  // namespace

void FrameStore::clear() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

void FrameStore::drop_others() const {
  require_inside(folder_ / run_id_);
  std::error_code ignored;
  std::vector<std::filesystem::path> others;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored))
    if (entry.path().filename() != run_id_) others.push_back(entry.path());
  for (const auto& path : others) std::filesystem::remove_all(path, ignored);
}

std::filesystem::path FrameStore::file(std::int64_t number) const {
  return folder_ / run_id_ / fmt::format("frame_{:05}.h5", number);
}

void FrameStore::put(std::int64_t number, const PointFrame& f, const MapGrid& grid,
                     const std::vector<double>& thickness) {
  make_folder(folder_ / run_id_);
  const auto write = [&](h5::File& out) {
    out.leave_plain();  // to compress takes longer than the steps between two frames; run.h5 is compressed
    const auto count = static_cast<hsize_t>(f.id.size());
    out.set_number("/", "time", f.time);
    out.set_text("/", "run_id", run_id_);
    out.write<double>("/position", {count, 3}, flat(f.position));
    out.write<float>("/velocity", {count, 3}, flat(f.velocity));
    out.write<float>("/volume", {count}, f.volume);
    out.write<float>("/pressure", {count}, f.pressure);
    out.write<std::int32_t>("/id", {count}, f.id);
    out.write<std::int32_t>("/release", {count}, f.release);
    out.write<double>("/thickness", h5::shape_of(grid), thickness);
  };
  h5::write_sealed(file(number), write, "Free some space, or name another folder with --out DIR");
}

void FrameStore::expect(std::int64_t count) const {
  for (std::int64_t n = 0; n < count; ++n) {
    if (std::filesystem::exists(file(n))) continue;
    throw DataError({file(n).string() + ": this frame of the broken-off run is missing", "run.h5 would have a gap",
                     "Run talus-solve again without --restart"});
  }
}

void FrameStore::append_to(RunWriter& run, std::int64_t number, const MapGrid& grid) const {
  const std::filesystem::path path = file(number);
  const h5::File frame = h5::open_sealed(path, {path, "Run talus-solve again without --restart"});
  const std::string owner = frame.has_attribute("/", "run_id") ? frame.text("/", "run_id") : "";
  if (owner != run_id_)
    throw DataError({fmt::format("{}: a frame of the run {}", path.string(), owner),
                     fmt::format("this is the run {}", run_id_), "Run talus-solve again without --restart"});
  const PointFrame f = points_in(frame);
  if (!f.id.empty()) run.append(f);
  run.append_thickness(f.time, grid, read_all<double>(frame, "/thickness", h5::shape_of(grid), h5::thickness_or_none));
}

PointFrame point_frame(const Scene& scene, const SolveOptions& options, double time, const ParticleState& s) {
  const auto materials = make_materials<double>(options, scene.grid.spacing, scene.grid.layer_height);
  PointFrame frame;
  frame.time = time;
  frame.position = positions(scene, s);
  for (std::size_t p = 0; p < s.size(); ++p) {
    frame.velocity.push_back({static_cast<float>(s.velocity[0][p]), static_cast<float>(s.velocity[1][p]),
                              static_cast<float>(s.velocity[2][p])});
    frame.volume.push_back(static_cast<float>(s.volume[p]));
    const MaterialState<double> state{
        {s.elastic[0][p], s.elastic[1][p], s.elastic[2][p], s.elastic[3][p], s.elastic[4][p], s.elastic[5][p]},
        s.log_volume[p],
        s.plastic_log_volume[p]};
    frame.pressure.push_back(static_cast<float>(
        -trace(kirchhoff_stress(materials.of(s.material.data(), s.plastic_shear.data(), static_cast<int>(p)), state)) /
        3));
  }
  frame.id = s.id;
  frame.release = s.release;
  return frame;
}

FrameRecorder::FrameRecorder(const Scene& scene, const SolveOptions& options, std::filesystem::path store)
    : FrameStore(std::move(store)), scene_(scene), options_(options) {}

void FrameRecorder::put(double time, std::int64_t number, Solver& solver) {
  const bool points = options_.point_frames;
  writing_.start(
      [this, time, number, points, thickness = solver.thickness(), state = points ? solver.shown() : ParticleState{}] {
        PointFrame frame;
        if (points) frame = point_frame(scene_, options_, time, state);
        frame.time = time;
        FrameStore::put(number, frame, scene_.map, thickness);
      });
}

}  // namespace talus::solver
