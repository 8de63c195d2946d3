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

/// @file The module ricochet._core: what the Python package takes from the library. Names and checks that users meet
/// are in the package's own files; here are the numbers, without copies. Whatever may take time lets go of Python's
/// lock.
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

/// Lets go of Python's lock and takes the library's. HDF5 is for one thread at a time, and no thread can write to a
/// file that another one has open to read. Sessions that step at once would have other bits, too.
class LibraryLock {
 public:
  LibraryLock() : lock_(mutex()) {}

 private:
  /// What is said to a handler of messages may read a run.
  static std::recursive_mutex& mutex();

  py::gil_scoped_release unlocked_;
  std::lock_guard<std::recursive_mutex> lock_;
};

/// Asks whether Python wants to stop (Ctrl-C): after every step, but not more often than Python can answer without
/// being felt. Remembers the exception that a signal's handler has raised.
class SignalCheck {
 public:
  /// 0, or the number of a signal that is to end the work.
  int operator()();
  /// Throws what has been raised, if anything. With the lock.
  void raise();

 private:
  double last_asked_ = 0.0;
  int signal_ = 0;  ///< that has raised it
  std::optional<py::error_already_set> raised_;
};

/// A numpy array that shows numbers of `owner`, which lives as long as it: rows × columns (0: one dimension), row by
/// row. It cannot be written to.
template <class Number>
[[nodiscard]] py::array_t<Number> view(const Number* numbers, Index rows, Index columns, py::handle owner) {
  py::array_t<Number> result = columns > 0 ? py::array_t<Number>({rows, columns}, numbers, owner)
                                           : py::array_t<Number>(std::vector<py::ssize_t>{rows}, numbers, owner);
  result.attr("flags").attr("writeable") = false;
  return result;
}

/// The same of numbers that nobody else has any more.
template <class Container>
[[nodiscard]] auto give(Container numbers, Index rows, Index columns = 0) {
  auto* kept = new Container(std::move(numbers));
  const py::capsule owner(kept, [](void* object) { delete static_cast<Container*>(object); });
  using Number = std::remove_cvref_t<decltype(*kept->data())>;
  return columns > 0 ? py::array_t<Number>({rows, columns}, kept->data(), owner)
                     : py::array_t<Number>(std::vector<py::ssize_t>{rows}, kept->data(), owner);
}

/// As whole numbers.
[[nodiscard]] inline py::array_t<int> numbers_of(const std::vector<ContactStatus>& status) {
  std::vector<int> numbers;
  for (const ContactStatus one : status) numbers.push_back(static_cast<int>(one));
  const auto count = static_cast<Index>(numbers.size());
  return give(std::move(numbers), count);
}

/// A copy of numpy's numbers, or of whatever numpy makes an array of, row by row.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
[[nodiscard]] inline Vector vector_of(const Numbers& numbers) {
  return Eigen::Map<const Vector>(numbers.data(), numbers.size());
}

/// (data, indices, indptr, size) of a symmetric matrix in compressed columns, for scipy.sparse.
[[nodiscard]] py::tuple parts_of(SparseMatrix matrix);
/// The other way; the columns are sorted and without duplicates.
using Indices = py::array_t<int, py::array::c_style | py::array::forcecast>;
[[nodiscard]] SparseMatrix sparse_matrix(const Numbers& data, const Indices& indices, const Indices& starts,
                                         Index size);

}  // namespace ricochet::python
