// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/local_only.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string>
#include <string_view>

#include <cpl_http.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>

#include "common/gis/gdal_support.hpp"
#include "common/recipe/dataset_name.hpp"
#include "common/recipe/paths.hpp"
#include "common/stage/files.hpp"

namespace talus::gdal {
namespace fs = std::filesystem;
namespace {

/// File systems of GDAL that stay on this machine.
constexpr std::array<std::string_view, 9> local_systems{"/vsimem/",     "/vsizip/",    "/vsigzip/",
                                                        "/vsitar/",     "/vsi7z/",     "/vsirar/",
                                                        "/vsisubfile/", "/vsisparse/", "/vsicrypt/"};

/// Drivers of services, databases and other programs.
constexpr std::array<const char*, 36> remote_drivers{
    "HTTP",     "WMS",      "WMTS",  "WCS",     "WFS",  "OAPIF",     "OGCAPI",     "CSW",       "PostGISRaster",
    "PGeo",     "ODBC",     "MySQL", "OCI",     "DODS", "OGR_OGDI",  "PostgreSQL", "GPSBabel",  "MSSQLSpatial",
    "PLMOSAIC", "PLSCENES", "EEDA",  "EEDAI",   "DAAS", "NGW",       "STACTA",     "STACIT",    "Elasticsearch",
    "Carto",    "GMLAS",    "SDE",   "CouchDB", "HANA", "GeoRaster", "AmigoCloud", "MongoDBv3", "Cloudant"};

/// What names of such datasets begin with.
constexpr std::array<std::string_view, 24> remote_prefixes{
    "WMS:",        "WMTS:",    "WCS:",      "WFS:",   "OAPIF:", "OGCAPI:", "CSW:",   "PG:",
    "POSTGRESQL:", "POSTGIS:", "ODBC:",     "MYSQL:", "MSSQL:", "OCI:",    "GEOR:",  "DODS:",
    "PGEO:",       "ES:",      "GPSBABEL:", "EEDA:",  "NGW:",   "CARTO:",  "EEDAI:", "STACIT:"};

bool begins_with(std::string_view text, std::string_view beginning) {
  return text.size() >= beginning.size() && EQUALN(text.data(), beginning.data(), beginning.size());
}

/// True for a place on a network, a database or standard input, also behind a local file system (/vsizip//vsicurl/).
bool is_remote(std::string_view name) {
  if (holds_address(name)) return true;
  const auto begins = [&](std::string_view prefix) { return begins_with(name, prefix); };
  if (std::any_of(remote_prefixes.begin(), remote_prefixes.end(), begins)) return true;
  for (std::size_t at = name.find("/vsi"); at != std::string_view::npos; at = name.find("/vsi", at + 1)) {
    const std::string_view rest = name.substr(at);
    const auto local = [&](std::string_view system) { return begins_with(rest, system.substr(0, system.size() - 1)); };
    if (std::none_of(local_systems.begin(), local_systems.end(), local)) return true;
  }
  return false;
}

[[noreturn]] void refuse_remote(const fs::path& file, const std::string& name) {
  const std::string what = file.string() == name ? name : fmt::format("{}: it names {}", file.string(), name);
  throw DataError({what, "that is no file of this machine, and nothing is fetched unless it is asked for",
                   "Download it and name the file, or give --network"});
}

/// Files that name others in XML: VRT, descriptions of services, tile indices.
bool is_xml(const fs::path& file) {
  std::error_code unknown;
  constexpr std::uintmax_t most = 64 << 20;
  if (fs::file_size(file, unknown) > most) return false;
  const std::string start = start_of(file, 512);
  const std::size_t first = start.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string::npos || start[first] != '<') return false;
  for (const char* name : {"<VRT", "<OGRVRT", "<GDAL", "<WCS", "<OGRWFS", "<GMLAS"})
    if (start.find(name) != std::string::npos) return true;
  return false;
}

/// Looks at files and at what they name.
class Walk {
 public:
  const std::set<std::string>& seen() const { return seen_; }  ///< the names of all files looked at

  void look(const fs::path& file, int depth = 0) {
    constexpr int deepest = 16;
    if (file.empty() || depth > deepest || !seen_.insert(file.lexically_normal().string()).second) return;
    if (is_remote(file.string()) && !network_allowed()) refuse_remote(file, file.string());
    require_plain(file_behind(file));
    if (!is_xml(file)) return;
    const std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)> root(CPLParseXMLFile(file.c_str()),
                                                                         CPLDestroyXMLNode);
    for (const CPLXMLNode* node = root.get(); node != nullptr; node = node->psNext) look_at(*node, file, depth);
  }

 private:
  void look_at(const CPLXMLNode& node, const fs::path& file, int depth) {
    for (const char* other : {"SRS", "LayerSRS", "Metadata", "Description", "GCPList", "CategoryNames", "ColorTable"})
      if (node.eType == CXT_Element && EQUAL(node.pszValue, other)) return;  // they name no files
    for (const CPLXMLNode* child = node.psChild; child != nullptr; child = child->psNext) look_at(*child, file, depth);
    constexpr std::size_t longest_name = 4096;
    if (node.eType != CXT_Text || node.pszValue == nullptr) return;
    const std::string value = node.pszValue;
    if (value.empty() || value.size() > longest_name || value.find('\n') != std::string::npos) return;
    if (is_remote(value) && !network_allowed()) refuse_remote(file, value);
    const auto inside = dataset_name(value, file.parent_path());
    const fs::path named = inside ? file_behind(inside->from(file.parent_path())) : file.parent_path() / value;
    std::error_code unknown;
    if (fs::exists(named, unknown)) look(named, depth + 1);
  }

  std::set<std::string> seen_;
};

/// Opens nothing of a file system, and says why.
void* refuse_to_open(void*, const char* name, const char*) {
  CPLError(CE_Failure, CPLE_OpenFailed, "%s: nothing is fetched unless it is asked for (--network)", name);
  return nullptr;
}

void close_file_system(const char* prefix) {
  static auto& kept = *new std::set<std::string>;  // GDAL keeps the pointer to the end, not the text
  VSIFilesystemPluginCallbacksStruct* calls = VSIAllocFilesystemPluginCallbacksStruct();
  calls->open = refuse_to_open;
  calls->tell = [](void*) -> vsi_l_offset { return 0; };
  calls->seek = [](void*, vsi_l_offset, int) { return -1; };
  calls->read = [](void*, void*, std::size_t, std::size_t) -> std::size_t { return 0; };
  calls->close = [](void*) { return 0; };
  VSIInstallPluginHandler(kept.insert(prefix).first->c_str(), calls);
  VSIFreeFilesystemPluginCallbacksStruct(calls);
}

// NOLINTNEXTLINE(readability-function-size): GDAL calls it with so many
CPLHTTPResult* refuse_to_fetch(const char* address, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc, void*,
                               void*) {
  auto* result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  const std::string why = fmt::format("{}: nothing is fetched unless it is asked for (--network)", address);
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup(why.c_str());
  CPLError(CE_Failure, CPLE_AppDefined, "%s", why.c_str());
  return result;
}

void close_file_systems() {
  const CPLStringList prefixes(VSIGetFileSystemsPrefixes(), TRUE);
  for (int i = 0; i < prefixes.size(); ++i) {
    const std::string_view prefix = prefixes[i];
    const auto same = [&](std::string_view system) {
      return prefix.substr(0, system.size() - 1) == system.substr(0, system.size() - 1);
    };
    if (prefix.size() > 4 && std::none_of(local_systems.begin(), local_systems.end(), same))
      close_file_system(prefixes[i]);
  }
}

}  // namespace

void close_the_network() {
  CPLSetConfigOption("GDAL_VRT_ENABLE_PYTHON", "NO");
  CPLSetConfigOption("CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO");  // else a file appears beside the input
  if (network_allowed()) {
    close_file_system("/vsistdin/");
    return;
  }
  close_file_systems();
  CPLHTTPSetFetchCallback(refuse_to_fetch, nullptr);
  OSRSetPROJEnableNetwork(0);
  for (const char* name : remote_drivers) {
    if (GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(name)) {
      GetGDALDriverManager()->DeregisterDriver(driver);
      GDALDestroyDriver(driver);
    }
  }
}

void require_local(const fs::path& file) {
  const QuietErrors errors;
  Walk().look(file);
}

std::vector<fs::path> files_named_from(const fs::path& file) {
  const QuietErrors errors;
  Walk walk;
  walk.look(file);
  std::vector<fs::path> files;
  std::error_code unknown;
  for (const std::string& name : walk.seen())
    if (const fs::path plain = file_behind(name); fs::is_regular_file(plain, unknown)) files.push_back(plain);
  return files;
}

}  // namespace talus::gdal

namespace talus {
namespace fs = std::filesystem;
namespace {

/// Formats that are read whole when they are opened, and lie in one file but for a projection beside it.
constexpr std::array<std::string_view, 6> costly{"XYZ", "CSV", "GeoJSON", "KML", "GML", "GPX"};

bool cheap_to_open(const fs::path& file) {
  GDALDriverH driver = GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR, nullptr, nullptr);
  return driver != nullptr && std::find(costly.begin(), costly.end(), GDALGetDescription(driver)) == costly.end();
}

std::vector<fs::path> files_of_dataset(const fs::path& file) {
  const gdal::QuietErrors errors;
  std::vector<fs::path> files;
  try {
    files = gdal::files_named_from(file);
  } catch (const DataError&) {
    return {};  // whoever reads it says so
  }
  if (!cheap_to_open(file)) return files;
  const gdal::Dataset dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR | GDAL_OF_READONLY));
  if (!dataset) return files;
  const CPLStringList names(dataset->GetFileList(), TRUE);
  for (int i = 0; i < names.size(); ++i) files.push_back(file_behind(names[i]));
  return files;
}

/// dem.prj or dem.PRJ beside dem.asc: read with grids and tables that GDAL does not open by itself.
void add_projection(const fs::path& file, std::vector<fs::path>& files) {
  for (const char* extension : {".prj", ".PRJ"}) {
    const fs::path beside = fs::path(file).replace_extension(extension);
    std::error_code none_there;
    if (fs::is_regular_file(beside, none_there)) files.push_back(beside);
  }
}

/// A name that only GDAL knows (NETCDF:file.nc:z, /vsizip/...) is no file.
bool is_plain(const fs::path& file) { return file.is_absolute() && !file.native().starts_with("/vsi"); }

}  // namespace

std::vector<fs::path> with_sidecars(const std::vector<fs::path>& files) {
  std::vector<fs::path> all;
  const auto add = [&](const fs::path& file) {
    if (is_plain(file) && std::find(all.begin(), all.end(), file) == all.end()) all.push_back(file);
  };
  for (const fs::path& source : files) {
    const fs::path file = vector_source(source).file;
    add(file_behind(file));
    std::vector<fs::path> parts = files_of_dataset(file);
    if (is_plain(file)) add_projection(file, parts);
    for (const fs::path& part : parts) add(part.lexically_normal());
  }
  return all;
}

}  // namespace talus
