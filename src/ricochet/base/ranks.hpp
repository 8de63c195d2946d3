#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/types.hpp"

/// @file A body that is divided among processes, its ranks. Here is what the rest of the library asks of them; one
/// process alone answers with what it was given. All functions that are about more than one rank are called by all, and
/// wait for them.
namespace ricochet {

/// How the number of the whole body comes from those of the ranks.
enum class Reduction : char {
  sum,      ///< of parts: each cell, contact point and support belongs to one rank
  minimum,  ///< of values that each rank has of its own part
  maximum,
  same,  ///< every rank has the number already
};

/// What a rank has sent to others so far.
struct Traffic {
  std::int64_t messages = 0, bytes = 0;
  std::int64_t reductions = 0;  ///< that it took part in: all wait for all, as at the end of an exchange

  Traffic& operator+=(const Traffic& other) {
    messages += other.messages;
    bytes += other.bytes;
    reductions += other.reductions;
    return *this;
  }
};

/// Motions (displacements, velocities, …) are consistent: all ranks that share a node have the same values there.
/// Forces are additive: the force at a shared node is the sum of what its ranks have. So the product of a motion and a
/// force, and any energy, is a sum over ranks of what each computes alone.
class Ranks {
 public:
  template <class Number>
  using ForEach = std::vector<std::vector<Number>>;  ///< rank by rank

  virtual ~Ranks() = default;
  [[nodiscard]] virtual int rank() const { return 0; }
  [[nodiscard]] virtual int size() const { return 1; }
  [[nodiscard]] bool are_several() const { return size() > 1; }
  /// The one that speaks for all: to people and in files.
  [[nodiscard]] bool is_first() const { return rank() == 0; }

  /// The numbers of the whole body from those of this rank, in place; one exchange for all.
  virtual void reduce(std::span<double> /* values */, std::span<const Reduction> /* by */) const {}
  /// Makes an additive force consistent: as many numbers for each node as there are.
  virtual void accumulate(Vector& /* force */) const {}
  virtual void accumulate(Eigen::VectorXf& /* force */) const {}
  /// Whether this rank speaks for the node where it is counted once.
  [[nodiscard]] virtual bool is_owned(Index /* node */) const { return true; }
  /// The nodes for which another rank speaks, ascending: what they have in a sum over all nodes is taken off again.
  [[nodiscard]] virtual std::span<const Index> not_owned() const { return {}; }

  /// Whether all come here within so many seconds: after an error that maybe only this rank has found.
  [[nodiscard]] virtual bool all_arrive(double /* seconds */) const { return true; }
  [[nodiscard]] virtual Traffic traffic() const { return {}; }
  /// Of a node of this rank in the whole body.
  [[nodiscard]] virtual std::int64_t number_of(Index node) const { return node; }
  /// What each rank has for each, handed over: of the result, too, there is one for every rank.
  [[nodiscard]] virtual ForEach<double> exchange(ForEach<double> to_each) const { return to_each; }
  [[nodiscard]] virtual ForEach<std::int64_t> exchange(ForEach<std::int64_t> to_each) const { return to_each; }

  /// What every rank has, for all.
  [[nodiscard]] ForEach<double> of_all(const std::vector<double>& own) const {
    return exchange(ForEach<double>(static_cast<std::size_t>(size()), own));
  }
  /// Texts of all ranks, for the first; of the others, none.
  [[nodiscard]] std::vector<std::string> texts_of_all(const std::string& own) const;
  /// Sums of several numbers, in place.
  void sum(std::span<double> values) const;

  [[nodiscard]] double sum(double value) const { return reduced(value, Reduction::sum); }
  [[nodiscard]] double minimum(double value) const { return reduced(value, Reduction::minimum); }
  [[nodiscard]] double maximum(double value) const { return reduced(value, Reduction::maximum); }
  /// On some rank.
  [[nodiscard]] bool any(bool value) const { return maximum(value ? 1.0 : 0.0) > 0.0; }
  /// What each rank does for itself. Where it throws an Error on some rank all throw that of the first one.
  void together(const std::function<void()>& work) const;

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
