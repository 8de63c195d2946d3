#include "limits.hpp"

#include <algorithm>

#include "ricochet/base/instruction_sets.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/node_matrix.hpp"

namespace ricochet::bench {

namespace {

/// Number of streams: the processor prefetches several at a time, so that one core gets more from memory than with one.
constexpr std::size_t places = 4, at_once = 16;

RICOCHET_EACH_INSTRUCTION_SET(double, sum_of, (const double* values, std::size_t count), (values, count)) {
  double sums[places * at_once] = {};
  const std::size_t quarter = count / places;
  for (std::size_t i = 0; i + at_once <= quarter; i += at_once) {
    for (std::size_t place = 0; place < places; ++place) {
      for (std::size_t k = 0; k < at_once; ++k) sums[place * at_once + k] += values[place * quarter + i + k];
    }
  }
  double total = 0.0;
  for (const double sum : sums) total += sum;
  return total;
}

std::size_t bytes_of_explicit_step(const SemidiscreteProblem& problem, std::size_t factor_entries) {
  const SparseMatrix stiffness = problem.internal_force->tangent();
  const NodeMatrix blocks(stiffness, problem.dimension);
  std::size_t contact_entries = 2 * factor_entries;
  for (const Index dof : problem.contact_dofs) contact_entries += std::size_t(stiffness.col(dof).nonZeros());
  constexpr std::size_t vectors = 9;
  return blocks.bytes() + sizeof(double) * (contact_entries + vectors * std::size_t(problem.dof_count()));
}

}  // namespace

MemoryReader::MemoryReader(std::size_t bytes) : values_(std::max<std::size_t>(bytes / sizeof(double), 1024), 1.0) {}

double MemoryReader::seconds() {
  const StepTimer timer;
  const auto threads = std::size_t(thread_count());
  std::vector<double> sums(threads);
  parallel_items(thread_count(), [&](Index thread) {
    const auto t = std::size_t(thread);
    sums[t] = sum_of(values_.data() + values_.size() * t / threads, values_.size() / threads);
  });
  sink_ = sink_ + sums[0];
  return timer.seconds();
}

DirectLimits::DirectLimits(const SparseMatrix& matrix)
    : library_(matrix, SparseCholesky::Arithmetic::library),
      own_(matrix),
      memory_(own_.factor_bytes()),
      right_(Vector::Ones(matrix.cols())) {}

void DirectLimits::measure(LimitTimes& times) {
  times.library.push_back(solve(library_));
  times.own.push_back(solve(own_));
  static_cast<void>(memory_.seconds());
  times.memory.push_back(2.0 * memory_.seconds());
}

/// Returns the time of the second of two solves, when the caches are as in a sequence of solves.
double DirectLimits::solve(SparseCholesky& factor) {
  double seconds = 0.0;
  for (int k = 0; k < 2; ++k) {
    const StepTimer timer;
    factor.forward(right_, y_);
    factor.backward(y_, x_);
    seconds = timer.seconds();
  }
  return seconds;
}

ExplicitLimits::ExplicitLimits(const SemidiscreteProblem& problem, std::size_t factor_entries)
    : bytes_(bytes_of_explicit_step(problem, factor_entries)), memory_(bytes_) {}

void ExplicitLimits::measure(LimitTimes& times) {
  static_cast<void>(memory_.seconds());
  times.memory.push_back(memory_.seconds());
}

}  // namespace ricochet::bench
