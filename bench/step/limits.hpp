#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "ricochet/base/parallel.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Lower limits of the time of a step, measured between the steps.
namespace ricochet::bench {

/// Measures processor time on one thread, which other programs do not disturb; on several threads it would be a sum.
class StepTimer {
 public:
  [[nodiscard]] double seconds() const {
    return thread_count() == 1 ? processor_.seconds() : std::chrono::duration<double>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  ProcessorTimer processor_;
  Clock::time_point start_ = Clock::now();
};

/// Reads memory as fast as the available threads can in plain loops.
class MemoryReader {
 public:
  explicit MemoryReader(std::size_t bytes);
  /// Returns the seconds to read all of it once.
  [[nodiscard]] double seconds();

 private:
  std::vector<double> values_;
  volatile double sink_ = 0.0;
};

/// In seconds.
struct LimitTimes {
  std::vector<double> library, own, memory;
};

class Limits {
 public:
  virtual ~Limits() = default;
  virtual void measure(LimitTimes& times) = 0;
  /// Returns the number of bytes that a step must read once, or twice.
  [[nodiscard]] virtual std::size_t bytes() const = 0;
};

/// For a step with a factor: the plain triangular solve, CHOLMOD's and ours, and reading the factor twice.
class DirectLimits final : public Limits {
 public:
  /// Takes the operator of a step.
  explicit DirectLimits(const SparseMatrix& matrix);
  void measure(LimitTimes& times) override;
  [[nodiscard]] std::size_t bytes() const override { return own_.factor_bytes(); }

 private:
  double solve(SparseCholesky& factor);

  SparseCholesky library_, own_;
  MemoryReader memory_;
  Vector right_, y_, x_;
};

/// For an explicit step: reading the blocks of K; for the system of the contact nodes their rows of K, which are needed
/// before these nodes have moved, and the factor twice; and nine vectors: U, V and A read and written, M⁻¹, the loads
/// and ΔU, as central differences require if all of these are kept and nothing is accessed twice.
class ExplicitLimits final : public Limits {
 public:
  ExplicitLimits(const SemidiscreteProblem& problem, std::size_t factor_entries);
  void measure(LimitTimes& times) override;
  [[nodiscard]] std::size_t bytes() const override { return bytes_; }

 private:
  std::size_t bytes_;
  MemoryReader memory_;
};

}  // namespace ricochet::bench
