#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "ricochet/base/contact_status.hpp"
#include "ricochet/base/types.hpp"

/// @file The module ricochet._core: the interface of the library for the Python package. Names and checks for users are
/// in the package's own files; this module provides the numbers, without copies. Functions that may take time release
/// Python's lock.
namespace ricochet::python {

namespace py = pybind11;

void bind_errors(py::module_& module);
void bind_log(py::module_& module);
void bind_case(py::module_& module);
void bind_session(py::module_& module);
void bind_results(py::module_& module);
void bind_contact(py::module_& module);
void bind_mass(py::module_& module);
void bind_study(py::module_& module);

/// Releases Python's lock and acquires the library's. HDF5 supports one thread at a time, and no thread can write to a
/// file that another has open for reading. Simultaneous steps of several sessions would also have different bits.
class LibraryLock {
 public:
  LibraryLock() : lock_(mutex()) {}

 private:
  /// Recursive, as a handler of messages may read a run.
  static std::recursive_mutex& mutex();

  py::gil_scoped_release unlocked_;
  std::lock_guard<std::recursive_mutex> lock_;
};

/// Checks whether Python requests a stop (Ctrl-C), after every step but not so often that the checks become noticeable.
/// Stores the exception raised by the signal handler.
class SignalCheck {
 public:
  /// Returns 0, or the number of the signal that requests the end.
  int operator()();
  /// Throws the stored exception, if any. Must be called with Python's lock.
  void raise();

 private:
  double last_check_ = 0.0;
  int signal_ = 0;  ///< signal that raised the exception
  std::optional<py::error_already_set> raised_;
};

/// Returns a read-only numpy array that views numbers of `owner`, which it keeps alive: rows × columns (0: one
/// dimension), row by row.
template <class Number>
[[nodiscard]] py::array_t<Number> view(const Number* numbers, Index rows, Index columns, py::handle owner) {
  py::array_t<Number> result = columns > 0 ? py::array_t<Number>({rows, columns}, numbers, owner)
                                           : py::array_t<Number>(std::vector<py::ssize_t>{rows}, numbers, owner);
  result.attr("flags").attr("writeable") = false;
  return result;
}

/// Returns an array that takes over the ownership of its numbers.
template <class Container>
[[nodiscard]] auto owned_array(Container numbers, Index rows, Index columns = 0) {
  auto* kept = new Container(std::move(numbers));
  const py::capsule owner(kept, [](void* object) { delete static_cast<Container*>(object); });
  using Number = std::remove_cvref_t<decltype(*kept->data())>;
  return columns > 0 ? py::array_t<Number>({rows, columns}, kept->data(), owner)
                     : py::array_t<Number>(std::vector<py::ssize_t>{rows}, kept->data(), owner);
}

/// Returns the statuses as integers.
[[nodiscard]] inline py::array_t<int> numbers_of(const std::vector<ContactStatus>& status) {
  std::vector<int> numbers;
  for (const ContactStatus one : status) numbers.push_back(int(one));
  const auto count = Index(numbers.size());
  return owned_array(std::move(numbers), count);
}

/// Copy of a numpy array, or of any object that numpy converts to one, row by row.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
[[nodiscard]] inline Vector vector_of(const Numbers& numbers) {
  return Eigen::Map<const Vector>(numbers.data(), numbers.size());
}

/// Returns (data, indices, indptr, size) of a symmetric matrix in compressed columns, for scipy.sparse.
[[nodiscard]] py::tuple parts_of(SparseMatrix matrix);
/// Makes a matrix from these parts; the columns must be sorted and without duplicates.
using Indices = py::array_t<int, py::array::c_style | py::array::forcecast>;
[[nodiscard]] SparseMatrix sparse_matrix(const Numbers& data, const Indices& indices, const Indices& starts,
                                         Index size);

}  // namespace ricochet::python
