// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/three_d/ply_file.hpp"

#include <bit>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "common/stage/stage.hpp"

namespace talus::postprocess {
namespace {

template <class T>
void append_bytes(std::string& text, T value) {
  text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

void write_ply(const std::filesystem::path& file, const VtkMesh& mesh, const std::array<double, 3>& origin) {
  std::string text = fmt::format(
      "ply\nformat {} 1.0\ncomment metres from {:.6f} {:.6f} {:.6f}\nelement vertex {}\nproperty float x\n"
      "property float y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      std::endian::native == std::endian::little ? "binary_little_endian" : "binary_big_endian", origin[0], origin[1],
      origin[2], mesh.points.size(), mesh.quads.size());
  for (const auto& point : mesh.points)
    for (std::size_t a = 0; a < 3; ++a) append_bytes(text, static_cast<float>(point[a] - origin[a]));
  for (const auto& quad : mesh.quads) {
    append_bytes(text, std::uint8_t{4});
    for (const std::int64_t corner : quad) append_bytes(text, static_cast<std::int32_t>(corner));
  }
  write_text(file, text);
}

}  // namespace talus::postprocess
