#pragma once

#include <vector>

#include "ricochet/contact/sliding/sliding_pair.hpp"

/// @file Selection of the points that carry the conditions where a surface is in contact with itself.
///
/// Such a contact is detected from both sides, and the rows of both would be nearly identical: the Delassus operator W
/// would be singular. Two points are in conflict if one projects onto a node at which the other is anchored. The
/// selected points are a maximal set without conflicts (none can be added): no row involves the anchors of another one
/// from the opposite side, so that rows are as independent as those of the traces c. Selected points remain so as long
/// as they have no conflict; from them the selection grows over the surface to neighbours, and then restarts at the
/// point with the lowest number: of two sides that meet, one carries the conditions.
namespace ricochet {

class SelfContactSelection {
 public:
  /// `pair`: a surface that may come into contact with itself. `nodes`: number of nodes of the model.
  /// `degree`: of the displacement.
  SelfContactSelection(const SlidingPair& pair, Index nodes, int degree);

  enum class Choice : char { none, chosen, left_out };
  [[nodiscard]] const std::vector<Choice>& choices() const { return choices_; }
  /// Restores the selection of a resumed run.
  void restore(std::vector<Choice> choices) { choices_ = std::move(choices); }

  /// Selects among the active points, based on their views with rows; null, or facing nothing: inactive.
  void choose(const std::vector<const SlidingView*>& views);

 private:
  [[nodiscard]] bool is_free(std::size_t point) const;
  void select(std::size_t point);
  void grow();

  std::vector<std::vector<Index>> anchors_;           ///< nodes, of each point
  std::vector<std::vector<std::size_t>> neighbours_;  ///< points whose traces share a node
  std::vector<Choice> choices_;
  std::vector<const SlidingView*> views_;
  std::vector<char> is_faced_, is_anchor_;  ///< per node: whether it belongs to selected points
  std::vector<std::size_t> selected_;       ///< in order of selection
  std::size_t grown_ = 0;
  double least_weight_;  ///< least weight on the opposite side with which a point counts as facing a node
};

}  // namespace ricochet
