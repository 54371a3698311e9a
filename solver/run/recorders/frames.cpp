// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/frames.hpp"

#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "common/run/hdf5.hpp"
#include "common/run/point_frames.hpp"
#include "common/run/sealed_file.hpp"
#include "common/stage/inside.hpp"
#include "common/stage/stage.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {
namespace {

constexpr const char* begin_anew = "Run talus-solve again without --restart";

/// A number with 12 bits behind its first: what no map, picture or chart shows packs badly.
float rounded(float value) { return std::bit_cast<float>((std::bit_cast<std::uint32_t>(value) + 0x400U) & ~0x7ffU); }

/// Rounds the positions of a frame to a power of two below 1/4096 of a cell, velocity and pressure to 12 bits. Volumes
/// pack well as they are, and are summed.
void round(PointFrame& frame, const GridShape& grid) {
  const double cell[] = {grid.spacing, grid.spacing, grid.layer_height};
  for (std::size_t a = 0; a < 3; ++a) {
    const double step = std::exp2(std::floor(std::log2(cell[a] / 4096)));
    for (auto& position : frame.position) position[a] = std::round(position[a] / step) * step;
  }
  for (auto& velocity : frame.velocity)
    for (float& v : velocity) v = rounded(v);
  for (float& p : frame.pressure) p = rounded(p);
}

/// A list as kernels see it: null where there is none.
template <class Number>
const Number* list_of(const std::vector<Number>& list) {
  return list.empty() ? nullptr : list.data();
}

}  // namespace

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
        s.plastic_log_volume.empty() ? 0 : s.plastic_log_volume[p]};
    const auto material = materials.of(list_of(s.material), list_of(s.plastic_shear), static_cast<int>(p));
    frame.pressure.push_back(static_cast<float>(-trace(kirchhoff_stress(material, state)) / 3));
  }
  frame.id = s.id;
  frame.release = s.release;
  return frame;
}

void FrameRecorder::put(double time, Solver& solver) {
  const FramePoints shown = options_.point_frames;
  if (!run_) run_ = std::make_unique<RunWriter>(file_);
  ParticleState points = spare_state();
  if (shown != FramePoints::none) solver.show(points);
  const auto frame = std::make_shared<PointFrame>();
  auto make = [this, time, shown, frame, state = std::move(points)]() mutable {
    *frame = point_frame(scene_, options_, time, state);
    if (shown == FramePoints::rounded) round(*frame, scene_.grid);
    const std::lock_guard lock(spare_guard_);
    spare_.push_back(std::move(state));
  };
  auto write = [this, time, frame, thickness = solver.thickness()] {
    if (!frame->id.empty()) run_->append(*frame);
    run_->append_thickness(time, scene_.map, thickness);
  };
  writing_.start(std::move(write), std::move(make));
}

ParticleState FrameRecorder::spare_state() {
  const std::lock_guard lock(spare_guard_);
  if (spare_.empty()) return {};
  ParticleState state = std::move(spare_.back());
  spare_.pop_back();
  return state;
}

std::filesystem::path FrameRecorder::saved_file(std::int64_t first) const {
  return store_ / run_id_ / fmt::format("from_{:05}.h5", first);
}

void FrameRecorder::save(std::int64_t count) {
  writing_.settle();
  if (!run_) return;
  make_folder(store_ / run_id_);
  run_->end_part(saved_file(saved_), run_id_);
  run_.reset();
  saved_ = count;
}

void FrameRecorder::go_on_after(std::int64_t count) {
  for (saved_ = 0; saved_ < count;) saved_ += static_cast<std::int64_t>(open_saved(saved_).length(frame_times));
}

h5::File FrameRecorder::open_saved(std::int64_t first) const {
  const auto path = saved_file(first);
  if (!std::filesystem::exists(path))
    throw DataError(
        {path.string() + ": frames of the broken-off run are missing", "run.h5 would have a gap", begin_anew});
  h5::File part = h5::open_sealed(path, {path, begin_anew});
  const std::string owner = part.has_attribute("/", run_mark) ? part.text("/", run_mark) : "";
  if (owner != run_id_)
    throw DataError({fmt::format("{}: frames of the run {}", path.string(), owner),
                     fmt::format("this is the run {}", run_id_), begin_anew});
  return part;
}

RunWriter& FrameRecorder::whole(std::int64_t count, const std::function<void()>& pause) {
  writing_.settle();
  if (saved_ > 0) {
    save(count);
    auto run = std::make_unique<RunWriter>(file_);
    for (std::int64_t first = 0; first < saved_;) {
      pause();
      const h5::File part = open_saved(first);
      const PointFrames points(saved_file(first));
      for (std::size_t n = 0; n < points.time().size(); ++n) run->append(points.read(n));
      const auto times = part.read_list<double>(frame_times, h5::a_time);
      for (std::size_t n = 0; n < times.size(); ++n)
        run->append_thickness(
            times[n], scene_.map,
            part.read_rows<double>(frame_thickness, n, 1, h5::shape_of(scene_.map), h5::thickness_or_none));
      first += static_cast<std::int64_t>(times.size());
    }
    run_ = std::move(run);
  }
  if (!run_) run_ = std::make_unique<RunWriter>(file_);
  return *run_;
}

void FrameRecorder::drop_others() const {
  require_inside(store_ / run_id_);
  std::error_code ignored;
  std::vector<std::filesystem::path> others;
  for (const auto& entry : std::filesystem::directory_iterator(store_, ignored))
    if (entry.path().filename() != run_id_) others.push_back(entry.path());
  for (const auto& path : others) std::filesystem::remove_all(path, ignored);
}

}  // namespace talus::solver
