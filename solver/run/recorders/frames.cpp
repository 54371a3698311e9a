// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/frames.hpp"

#include <utility>

#include "solver/scene/make_scene.hpp"

namespace talus::solver {

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
    : scene_(scene), options_(options), store_(std::move(store)) {}

void FrameRecorder::put(double time, std::int64_t number, Solver& solver) {
  const bool points = options_.point_frames;
  writing_.start(
      [this, time, number, points, thickness = solver.thickness(), state = points ? solver.shown() : ParticleState{}] {
        PointFrame frame;
        if (points) frame = point_frame(scene_, options_, time, state);
        frame.time = time;
        store_.put(number, frame, scene_.map, thickness);
      });
}

}  // namespace talus::solver
