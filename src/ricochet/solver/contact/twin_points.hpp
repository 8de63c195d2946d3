#pragma once

#include <vector>

#include "ricochet/solver/contact/contact_problem.hpp"

/// @file Points of a contact problem that are nearly one.
namespace ricochet {

/// A node that meets several planes which are parallel but for a tiny angle has a contact point for each of them, with
/// rows of W that are nearly the same. Which of them presses is decided by gaps that differ by little more than their
/// rounding: all that makes use of W as a whole pushes reactions to and fro between them. One of them at a time makes a
/// problem like any other; where another one of its group then penetrates, it takes its place.
class TwinPoints {
 public:
  /// For another W.
  void forget() {
    groups_.clear();
    is_known_ = false;
  }
  /// Whether there are any. Looks for them when it is asked for the first time: only a dense W is looked at.
  bool any(const ContactOperator& w, const std::vector<Index>& first);
  /// After `any`: leaves of each group only the deepest one in `wanted` and gives it the reactions of all.
  void choose(const ContactProblem& problem, const Vector& motion, std::vector<char>& wanted, Vector& reaction);
  /// After `choose`: where another one of a group penetrates, and deeper, it takes the place. True: somewhere it did.
  /// No more than a few times.
  bool exchange(const ContactProblem& problem, const Vector& motion, std::vector<char>& wanted, Vector& reaction);

 private:
  struct Group {
    std::vector<Index> points;  ///< of the problem
    Index chosen = -1;          ///< its point; −1: the group is as it was, for its points are under different laws
  };
  static void replace(const ContactProblem& problem, Group& group, Index point, std::vector<char>& wanted,
                      Vector& reaction);

  std::vector<Group> groups_;
  bool is_known_ = false;
  int exchanges_left_ = 0;
};

}  // namespace ricochet
