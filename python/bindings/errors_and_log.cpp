#include <exception>

#include "bindings.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"

namespace ricochet::python {

namespace {

/// Returns a function of the package, by module and name. The module is loaded, as the package has loaded this one.
py::object function(const char* module, const char* name) { return py::module_::import(module).attr(name); }

/// Decodes a message, which may quote invalid UTF-8 from damaged files.
py::object readable(const std::string& text) {
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace"));
}

void translate(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const Error& problem) {
    const py::object raised = function("ricochet.errors", "from_core")(problem.exit_status(), readable(problem.what()));
    PyErr_SetObject(py::type::of(raised).ptr(), raised.ptr());
  }
}

void hand_to_python(log::Level level, const std::string& message) {
  if (Py_IsInitialized() == 0) return;
  const py::gil_scoped_acquire lock;
  try {
    function("ricochet.messages", "from_core")(int(level), readable(message));
  } catch (py::error_already_set& problem) {
    // Ctrl-C while a handler writes: the check after the step must see it.
    if (problem.matches(PyExc_KeyboardInterrupt))
      PyErr_SetInterrupt();
    else
      problem.discard_as_unraisable("a message of Ricochet");
  }
}

}  // namespace

void bind_errors(py::module_&) { py::register_exception_translator(translate); }

void bind_log(py::module_& module) {
  log::set_sink(hand_to_python);
  module.def(
      "set_log_level", [](const std::string& level) { log::set_level(log::parse_level(level)); }, py::arg("level"));
  // Python's objects are gone before the library's static data.
  py::module_::import("atexit").attr("register")(py::cpp_function([] { log::set_sink({}); }));
}

}  // namespace ricochet::python
