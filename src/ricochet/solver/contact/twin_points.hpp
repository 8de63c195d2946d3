#pragma once

#include <vector>

#include "ricochet/solver/contact/contact_problem.hpp"

/// @file Nearly identical points of a contact problem.
namespace ricochet {

/// A node that meets several planes which are parallel except for a tiny angle has a contact point for each of them,
/// with nearly identical rows of W. Gaps that differ by little more than their rounding decide which of them presses:
/// everything that uses W as a whole makes the reactions oscillate between them. One of them at a time makes a regular
/// problem; if another one of its group then penetrates, it takes over.
class TwinPoints {
 public:
  /// Discards the groups, for another W.
  void forget() {
    groups_.clear();
    is_analysed_ = false;
  }
  /// Returns whether there are any. Searches for them at the first call, in a dense W only.
  bool any(const ContactOperator& w, const std::vector<Index>& first);
  /// Keeps of each group only the deepest point in `selected`, with the reactions of all. To be called after `any`.
  void choose(const ContactProblem& problem, const Vector& motion, std::vector<char>& selected, Vector& reaction);
  /// Replaces, after `choose`, the point of a group by another one that penetrates deeper. Returns whether any was
  /// replaced. Works only a few times.
  bool exchange(const ContactProblem& problem, const Vector& motion, std::vector<char>& selected, Vector& reaction);

 private:
  struct Group {
    std::vector<Index> points;  ///< of the problem
    Index chosen = -1;          ///< its point; −1: the group is unchanged, as its points have different laws
  };
  static void replace(const ContactProblem& problem, Group& group, Index point, std::vector<char>& selected,
                      Vector& reaction);

  std::vector<Group> groups_;
  bool is_analysed_ = false;
  int exchanges_left_ = 0;
};

}  // namespace ricochet
