// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/three_d/three_d.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numeric>
#include <span>
#include <stdexcept>
#include <system_error>
#include <type_traits>

#include <fmt/format.h>

#include "common/deflate.hpp"
#include "common/gis/escaped_xml.hpp"
#include "common/stage/files.hpp"
#include "common/stage/stage.hpp"

namespace talus::postprocess {
namespace {

constexpr std::size_t block_bytes = 1 << 18;  // uncompressed; VTK takes any size
constexpr int effort = 4;                     // of libdeflate

template <class T>
constexpr const char* vtk_type() {
  if (std::is_same_v<T, float>) return "Float32";
  if (std::is_same_v<T, double>) return "Float64";
  return sizeof(T) == 4 ? "Int32" : "Int64";
}

/// The file's two halves as they grow: the XML that names arrays by their place, and the packed bytes.
class VtkText {
 public:
  void line(const std::string& text) { xml_ += text + "\n"; }

  template <class T>
  void array(const std::string& name, const std::vector<T>& values, int components = 1) {
    line(fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>",
                     vtk_type<T>(), escaped_xml(name), components, data_.size()));
    append(std::span(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)));
  }

  /// A text, as VTK keeps texts: the numbers of its bytes, and a 0 behind them.
  void words(const std::string& name, const std::string& text) {
    std::string numbers;
    for (const char c : text) numbers += fmt::format("{} ", static_cast<unsigned>(static_cast<unsigned char>(c)));
    line(fmt::format("<Array type=\"String\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}0</Array>",
                     escaped_xml(name), numbers));
  }

  void write(const std::filesystem::path& path) const {
    PendingFile pending(path);
    errno = 0;
    std::ofstream stream(pending.path(), std::ios::binary | std::ios::trunc);
    stream << xml_ << "<AppendedData encoding=\"raw\">\n_" << data_ << "\n</AppendedData>\n</VTKFile>\n";
    stream.close();
    if (!stream)
      throw DataError(
          write_fault(path, errno != 0 ? std::generic_category().message(errno) : "the system gave no reason"));
    pending.commit();
  }

 private:
  void number(std::uint64_t value) { data_.append(reinterpret_cast<const char*>(&value), sizeof value); }

  /// [blocks][bytes of a block][bytes of the last one where it is shorter][packed bytes of each], then the blocks.
  void append(std::span<const char> bytes) {
    const std::size_t blocks = (bytes.size() + block_bytes - 1) / block_bytes;
    number(blocks);
    number(block_bytes);
    number(bytes.size() % block_bytes);
    const std::size_t sizes = data_.size();
    data_.append(blocks * sizeof(std::uint64_t), '\0');
    for (std::size_t b = 0; b < blocks; ++b) {
      const auto part = bytes.subspan(b * block_bytes, std::min(block_bytes, bytes.size() - b * block_bytes));
      const std::string packed = deflated(part, effort);
      const std::uint64_t stored = packed.size();
      std::memcpy(data_.data() + sizes + b * sizeof stored, &stored, sizeof stored);
      data_ += packed;
    }
  }

  std::string xml_, data_;
};

void put_array(VtkText& text, const VtkArray& array, std::size_t tuples) {
  std::visit(
      [&](const auto& values) {
        if (values.size() != tuples * static_cast<std::size_t>(array.components))
          throw std::logic_error("VTK array " + array.name + ": not as long as the points");
        text.array(array.name, values, array.components);
      },
      array.values);
}

/// Lengths to 1/1024 m: the low bits of coordinates are zero, and zlib has less to pack.
double to_a_millimetre(double metres) { return std::round(metres * 1024) / 1024; }

void put_points(VtkText& text, const VtkMesh& mesh) {
  std::vector<double> flat;
  flat.reserve(3 * mesh.points.size());
  for (const auto& point : mesh.points)
    for (const double metres : point) flat.push_back(to_a_millimetre(metres));
  text.line("<Points>");
  text.array("Points", flat, 3);
  text.line("</Points>");
}

/// Vertices or quadrilaterals: ids of their points, and where each ends.
void put_cells(VtkText& text, const char* kind, const std::vector<std::int64_t>& ids, std::int64_t corners) {
  std::vector<std::int64_t> ends(ids.size() / static_cast<std::size_t>(corners));
  std::int64_t end = 0;
  for (std::int64_t& e : ends) e = end += corners;
  text.line(fmt::format("<{}>", kind));
  text.array("connectivity", ids);
  text.array("offsets", ends);
  text.line(fmt::format("</{}>", kind));
}

std::vector<std::int64_t> ids_of(const VtkMesh& mesh) {
  std::vector<std::int64_t> ids;
  for (const auto& quad : mesh.quads) ids.insert(ids.end(), quad.begin(), quad.end());
  if (!mesh.quads.empty()) return ids;
  ids.resize(mesh.points.size());
  std::iota(ids.begin(), ids.end(), 0);
  return ids;
}

}  // namespace

void write_vtp(const std::filesystem::path& file, const VtkMesh& mesh) {
  const bool points = mesh.quads.empty();
  VtkText text;
  text.line("<?xml version=\"1.0\"?>");
  text.line(
      fmt::format("<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\" "
                  "compressor=\"vtkZLibDataCompressor\">",
                  std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian"));
  text.line("<PolyData>\n<FieldData>");
  for (const auto& [name, words] : mesh.facts) text.words(name, words);
  text.line("</FieldData>");
  text.line(
      fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                  "NumberOfPolys=\"{}\">",
                  mesh.points.size(), points ? mesh.points.size() : 0, mesh.quads.size()));
  text.line("<PointData>");
  for (const VtkArray& array : mesh.on_points) put_array(text, array, mesh.points.size());
  text.line("</PointData>");
  put_points(text, mesh);
  put_cells(text, points ? "Verts" : "Polys", ids_of(mesh), points ? 1 : 4);
  text.line("</Piece>\n</PolyData>");
  text.write(file);
}

void write_pvd(const std::filesystem::path& file, const std::vector<VtkPart>& parts) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (const VtkPart& part : parts)
    text += fmt::format("<DataSet timestep=\"{}\" part=\"{}\" file=\"{}\"/>\n", part.time, part.part,
                        escaped_xml(part.file));
  write_text(file, text + "</Collection>\n</VTKFile>\n");
}

}  // namespace talus::postprocess
