#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "limits.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/linear_algebra/library_versions.hpp"
#include "ricochet/run/session.hpp"

// Measures the factorization of a case's operator and its solves: ours on one thread and on several, CHOLMOD's on one,
// and the time to read as much memory. They take turns, so that all see the same machine. Prints one JSON object.

namespace {

using namespace ricochet;
using namespace ricochet::bench;

constexpr int repeats = 5, solves_per_repeat = 3;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Returns processor time on one thread, else wall-clock time.
template <class Work>
double seconds(const Work& work) {
  const StepTimer timer;
  work();
  return timer.seconds();
}

struct Times {
  std::vector<double> factorization, forward, backward, reading;

  void measure(SparseCholesky& factor, const SparseMatrix& matrix, MemoryReader& memory, const Vector& right) {
    factorization.push_back(seconds([&] { factor.refactorize(matrix); }));
    Vector y;
    for (int i = 0; i < solves_per_repeat; ++i) {
      factor.forward(right, y);
      forward.push_back(seconds([&] { factor.solve_lower(y); }));
      backward.push_back(seconds([&] { factor.solve_upper(y); }));
      reading.push_back(memory.seconds());
    }
  }
  void print(const char* name) const {
    fmt::print(
        R"(, "{}": {{"factorization_s": {:.4g}, "forward_ms": {:.4g}, "backward_ms": {:.4g}, "reading_ms": {:.4g}}})",
        name, median(factorization), 1e3 * median(forward), 1e3 * median(backward), 1e3 * median(reading));
  }
};

void run(const std::string& path, int threads) {
  Session session(path);
  session.build(nullptr);
  const SemidiscreteProblem& problem = session.model().problem;
  const OperatorCoefficients a = session.scheme().operators(problem).back();
  const SparseMatrix matrix = a.stiffness * problem.internal_force->tangent() + a.mass * problem.mass.to_sparse();
  SparseCholesky own, library;
  const double ordering = seconds([&] { own.analyse(matrix); });
  own.factorize();
  library.analyse(matrix);
  library.factorize(SparseCholesky::Arithmetic::library);
  MemoryReader memory(own.factor_bytes());
  const Vector right = Vector::Ones(matrix.cols());
  Vector one_result, result;
  Times one, several, theirs;
  for (int k = 0; k < repeats; ++k) {
    set_thread_count(1);
    one.measure(own, matrix, memory, right);
    own.solve(right, one_result);
    theirs.measure(library, matrix, memory, right);
    set_thread_count(threads);
    several.measure(own, matrix, memory, right);
    own.solve(right, result);
    if (result != one_result) throw std::runtime_error("bits depend on the number of threads");
  }
  library.solve(right, result);
  fmt::print(R"({{"case": "{}", "libraries": "{}", "dimension": {}, "dofs": {}, "contact_points": {}, "threads": {}, )",
             path, library_versions(), problem.dimension, matrix.cols(), problem.contact.size(), threads);
  fmt::print(
      R"("factor_mb": {:.5g}, "operations": {:.5g}, "ordering_s": {:.4g}, "residual": {:.2g}, "difference": {:.2g})",
      1e-6 * double(own.factor_bytes()), own.predicted().operations, ordering,
      (matrix * one_result - right).norm() / right.norm(), (one_result - result).norm() / result.norm());
  one.print("one");
  several.print("several");
  theirs.print("library");
  fmt::print("}}\n");
}

}  // namespace

int main(int count, char** arguments) {
  log::set_level(log::Level::error);
  try {
    if (count < 2) throw Error(ErrorKind::usage, "usage: ricochet_factor_bench CASE.toml [THREADS]");
    run(arguments[1], count > 2 ? std::stoi(arguments[2]) : 2);
  } catch (const std::exception& problem) {
    fmt::print(stderr, "{}\n", problem.what());
    return 2;
  }
  return 0;
}
