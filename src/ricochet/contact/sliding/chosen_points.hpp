#pragma once

#include <vector>

#include "ricochet/contact/sliding/sliding_pair.hpp"

/// @file Which points carry the conditions where a surface touches itself.
///
/// Such a place is seen from both of its sides, and the rows of both would say nearly the same: W would be singular.
/// Two points are in conflict where one sees a node that the other is anchored at. The points that are chosen are a
/// maximal set without conflicts (none can be added): no row reaches the anchors of another one from the opposite side,
/// and so rows are as independent as those of the traces c are. Points that are chosen stay so while they are in no
/// conflict; from them the choice grows over the surface to neighbours, and then begins anew at the point with the
/// lowest number: of two sides that meet, one carries the conditions.
namespace ricochet {

class ChosenPoints {
 public:
  /// `pair` touches itself. `nodes`: of the model. `degree`: of the displacement.
  ChosenPoints(const SlidingPair& pair, Index nodes, int degree);

  enum class Choice : char { none, chosen, left_out };
  [[nodiscard]] const std::vector<Choice>& choices() const { return choices_; }
  /// As a run that is resumed knows them.
  void restore(std::vector<Choice> choices) { choices_ = std::move(choices); }

  /// Chooses among the points that are `near`, from what they see (views with rows); null or facing nothing: not near.
  void choose(const std::vector<const SlidingView*>& views);

 private:
  [[nodiscard]] bool is_free(std::size_t point) const;
  void take(std::size_t point);
  void grow();

  std::vector<std::vector<Index>> anchors_;           ///< nodes, of each point
  std::vector<std::vector<std::size_t>> neighbours_;  ///< points whose traces share a node
  std::vector<Choice> choices_;
  std::vector<const SlidingView*> views_;
  std::vector<char> is_seen_, is_anchor_;  ///< per node: of those that are chosen
  std::vector<std::size_t> taken_;         ///< in order
  std::size_t grown_ = 0;
  double sees_;  ///< of a point's weights on the opposite side
};

}  // namespace ricochet
