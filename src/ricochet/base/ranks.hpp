#pragma once

#include <span>

#include "ricochet/base/types.hpp"

/// @file A body that is divided among processes, its ranks. Here is what the rest of the library asks of them, or will
/// (`accumulate`, once there are several); one process alone answers with what it was given.
namespace ricochet {

/// How the number of the whole body comes from those of the ranks.
enum class Reduction : char {
  sum,      ///< of parts: each cell, contact point and support belongs to one rank
  minimum,  ///< of values that each rank has of its own part
  maximum,
  same,  ///< every rank has the number already
};

/// Motions (displacements, velocities, …) are consistent: all ranks that share a node have the same values there.
/// Forces are additive: the force at a shared node is the sum of what its ranks have. So the product of a motion and a
/// force, and any energy, is a sum over ranks of what each computes alone.
class Ranks {
 public:
  virtual ~Ranks() = default;
  /// The numbers of the whole body from those of this rank, in place; one exchange for all.
  virtual void reduce(std::span<double> /* values */, std::span<const Reduction> /* by */) const {}
  /// Makes an additive force consistent: as many numbers for each node as there are.
  virtual void accumulate(Vector& /* force */) const {}
  virtual void accumulate(Eigen::VectorXf& /* force */) const {}
  /// Whether this rank speaks for the node where it is counted once.
  [[nodiscard]] virtual bool is_owned(Index /* node */) const { return true; }
  /// The nodes for which another rank speaks, ascending: what they have in a sum over all nodes is taken off again.
  [[nodiscard]] virtual std::span<const Index> not_owned() const { return {}; }

  [[nodiscard]] double sum(double value) const { return reduced(value, Reduction::sum); }
  [[nodiscard]] double minimum(double value) const { return reduced(value, Reduction::minimum); }
  [[nodiscard]] double maximum(double value) const { return reduced(value, Reduction::maximum); }
  /// On some rank.
  [[nodiscard]] bool any(bool value) const { return maximum(value ? 1.0 : 0.0) > 0.0; }

 private:
  [[nodiscard]] double reduced(double value, Reduction by) const {
    reduce({&value, 1}, {&by, 1});
    return value;
  }
};

/// One process.
[[nodiscard]] inline const Ranks& one_rank() {
  static const Ranks alone;
  return alone;
}

}  // namespace ricochet
