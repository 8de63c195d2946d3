#include <csignal>

#include "bindings.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/version.hpp"

namespace ricochet::python {

namespace {

/// Seconds between checks of Python's signals.
constexpr double signal_interval = 0.05;

/// Returns the number of a signal: ricochet/stopping.py ends Python with the status 128 + N; other exceptions count as
/// Ctrl-C.
int number_of(const py::error_already_set& raised) {
  constexpr int first_status = 128;
  if (!raised.matches(PyExc_SystemExit)) return SIGINT;
  const py::object code = py::getattr(raised.value(), "code", py::none());
  const int status = py::isinstance<py::int_>(code) ? code.cast<int>() : 0;
  return status == first_status + SIGTERM || status == first_status + SIGHUP ? status - first_status : SIGINT;
}

}  // namespace

std::recursive_mutex& LibraryLock::mutex() {
  static std::recursive_mutex one_at_a_time;
  return one_at_a_time;
}

int SignalCheck::operator()() {
  static const Timer clock;
  const double now = clock.seconds();
  if (!raised_ && now - last_check_ > signal_interval) {
    last_check_ = now;
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) {
      raised_.emplace();
      signal_ = number_of(*raised_);
    }
  }
  return raised_ ? signal_ : 0;
}

void SignalCheck::raise() {
  if (!raised_) return;
  const py::error_already_set raised = std::move(*raised_);
  raised_.reset();
  throw raised;
}

py::tuple parts_of(SparseMatrix matrix) {
  matrix.makeCompressed();
  auto* kept = new SparseMatrix(std::move(matrix));
  const py::capsule owner(kept, [](void* object) { delete static_cast<SparseMatrix*>(object); });
  const auto entries = static_cast<py::ssize_t>(kept->nonZeros());
  return py::make_tuple(py::array_t<double>(std::vector<py::ssize_t>{entries}, kept->valuePtr(), owner),
                        py::array_t<int>(std::vector<py::ssize_t>{entries}, kept->innerIndexPtr(), owner),
                        py::array_t<int>(std::vector<py::ssize_t>{kept->cols() + 1}, kept->outerIndexPtr(), owner),
                        kept->cols());
}

SparseMatrix sparse_matrix(const Numbers& data, const Indices& indices, const Indices& starts, Index size) {
  return Eigen::Map<const SparseMatrix>(size, size, data.size(), starts.data(), indices.data(), data.data());
}

}  // namespace ricochet::python

PYBIND11_MODULE(_core, module) {
  using namespace ricochet::python;
  module.doc() = "Bindings of the library of Ricochet, for the package ricochet.";
  module.attr("version") = ricochet::version;
  bind_errors(module);
  bind_log(module);
  bind_case(module);
  bind_session(module);
  bind_results(module);
  bind_contact(module);
  bind_mass(module);
  bind_study(module);
  module.def("set_thread_count", &ricochet::set_thread_count, py::arg("count"));
  module.def("thread_count", &ricochet::thread_count);
}
