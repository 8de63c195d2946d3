#pragma once

#include <array>

#include "ricochet/base/snapshot.hpp"

/// @file Lengths of the parts in which steps without a solution are taken.
namespace ricochet {

/// Chooses the length of the next part, h 2^-k for steps of length h; k is its level, and level 0 is the whole step. A
/// part without a solution is halved. As difficulties last for many steps, a step begins with the length with which the
/// last one ended. After each part, one of twice the length follows if it fits into the step and if, since such a part
/// has failed, at least its own length was solved. This pause doubles with every further failure, up to `longest_pause`
/// lengths, until one succeeds: where only shorter parts have solutions, one attempt in 2 longest_pause + 1 fails, and
/// after a step that fails once whole ones follow. (A step whose first part has no solution down to the shortest length
/// is attempted whole: Simulation.)
///
/// Without `memory` every step begins whole, and after each part the longest one that fits into the step follows. This
/// is for linear forces, where steps without a solution are accidents of contact and no difficulties that last.
class PartLengths {
 public:
  static constexpr int deepest = 8;             ///< level of the shortest parts
  static constexpr long whole = 1L << deepest;  ///< length of a step in shortest parts
  static constexpr int longest_pause = 8;

  explicit PartLengths(bool memory = true) : memory_(memory) {}
  /// Level of the next part.
  [[nodiscard]] int level() const { return level_; }
  [[nodiscard]] bool is_shortest() const { return level_ == deepest; }
  /// Length of the present step that has been solved, in shortest parts; 0 between two steps.
  [[nodiscard]] long done() const { return done_; }
  /// Records that the next part was solved.
  void record_solution();
  /// Records that the next part, which is not the shortest, has no solution.
  void record_failure();
  /// Persists the lengths between two steps.
  void persist(const SnapshotVisitor& visit);

 private:
  bool memory_;
  int level_ = 0;
  long done_ = 0;
  /// Attempts at parts of a level, except the deepest.
  struct Attempts {
    long wait = 0;  ///< length to be solved before such a part is attempted
    int pause = 1;  ///< pause after its next failure, in its own lengths
  };
  std::array<Attempts, deepest> attempts_;
};

}  // namespace ricochet
