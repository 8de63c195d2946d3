#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/types.hpp"

/// @file A body that is distributed among processes, its ranks: the interface that the rest of the library uses. The
/// base class implements it for a single process, by returning its arguments. All functions that involve more than one
/// rank are collective: all ranks call them, and wait for each other.
namespace ricochet {

/// How the value of the whole body follows from those of the ranks.
enum class Reduction : char {
  sum,      ///< of contributions: each cell, contact point and support belongs to one rank
  minimum,  ///< of values that each rank has for its own part
  maximum,
  same,  ///< every rank has the value already
};

/// Amount of data that a rank has sent to others so far.
struct Traffic {
  std::int64_t messages = 0, bytes = 0;
  std::int64_t reductions = 0;  ///< collective ones in which it took part, as at the end of an exchange

  Traffic& operator+=(const Traffic& other) {
    messages += other.messages;
    bytes += other.bytes;
    reductions += other.reductions;
    return *this;
  }
};

/// Motions (displacements, velocities, …) are consistent: all ranks that share a node have the same values there.
/// Forces are additive: the force at a shared node is the sum of the contributions of its ranks. Hence the product of a
/// motion and a force, and any energy, is a sum over ranks of terms that each computes alone.
class Ranks {
 public:
  template <class Number>
  using ForEach = std::vector<std::vector<Number>>;  ///< rank by rank

  virtual ~Ranks() = default;
  [[nodiscard]] virtual int rank() const { return 0; }
  [[nodiscard]] virtual int size() const { return 1; }
  [[nodiscard]] bool are_several() const { return size() > 1; }
  /// Whether this rank communicates for all, with people and in files.
  [[nodiscard]] bool is_first() const { return rank() == 0; }

  /// Replaces the values of this rank by those of the whole body; one exchange for all.
  virtual void reduce(std::span<double> /* values */, std::span<const Reduction> /* by */) const {}
  /// Makes an additive force consistent. All nodes have the same number of values.
  virtual void accumulate(Vector& /* force */) const {}
  virtual void accumulate(Eigen::VectorXf& /* force */) const {}
  /// Whether this rank owns the node: the one rank that counts it.
  [[nodiscard]] virtual bool is_owned(Index /* node */) const { return true; }
  /// Nodes that another rank owns, ascending: a sum over all nodes subtracts their contributions again.
  [[nodiscard]] virtual std::span<const Index> not_owned() const { return {}; }

  /// Whether all ranks arrive here within so many seconds; used after an error that perhaps only this rank has found.
  [[nodiscard]] virtual bool all_arrive(double /* seconds */) const { return true; }
  [[nodiscard]] virtual Traffic traffic() const { return {}; }
  /// Number of a node of this rank in the whole body.
  [[nodiscard]] virtual std::int64_t number_of(Index node) const { return node; }
  /// Sends one list to each rank and returns the list received from each rank.
  [[nodiscard]] virtual ForEach<double> exchange(ForEach<double> to_each) const { return to_each; }
  [[nodiscard]] virtual ForEach<std::int64_t> exchange(ForEach<std::int64_t> to_each) const { return to_each; }

  /// Returns the values of every rank, on every rank.
  [[nodiscard]] ForEach<double> all_gather(const std::vector<double>& own) const {
    return exchange(ForEach<double>(std::size_t(size()), own));
  }
  /// Returns the texts of all ranks on the first rank; none on the others.
  [[nodiscard]] std::vector<std::string> gather_texts(const std::string& own) const;
  /// Sums several numbers over the ranks, in place.
  void sum(std::span<double> values) const;

  [[nodiscard]] double sum(double value) const { return reduced(value, Reduction::sum); }
  [[nodiscard]] double minimum(double value) const { return reduced(value, Reduction::minimum); }
  [[nodiscard]] double maximum(double value) const { return reduced(value, Reduction::maximum); }
  /// Returns whether the value is true on some rank.
  [[nodiscard]] bool any(bool value) const { return maximum(value ? 1.0 : 0.0) > 0.0; }
  /// Runs work on each rank. If it throws an Error on some ranks, all ranks throw that of the first of them.
  void run_collectively(const std::function<void()>& work) const;

 private:
  [[nodiscard]] double reduced(double value, Reduction by) const {
    reduce({&value, 1}, {&by, 1});
    return value;
  }
};

/// Returns the ranks of a single process.
[[nodiscard]] inline const Ranks& one_rank() {
  static const Ranks alone;
  return alone;
}

}  // namespace ricochet
