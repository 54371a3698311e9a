// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus._core: libtalus for Python (docs/reference/library.md). python/talus/in_process.py stands in front of it.
//
// Arrays are views: memory belongs to the C++ object, which lives as long as an array of it. Work in C++ goes on
// without the lock of the interpreter; callbacks take it.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <optional>
#include <utility>

#include "library/talus.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace {

using talus::Plan;
using talus::Result;
using talus::Site;

// ---- calls ----------------------------------------------------------------------------------------------------------

/// A recipe as Python hands it over: a file, or a text with the folder of its paths; and changes "key=value".
struct RecipeWords {
  std::optional<std::string> file;
  std::string text, folder;
  std::vector<std::string> changes;

  talus::recipe::Recipe recipe() const {
    if (file) return talus::recipe::Recipe(*file, changes);
    return talus::recipe::Recipe::parse(text, folder, changes);
  }
};

/// The name of the class in talus.errors for an error.
const char* class_of(const talus::Error& error) {
  switch (error.code()) {
    case talus::ExitCode::recipe: return "RecipeError";
    case talus::ExitCode::data: return "DataError";
    case talus::ExitCode::numerical: return "NumericalError";
    default: return "TalusError";
  }
}

/// This function does `work` in a context of its own, without the interpreter's lock. Log lines go to talus.errors, and
/// errors of Talus become its exceptions with the words of the programs.
template <class Work>
auto called(int threads, const Work& work) {
  std::vector<std::pair<talus::LogLevel, std::string>> lines;
  talus::Context context([&](talus::LogLevel level, const std::string& text) { lines.emplace_back(level, text); });
  context.threads = threads;
  const py::module_ errors = py::module_::import("talus.errors");
  const auto say = [&] {
    for (const auto& [level, text] : lines)
      if (level != talus::LogLevel::progress) errors.attr("log")(static_cast<int>(level), text);
  };
  try {
    auto result = [&] {
      const py::gil_scoped_release unlocked;
      const talus::BindContext bound(context);
      return work();
    }();
    say();
    return result;
  } catch (const talus::Error& error) {
    say();
    std::string words;
    for (const talus::Fault& fault : error.faults())
      words += (words.empty() ? "" : "\n") + context.paths().in_message(talus::to_string(fault));
    PyErr_SetString(errors.attr(class_of(error)).ptr(), words.c_str());
    throw py::error_already_set();
  }
}

talus::On device_called(const std::string& word) {
  if (const auto on = talus::on_called(word)) return *on;
  throw py::value_error("on = \"" + word + "\": it must be \"auto\", \"cpu\", \"gpu\" or \"gpus\"");
}

// ---- views ----------------------------------------------------------------------------------------------------------

/// A view of numbers that `owner` keeps alive.
template <class T>
py::array view(std::vector<py::ssize_t> shape, const T* values, const py::handle& owner) {
  return py::array_t<T>(std::move(shape), values, owner);
}

template <class T>
py::array view(const std::vector<T>& values, const py::handle& owner) {
  return view({static_cast<py::ssize_t>(values.size())}, values.data(), owner);
}

/// A view of a map [rows][columns].
py::array map_view(const talus::MapGrid& grid, const std::vector<double>& values, const py::handle& owner) {
  return view({grid.rows, grid.columns}, values.data(), owner);
}

/// What a callback made, and the object by which arrays keep it alive.
template <class T>
std::pair<const T&, py::capsule> owned(T made) {
  auto* const kept = new T(std::move(made));
  return {*kept, py::capsule(kept, [](void* held) { delete static_cast<T*>(held); })};
}

py::dict views_of(const talus::RunMaps& maps, const py::handle& owner) {
  py::dict all;
  for (const talus::MapField& field : talus::map_fields)
    if (const std::vector<double>& values = maps.*(field.values); !values.empty())
      all[field.name] = map_view(maps.grid, values, owner);
  for (const auto& [release, values] : maps.deposit_of)
    all[py::str("deposit_of_" + release)] = map_view(maps.grid, values, owner);
  return all;
}

py::dict views_of(const talus::PointFrame& points, const py::handle& owner) {
  const auto count = static_cast<py::ssize_t>(points.volume.size());
  return py::dict("position"_a = view({count, 3}, reinterpret_cast<const double*>(points.position.data()), owner),
                  "velocity"_a = view({count, 3}, reinterpret_cast<const float*>(points.velocity.data()), owner),
                  "volume"_a = view(points.volume, owner), "pressure"_a = view(points.pressure, owner),
                  "id"_a = view(points.id, owner), "release"_a = view(points.release, owner));
}

py::dict dict_of(const talus::MapGrid& grid) {
  return py::dict("columns"_a = grid.columns, "rows"_a = grid.rows, "west_m"_a = grid.west, "south_m"_a = grid.south,
                  "cell_m"_a = grid.cell, "crs_wkt"_a = grid.crs_wkt);
}

py::dict dict_of(const talus::RunSummary& s) {
  return py::dict("scene"_a = s.scene, "title"_a = s.title, "on"_a = s.on, "precision"_a = s.precision,
                  "version"_a = s.version, "stop_reason"_a = s.stop_reason, "particles"_a = s.particles,
                  "steps"_a = s.steps, "time_end_s"_a = s.time_end, "wall_time_s"_a = s.wall_time,
                  "volume_released_m3"_a = s.volume_released, "volume_final_m3"_a = s.volume_final,
                  "volume_outflow_m3"_a = s.volume_outflow, "sanity"_a = s.sanity.words);
}

// ---- a run ----------------------------------------------------------------------------------------------------------

/// A run at a record, as a callback sees it.
class PyMoment {
 public:
  explicit PyMoment(const talus::Moment& now) : now_(&now) {}
  void end() { now_ = nullptr; }
  const talus::Moment& now() const {
    if (now_ == nullptr) throw py::value_error("a moment is valid in its callback alone; keep its arrays instead");
    return *now_;
  }

 private:
  const talus::Moment* now_;
};

/// Calls Python at each record, and lets Ctrl-C through.
class PyKeeper : public talus::Keeper {
 public:
  explicit PyKeeper(py::object callback) : callback_(std::move(callback)) {}

  bool record(const talus::Moment& now) override {
    if (callback_.is_none()) return true;
    const py::gil_scoped_acquire locked;
    const auto moment = std::make_shared<PyMoment>(now);
    const py::object answer = callback_(moment);
    moment->end();
    return !(py::isinstance<py::bool_>(answer) && !answer.cast<bool>());
  }
  void pass_steps() override {
    const auto now = std::chrono::steady_clock::now();
    if (now - looked_ < std::chrono::milliseconds(50)) return;
    looked_ = now;
    const py::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  py::object callback_;
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
};

// ---- input ----------------------------------------------------------------------------------------------------------

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

talus::Raster raster_of(const talus::MapGrid& grid, const Doubles& values) {
  return {grid, {values.data(), values.data() + values.size()}};
}

// NOLINTNEXTLINE(readability-function-size): the arguments of a Python function
std::shared_ptr<Site> make_site(const Doubles& bed, const Doubles& thickness, double cell, double west, double south,
                                double layer_height, const std::array<int, 3>& per_cell, const std::string& crs_wkt) {
  if (bed.ndim() != 2 || thickness.ndim() != 2)
    throw py::value_error("bed and thickness are maps: arrays of rows and columns, the southernmost row first");
  const auto grid_of = [&](const Doubles& map) {
    return talus::MapGrid{static_cast<int>(map.shape(1)), static_cast<int>(map.shape(0)), west, south, cell, crs_wkt};
  };
  talus::Raster below = raster_of(grid_of(bed), bed), above = raster_of(grid_of(thickness), thickness);
  return called(0, [&] {
    return std::make_shared<Site>(
        Site{.domain = talus::make_domain(std::move(below), std::move(above), layer_height, per_cell)});
  });
}

void set_shaking(Site& site, const Doubles& time, const Doubles& acceleration) {
  if (time.ndim() != 1 || acceleration.ndim() != 2 || acceleration.shape(1) != 3)
    throw py::value_error("shaking: times [n], and accelerations [n][3] along x, y and z");
  site.shaking = {};
  site.shaking.time.assign(time.data(), time.data() + time.size());
  for (py::ssize_t n = 0; n < acceleration.shape(0); ++n)
    site.shaking.acceleration.push_back({acceleration.at(n, 0), acceleration.at(n, 1), acceleration.at(n, 2)});
}

/// The function is called, copied and dropped where the interpreter may not be locked.
void add_obstacle(Site& site, const std::string& name, const std::array<double, 3>& low,
                  const std::array<double, 3>& high, py::function distance) {
  const std::shared_ptr<py::function> kept(new py::function(std::move(distance)), [](py::function* held) {
    const py::gil_scoped_acquire locked;
    delete held;
  });
  site.obstacles.push_back({name, low, high, [kept](double x, double y, double z) {
                              const py::gil_scoped_acquire locked;
                              return (*kept)(x, y, z).cast<double>();
                            }});
}

void define_recipe_and_site(py::module_& m) {
  py::class_<RecipeWords>(m, "RecipeWords")
      .def(py::init(
          [](std::optional<std::string> file, std::string text, std::string folder, std::vector<std::string> changes) {
            return RecipeWords{std::move(file), std::move(text), std::move(folder), std::move(changes)};
          }));
  const auto map_of = [](talus::Raster talus::Domain::*raster) {
    return [raster](const std::shared_ptr<Site>& site) {
      const talus::Raster& map = site->domain.*raster;
      return map_view(map.grid, map.values, py::cast(site));
    };
  };
  py::class_<Site, std::shared_ptr<Site>>(m, "Site", "Ground, released mass, obstacles and shaking: input of a plan.")
      .def(py::init(&make_site), "bed"_a, "thickness"_a, py::kw_only(), "cell"_a, "west"_a = 0.0, "south"_a = 0.0,
           "layer_height"_a = 0.0, "per_cell"_a = std::array<int, 3>{2, 2, 2}, "crs_wkt"_a = "",
           "A site of arrays [rows][columns], the southernmost row first: elevation of the bed and vertical thickness "
           "of the released mass [m]. Cells of width `cell` [m]; layers of `layer_height` [m] (0: by the thickness).")
      .def_property_readonly("terrain", map_of(&talus::Domain::terrain), "Elevation of the bed [m].")
      .def_property_readonly("before", map_of(&talus::Domain::before), "Elevation before the failure [m].")
      .def_property_readonly("thickness", map_of(&talus::Domain::release_thickness), "Released thickness [m].")
      .def_property_readonly("grid", [](const Site& site) { return dict_of(site.domain.grid); })
      .def("add_obstacle", &add_obstacle, "name"_a, "low"_a, "high"_a, "distance"_a,
           "A body for [[solve.obstacle]] of this name: distance(x, y, z) [m] is negative inside, within low and high.")
      .def("set_shaking", &set_shaking, "time"_a, "acceleration"_a,
           "Accelerations of the ground [n][3] [m/s2] at times [s], in the place of [solve.shaking] file.");
  m.def("prepare", [](const RecipeWords& words, int threads) {
    return called(threads, [&] { return std::make_shared<Site>(talus::prepare(words.recipe())); });
  });
}

void define_plan(py::module_& m) {
  py::class_<Plan>(m, "Plan", "A run before its first step.")
      .def_property_readonly("grid", [](const Plan& plan) { return dict_of(plan.grid()); })
      .def_property_readonly("points", &Plan::points, "Number of material points at the start.")
      .def_property_readonly(
          "findings",
          [](const Plan& plan) { return py::module_::import("json").attr("loads")(to_json(plan.findings())); },
          "Advice, warnings and overridden refusals: dictionaries as in score.json.")
      .def(
          "description",
          [](const Plan& plan, const std::string& on) {
            return called(0, [&, device = device_called(on)] { return plan.description(device); });
          },
          "on"_a = "auto", "A line each on what is on, memory, steps and time. Takes a few steps.");
}

void define_moment(py::module_& m) {
  py::class_<PyMoment, std::shared_ptr<PyMoment>>(m, "Moment", "A run at one of its records, in a callback.")
      .def_property_readonly(
          "time", [](const PyMoment& moment) { return moment.now().time(); }, "[s]")
      .def_property_readonly("steps", [](const PyMoment& moment) { return moment.now().steps(); })
      .def_property_readonly(
          "thickness",
          [](const PyMoment& moment) {
            const auto& [values, owner] = owned(moment.now().thickness());
            return map_view(moment.now().grid(), values, owner);
          },
          "Vertical thickness of all points [m].")
      .def_property_readonly(
          "maps",
          [](const PyMoment& moment) {
            const auto& [maps, owner] = owned(moment.now().maps());
            return views_of(maps, owner);
          },
          "Maps by name, as they would be if the run ended now.")
      .def_property_readonly("points", [](const PyMoment& moment) {
        const auto& [points, owner] = owned(moment.now().points());
        return views_of(points, owner);
      });
}

void define_result(py::module_& m) {
  py::class_<Result, std::shared_ptr<Result>>(m, "Result", "A finished run.")
      .def_property_readonly("grid", [](const Result& result) { return dict_of(result.maps.grid); })
      .def_property_readonly("summary", [](const Result& result) { return dict_of(result.summary); })
      .def_property_readonly(
          "maps", [](const std::shared_ptr<Result>& result) { return views_of(result->maps, py::cast(result)); },
          "Maps by name [rows][columns]; thickness in m, speed in m/s, pressure in kPa, time in s.")
      .def_property_readonly(
          "points", [](const std::shared_ptr<Result>& result) { return views_of(result->points, py::cast(result)); },
          "Points at the end: position [m], velocity [m/s], volume [m3], pressure [Pa], id, release.")
      .def_property_readonly(
          "history",
          [](const std::shared_ptr<Result>& result) {
            py::dict all;
            for (const talus::HistoryColumn& column : result->history.columns)
              all[py::str(column.name)] = view(column.values, py::cast(result));
            return all;
          },
          "Columns over time by name, units at the end of names.")
      .def_property_readonly(
          "frames",
          [](const std::shared_ptr<Result>& result) {
            py::list all;
            for (std::size_t n = 0; n < result->frames.time.size(); ++n)
              all.append(py::make_tuple(result->frames.time[n],
                                        map_view(result->maps.grid, result->frames.thickness[n], py::cast(result))));
            return all;
          },
          "Time [s] and thickness [m] of each frame.");
}

void define_calls(py::module_& m) {
  m.def("plan", [](const std::shared_ptr<Site>& site, const RecipeWords& words, int threads) {
    return called(threads, [&] { return Plan(*site, words.recipe()); });
  });
  m.def("run", [](const Plan& plan, const std::string& on, py::object callback, int threads) {
    PyKeeper keeper(std::move(callback));
    return called(threads, [&, device = device_called(on)] {
      return std::make_shared<Result>(talus::run(plan, device, keeper));
    });
  });
  m.def("write", [](const std::shared_ptr<Result>& result, const RecipeWords& words, const std::string& folder) {
    const auto files = called(0, [&] { return talus::write(*result, words.recipe(), folder); });
    std::vector<std::string> names;
    for (const auto& file : files) names.push_back(file.string());
    return names;
  });
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  m.doc() = "libtalus: prepare, plan and run landslides in this process.";
  define_recipe_and_site(m);
  define_plan(m);
  define_moment(m);
  define_result(m);
  define_calls(m);
}
