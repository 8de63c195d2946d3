#include "ricochet/study/study.hpp"

#include "bindings.hpp"
#include "ricochet/base/child_processes.hpp"
#include "ricochet/study/study_table.hpp"

namespace ricochet::python {

namespace {

/// Returns (names of the columns, rows, notes, warnings, number of completed runs).
py::tuple parts_of_results(const StudyResults& results) {
  return py::make_tuple(results.table.names(), results.table.rows, results.notes, results.warnings, results.done);
}

py::tuple conduct(const std::string& directory, const std::string& case_path, const std::vector<std::string>& settings,
                  const std::vector<std::pair<std::vector<std::string>, std::vector<std::vector<std::string>>>>& axes,
                  const py::dict& questions, std::size_t jobs, int threads, bool resume, bool force,
                  const std::string& program) {
  StudyPlan plan{case_path, settings, {}};
  for (const auto& [keys, values] : axes) plan.axes.push_back({keys, values});
  StudyQuestions asked;
  asked.quantities = questions["quantities"].cast<std::vector<std::string>>();
  asked.exact = questions["exact"].cast<std::vector<std::pair<std::string, double>>>();
  asked.reference = questions["reference"].cast<std::string>();
  asked.compare = questions["compare"].cast<std::vector<std::string>>();
  asked.order_key = questions["order"].cast<std::string>();
  SignalCheck signals;
  StudyOptions options;
  options.jobs = jobs > 0 ? jobs : std::max<std::size_t>(1, usable_cores() / std::size_t(threads));
  options.threads = threads;
  options.resume = resume;
  options.force = force;
  options.quiet = true;
  options.program = program;
  options.stop_signal = [&signals] { return signals(); };
  int signal = 0;
  StudyResults results;
  {
    const py::gil_scoped_release unlocked;
    results = conduct_study(directory, plan, asked, options, signal);
  }
  signals.raise();
  return parts_of_results(results);
}

}  // namespace

void bind_study(py::module_& module) {
  module.def("conduct_study", &conduct, py::arg("directory"), py::arg("case_path"), py::arg("settings"),
             py::arg("axes"), py::arg("questions"), py::arg("jobs"), py::arg("threads"), py::arg("resume"),
             py::arg("force"), py::arg("program"));
  module.def(
      "read_study",
      [](const std::string& directory) {
        StudyResults results;
        {
          const py::gil_scoped_release unlocked;
          results = make_study_table(read_study(directory));
        }
        return parts_of_results(results);
      },
      py::arg("directory"));
  module.def("holds_study", &holds_study, py::arg("directory"));
}

}  // namespace ricochet::python
