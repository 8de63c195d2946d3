#include <fmt/format.h>

#include "bindings.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/io/results_reader.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/mesh/converter_files.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"
#include "ricochet/report/figure.hpp"
#include "ricochet/report/page.hpp"
#include "ricochet/report/reading_runs.hpp"
#include "ricochet/report/run_data.hpp"
#include "ricochet/report/runs_figure.hpp"
#include "ricochet/report/simplices.hpp"
#include "ricochet/study/study_figure.hpp"
#include "ricochet/study/study_table.hpp"

namespace ricochet::python {

namespace {

RunData read_run(const std::string& directory) {
  const LibraryLock lock;
  std::vector<RunData> runs;
  read_with_retries({directory}, [&] { runs = read_runs({directory}, true); });
  if (runs.front().results != nullptr) runs.front().results->release();
  return std::move(runs.front());
}

const ResultsReader& results_of(const RunData& run) {
  if (run.results == nullptr)
    throw Error(ErrorKind::invalid_input, fmt::format("{}: the run has written no fields", run.directory));
  return *run.results;
}

const ResultField& field_of(const RunData& run, const std::string& name) {
  if (const ResultField* field = results_of(run).find_field(name)) return *field;
  std::string names;
  for (const ResultField& field : results_of(run).fields()) names += (names.empty() ? "" : ", ") + field.name;
  throw Error(ErrorKind::invalid_input,
              fmt::format("{}: there is no field \"{}\"; choose from {}", run.directory, name, names));
}

py::array read_field(const RunData& run, Index frame, const std::string& name) {
  const ResultField& field = field_of(run, name);
  const ResultsReader& results = results_of(run);
  std::vector<double> values;
  {
    const LibraryLock lock;
    const struct Release {
      ResultsReader& results;
      ~Release() { results.release(); }
    } release{*run.results};
    results.read(frame, field, values);
  }
  const Index rows = field.on_nodes ? results.nodes().cols() : results.cell_count();
  return owned_array(std::move(values), rows, field.components > 1 ? field.components : 0);
}

/// Returns (meshio's name, cells × nodes in its order) for each block.
py::list cells_of(const std::vector<CellBlock>& blocks, int degree) {
  py::list result;
  for (const CellBlock& block : blocks) {
    const std::vector<int>& order = meshio_nodes(block.shape, degree);
    std::vector<std::int64_t> nodes;
    nodes.reserve(block.nodes.size());
    for (Index cell = 0; cell < block.size(); ++cell) {
      for (const int own : order) nodes.push_back(block.cell(cell)[own]);
    }
    const Index count = block.size();
    result.append(py::make_tuple(file_type(block.shape, degree).meshio_name,
                                 owned_array(std::move(nodes), count, block.nodes_per_cell)));
  }
  return result;
}

/// Returns (nodes of the body, triangles × 3, cell of each triangle) of the visible surface.
py::tuple surface_of(const RunData& run, Index most) {
  const ResultsReader& results = results_of(run);
  Simplices surface;
  {
    const LibraryLock lock;
    surface = make_surface(results.nodes(), results.cells(), most);
  }
  const auto nodes = Index(surface.nodes.size());
  const Index triangles = surface.count();
  return py::make_tuple(owned_array(std::move(surface.nodes), nodes),
                        owned_array(std::move(surface.corners), triangles, 3),
                        owned_array(std::move(surface.cells), triangles));
}

/// Returns (cells × corners, points × 3, number of the obstacle of each cell) of the obstacles in a frame; None if
/// there are none.
py::object obstacles_of(const RunData& run, std::size_t frame) {
  if (frame >= run.obstacles.size()) return py::none();
  const ObstacleFrame& shown = run.obstacles[frame];
  std::vector<int> cells = shown.cells;
  std::vector<double> positions = shown.positions;
  std::vector<int> obstacle = shown.obstacle;
  const auto count = Index(cells.size()) / shown.corners, points = Index(positions.size()) / 3;
  return py::make_tuple(owned_array(std::move(cells), count, shown.corners),
                        owned_array(std::move(positions), points, 3), owned_array(std::move(obstacle), count));
}

std::string describe_runs(const std::vector<std::string>& directories, const std::vector<std::string>& what,
                          const std::vector<std::string>& labels, const std::string& title,
                          const std::optional<std::pair<double, double>>& time, bool logarithmic, double width,
                          double height) {
  const LibraryLock lock;
  return describe_figure_of(directories, {what, labels, title, time, logarithmic, width, height});
}

std::string describe_study(const std::string& directory, const std::vector<std::string>& what, const std::string& title,
                           bool logarithmic, double width, double height) {
  const LibraryLock lock;
  const Study study = read_study(directory);
  return describe_study_figure(study, make_study_table(study).table, {what, title, logarithmic, width, height});
}

void bind_run(py::module_& module) {
  py::class_<RunData>(module, "RunData")
      .def_readonly("directory", &RunData::directory)
      .def_readonly("summary_json", &RunData::summary_json)
      .def_readonly("notes", &RunData::notes)
      .def_property_readonly("column_names", &RunData::column_names)
      .def("column",
           [](const py::object& self, const std::string& name) {
             const std::vector<double>& values = self.cast<const RunData&>().column(name);
             return view(values.data(), Index(values.size()), 0, self);
           })
      .def("times_of",
           [](const py::object& self, const std::string& name) {
             const std::vector<double>& times = self.cast<const RunData&>().times_of(name);
             return view(times.data(), Index(times.size()), 0, self);
           })
      .def_property_readonly(
          "frame_times",
          [](const RunData& run) { return run.results != nullptr ? run.results->times() : std::vector<double>(); })
      .def_property_readonly("fields",
                             [](const RunData& run) {
                               std::vector<std::tuple<std::string, bool, int>> result;
                               if (run.results == nullptr) return result;
                               for (const ResultField& field : run.results->fields())
                                 result.emplace_back(field.name, field.on_nodes, field.components);
                               return result;
                             })
      .def("read_field", &read_field, py::arg("frame"), py::arg("name"))
      .def_property_readonly("points",
                             [](const py::object& self) {
                               const Points& nodes = results_of(self.cast<const RunData&>()).nodes();
                               return view(nodes.data(), nodes.cols(), nodes.rows(), self);
                             })
      .def_property_readonly("cells",
                             [](const RunData& run) { return cells_of(results_of(run).cells(), run.summary.degree); })
      .def_property_readonly(
          "contact_facets",
          [](const RunData& run) { return cells_of(results_of(run).contact_facets(), run.summary.degree); })
      .def_property_readonly("dimension", [](const RunData& run) { return run.summary.dimension; })
      .def("surface", &surface_of, py::arg("most"))
      .def("obstacles", &obstacles_of, py::arg("frame"));
  module.def("read_run", &read_run, py::arg("directory"));
  module.def("cell_types", &gmsh::converter_cell_types);
  module.def("holds_run", &holds_run, py::arg("directory"));
  module.def("is_in_use", &RunDirectory::is_in_use, py::arg("directory"));
}

}  // namespace

void bind_results(py::module_& module) {
  bind_run(module);
  module.def("describe_runs", &describe_runs, py::arg("directories"), py::arg("what"), py::arg("labels"),
             py::arg("title"), py::arg("time"), py::arg("logarithmic"), py::arg("width"), py::arg("height"));
  module.def("describe_study", &describe_study, py::arg("directory"), py::arg("what"), py::arg("title"),
             py::arg("logarithmic"), py::arg("width"), py::arg("height"));
  module.def(
      "make_report",
      [](const std::vector<std::string>& directories, const std::string& viewer) {
        const LibraryLock lock;
        Report report = make_report(directories, {.viewer = viewer});
        return std::make_pair(std::move(report.html), std::move(report.thinned));
      },
      py::arg("directories"), py::arg("viewer"));
}

}  // namespace ricochet::python
