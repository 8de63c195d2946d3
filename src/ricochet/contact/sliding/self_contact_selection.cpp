#include "ricochet/contact/sliding/self_contact_selection.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace ricochet {

namespace {

/// Weight on the opposite side, out of a sum of 1, below which a node is only touched at its support's boundary. Shape
/// functions of degree 2 may cancel at the vertices of the facing part: there any weight counts.
constexpr double at_the_rim = 1e-3;

template <class Visit>
void visit_faced_nodes(const SlidingView& view, double least_weight, const Visit& visit) {
  for (const auto& [node, weight] : view.opposite) {
    if (std::abs(weight) >= least_weight) visit(node);
  }
}

}  // namespace

SelfContactSelection::SelfContactSelection(const SlidingPair& pair, Index nodes, int degree)
    : choices_(pair.points().size(), Choice::none),
      is_faced_(std::size_t(nodes)),
      is_anchor_(std::size_t(nodes)),
      least_weight_(degree == 1 ? at_the_rim : 0.0) {
  std::map<Index, std::vector<std::size_t>> at_node;
  for (std::size_t i = 0; i < pair.points().size(); ++i) {
    const Multiplier& multiplier = pair.points()[i].multiplier;
    std::vector<Index>& anchors = anchors_.emplace_back();
    for (const auto& [node, weight] : multiplier.trace) {
      at_node[node].push_back(i);
      if (multiplier.node < 0 || node == multiplier.node) anchors.push_back(node);
    }
  }
  for (const SlidingPair::Point& point : pair.points()) {
    std::vector<std::size_t>& near = neighbours_.emplace_back();
    for (const auto& [node, weight] : point.multiplier.trace)
      near.insert(near.end(), at_node[node].begin(), at_node[node].end());
    std::ranges::sort(near);
    near.erase(std::unique(near.begin(), near.end()), near.end());
  }
}

/// Whether the point is active and has no conflict with selected ones.
bool SelfContactSelection::is_free(std::size_t point) const {
  const SlidingView* const view = views_[point];
  if (view == nullptr || !view->faces) return false;
  bool result = std::ranges::none_of(anchors_[point], [&](Index node) { return is_faced_[std::size_t(node)] != 0; });
  visit_faced_nodes(*view, least_weight_, [&](Index node) { result = result && is_anchor_[std::size_t(node)] == 0; });
  return result;
}

void SelfContactSelection::select(std::size_t point) {
  choices_[point] = Choice::chosen;
  selected_.push_back(point);
  for (const Index node : anchors_[point]) is_anchor_[std::size_t(node)] = 1;
  visit_faced_nodes(*views_[point], least_weight_, [&](Index node) { is_faced_[std::size_t(node)] = 1; });
}

/// Extends the selection to neighbours of selected points, recursively.
void SelfContactSelection::grow() {
  for (; grown_ < selected_.size(); ++grown_) {
    for (const std::size_t next : neighbours_[selected_[grown_]]) {
      if (choices_[next] == Choice::none && is_free(next)) select(next);
    }
  }
}

void SelfContactSelection::choose(const std::vector<const SlidingView*>& views) {
  views_ = views;
  std::ranges::fill(is_faced_, char{0});
  std::ranges::fill(is_anchor_, char{0});
  selected_.clear();
  grown_ = 0;
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    const bool was_chosen = choices_[i] == Choice::chosen;
    choices_[i] = Choice::none;
    if (was_chosen && is_free(i)) select(i);
  }
  grow();
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    if (choices_[i] != Choice::none || !is_free(i)) continue;
    select(i);
    grow();
  }
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    if (choices_[i] == Choice::none && views_[i] != nullptr && views_[i]->faces) choices_[i] = Choice::left_out;
  }
}

}  // namespace ricochet
