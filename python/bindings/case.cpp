#include "ricochet/case/case.hpp"

#include "bindings.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"

namespace ricochet::python {

namespace {

/// A case with the warnings issued while reading it.
struct ReadCase {
  Case input;
  std::vector<std::string> warnings;
};

ReadCase read(const std::function<Case()>& how) {
  const py::gil_scoped_release unlocked;
  ReadCase result;
  const log::CollectWarnings collect(result.warnings);
  result.input = how();
  return result;
}

}  // namespace

void bind_case(py::module_& module) {
  py::class_<Case>(module, "Case")
      .def_readonly("path", &Case::path)
      .def_readonly("title", &Case::title)
      .def_readonly("values", &Case::values);
  module.def(
      "read_case",
      [](const std::string& path, const std::vector<std::string>& changes) {
        ReadCase made = read([&] { return read_case(path, changes); });
        return std::make_pair(std::move(made.input), std::move(made.warnings));
      },
      py::arg("path"), py::arg("changes"));
  module.def(
      "read_case_text",
      [](const std::string& text, const std::string& path, const std::vector<std::string>& changes) {
        ReadCase made = read([&] { return read_case_text(text, path, changes); });
        return std::make_pair(std::move(made.input), std::move(made.warnings));
      },
      py::arg("text"), py::arg("path"), py::arg("changes"));
  module.def("case_schema", &case_schema);
  module.def("scheme_names", &scheme_names);
  module.def("mass_names", &mass_names);
  module.def("contact_solver_names", [] { return contact_solver_registry().names(); });
}

}  // namespace ricochet::python
