#include "ricochet/contact/sliding/sliding_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/contact/sliding/broad_phase.hpp"
#include "ricochet/contact/sliding/pair_views.hpp"
#include "ricochet/contact/sliding/sliding_couples.hpp"
#include "ricochet/contact/sliding/sliding_rows.hpp"
#include "ricochet/contact/sliding/surface_displacements.hpp"
#include "ricochet/fem/displacement_space.hpp"

namespace ricochet {

namespace {

using SlidingNode = SlidingContactData::Node;
using Choice = SelfContactSelection::Choice;

/// Overlap, relative to the size of the model, above which it is not rounding error.
constexpr double least_overlap = 1e-12;

class SlidingContact final : public ContactGeometry {
 public:
  explicit SlidingContact(SlidingContactData data)
      : data_(std::move(data)),
        extent_(extent(data_.node_positions)),
        at_rest_(Vector::Zero(data_.node_positions.size())),
        pair_views_(data_.pairs.size()),
        apart_(data_.pairs, data_.node_positions),
        displacements_(data_.pairs, data_.node_positions.rows()),
        writer_(data_.node_positions),
        couples_(data_.node_positions) {
    for (std::size_t k = 0; k < data_.pairs.size(); ++k) {
      const SlidingPair& pair = *data_.pairs[k];
      if (pair.is_self()) pair_views_[k].chosen.emplace(pair, data_.node_positions.cols(), pair.degree());
    }
  }

  void gaps(const Vector& displacement, double, Vector& gap) const override {
    const Vector* const start = is_step_ ? &start_at_update_ : nullptr;
    apart_.move(displacement, start);
    for (std::size_t k = 0; k < data_.pairs.size(); ++k) {
      if (pair_views_[k].is_apart && (is_frozen_ || apart_.are_apart(k))) {
        for (const SlidingPair::Point& point : data_.pairs[k]->points()) gap[point.number] = data_.unpaired_gap;
        continue;
      }
      if (is_frozen_) {
        compute_frozen_gaps(k, displacement, gap);
        continue;
      }
      if (pair_views_[k].is_apart && start != nullptr) update_start_views(k, *start);
      // Forces may move points farther in the step than predicted when the rows were computed.
      if (is_step_ && pair_views_[k].has_start)
        find_out_of_reach(k, largest_motion(*data_.pairs[k], displacement, pair_views_[k].start_at));
      update_gap_views(k, displacement);
      for (std::size_t i = 0; i < data_.pairs[k]->points().size(); ++i) gap[number(k, i)] = gap_of(pair_views_[k], i);
    }
  }

  void node_gaps(const Vector& displacement, double, Vector& gap) const override {
    apart_.move(displacement, nullptr);
    for (const SlidingNode& node : data_.nodes) {
      gap[node.entry] = apart_.are_apart(node.pair)
                            ? std::numeric_limits<double>::quiet_NaN()
                            : data_.pairs[node.pair]->node_gap(node.node, normal_at(node, displacement), displacement);
    }
  }

  [[nodiscard]] SpaceVector node_normal(Index entry, const Vector& displacement, double) const override {
    const SlidingNode* const node = find_node(entry);
    if (node == nullptr) return data_.node_normals.col(entry);
    return normal_at(*node, displacement).head(dimension());
  }

  [[nodiscard]] bool has_node(Index entry) const override { return find_node(entry) != nullptr; }

  void update(const Vector& displacement, double, const StepStart* start, ContactRows& rows) const override {
    if (is_frozen_ && start != nullptr) return;
    restore_selection(rows.sliding_state);
    at_update_ = displacement;
    is_step_ = start != nullptr;
    if (is_step_) start_at_update_ = start->displacement;
    writer_.begin(displacement, is_step_ ? &start_at_update_ : nullptr);
    apart_.move(displacement, is_step_ ? &start_at_update_ : nullptr);
    Index flag = rows.sliding_state.size() - apart_.count();
    for (std::size_t k = 0; k < data_.pairs.size(); ++k) {
      const bool was_apart = apart_.may_be_apart(k) && flag >= 0 && rows.sliding_state[flag++] != 0.0;
      apart_.are_apart(k) ? set_apart(k, was_apart, rows) : update_pair(k, displacement, start, rows);
    }
    writer_.finish(rows);
    remember(displacement, start, rows);
    gap_at_update_ = rows.gap;
  }

  void begin_step() const override {
    is_frozen_ = was_frozen_ = false;
    is_step_ = false;
  }
  bool freeze() const override {
    if (is_frozen_ || !is_step_) return false;
    is_frozen_ = was_frozen_ = has_frozen_ = true;
    return true;
  }
  void end_step() const override {
    is_frozen_ = false;
    if (is_step_ && !has_warned_) warn_of_long_step();
  }
  [[nodiscard]] bool is_frozen() const override { return is_frozen_; }
  [[nodiscard]] bool has_frozen() const override { return has_frozen_; }

  void allow_overlap(Vector& gap) const override {
    if (is_frozen_) return;  // frozen gaps include it
    for (std::size_t k = 0; k < data_.pairs.size(); ++k) {
      const PairViews& views = pair_views_[k];
      if (views.is_apart) continue;
      for (std::size_t i = 0; i < views.at_start.size(); ++i) {
        const double before = views.at_start[i].faces ? views.at_start[i].gap : 0.0;
        if (before < -least_overlap * extent_ && !views.is_out_of_reach(i)) gap[number(k, i)] -= before;
      }
    }
  }

  void deactivate_points(std::vector<char>& eligible) const override {
    for (std::size_t k = 0; k < data_.pairs.size(); ++k) {
      if (!pair_views_[k].chosen) continue;
      const std::vector<Choice>& choices = pair_views_[k].chosen->choices();
      for (std::size_t i = 0; i < choices.size(); ++i) {
        if (choices[i] == Choice::left_out) eligible[std::size_t(number(k, i))] = 0;
      }
    }
  }

  void add_couples(const Vector& displacement, const ContactRows& rows, const Vector& normal, const Vector& tangential,
                   Vector& force) const override {
    if (was_frozen_) return;  // forces are those of the rows
    for (std::size_t k = 0; k < data_.pairs.size(); ++k)
      add_couples_of(k, displacement, rows, normal, tangential, force);
  }

  [[nodiscard]] long projection_count() const override {
    long count = 0;
    for (const auto& pair : data_.pairs) count += pair->projection_count();
    return count;
  }

  /// Displacements from which rows were computed, at the end of a step and then at its start, followed by the selected
  /// points and the pairs that were skipped.
  [[nodiscard]] Index row_value_count() const override {
    Index points = 0;
    for (const PairViews& views : pair_views_) points += views.chosen ? Index(views.chosen->choices().size()) : 0;
    return displacements_.count() + points + apart_.count();
  }
  [[nodiscard]] Vector row_values(const ContactRows& rows) const override {
    return rows.sliding_state.size() > 0 ? rows.sliding_state : Vector(Vector::Zero(row_value_count()));
  }
  void restore(const Points&, const Vector&, const Vector& row_values, ContactRows& rows) const override {
    Vector end = Vector::Zero(data_.node_positions.size()), before = end;
    const bool is_step = displacements_.read(row_values, end, before);
    rows.sliding_state = row_values;
    rows.sliding_state.tail(apart_.count()).setZero();  // forces their rows to be written
    const StepStart start{before, 0.0};
    update(end, 0.0, is_step ? &start : nullptr, rows);
  }

 private:
  [[nodiscard]] Index dimension() const { return data_.node_positions.rows(); }
  [[nodiscard]] Index number(std::size_t pair, std::size_t point) const {
    return data_.pairs[pair]->points()[point].number;
  }
  [[nodiscard]] double gap_of(const PairViews& views, std::size_t point) const {
    const SlidingView& view = views.is_out_of_reach(point) ? views.at_start[point] : views.gaps[point];
    return view.faces ? view.gap : data_.unpaired_gap;
  }
  [[nodiscard]] const SlidingNode* find_node(Index entry) const {
    const auto found = std::ranges::lower_bound(data_.nodes, entry, {}, &SlidingNode::entry);
    return found != data_.nodes.end() && found->entry == entry ? &*found : nullptr;
  }
  [[nodiscard]] SlidingVector normal_at(const SlidingNode& node, const Vector& displacement) const {
    return node.normal.at(data_.node_positions, displacement).normalized();
  }

  /// Continues the selection from that of the rows, even if other rows were computed in between.
  void restore_selection(const Vector& values) const {
    Index at = displacements_.count();
    for (PairViews& views : pair_views_) {
      if (!views.chosen || values.size() == 0) continue;
      std::vector<Choice> choices(views.chosen->choices().size());
      for (Choice& choice : choices) choice = static_cast<Choice>(std::lround(std::clamp(values[at++], 0.0, 2.0)));
      views.chosen->restore(std::move(choices));
    }
  }

  void remember(const Vector& displacement, const StepStart* start, ContactRows& rows) const {
    rows.sliding_state.setZero(row_value_count());
    displacements_.write(displacement, start != nullptr ? &start->displacement : nullptr, rows.sliding_state);
    Index at = displacements_.count();
    for (const PairViews& views : pair_views_) {
      if (!views.chosen) continue;
      for (const Choice choice : views.chosen->choices()) rows.sliding_state[at++] = double(choice);
    }
    for (std::size_t k = 0; k < pair_views_.size(); ++k) {
      if (apart_.may_be_apart(k)) rows.sliding_state[at++] = pair_views_[k].is_apart ? 1.0 : 0.0;
    }
  }

  /// Computes gaps linearized about the last update.
  void compute_frozen_gaps(std::size_t k, const Vector& displacement, Vector& gap) const {
    const PairViews& views = pair_views_[k];
    const Index d = dimension();
    for (std::size_t i = 0; i < views.gaps.size(); ++i) {
      const Index point = number(k, i);
      gap[point] = gap_at_update_[point];
      if (views.left_out[i] != 0) continue;
      double along_step = 0.0;
      for (const auto& [node, value] : (views.enters(i) ? views.entering[i] : views.middle[i]).row) {
        gap[point] += value.head(d).dot(displacement.segment(node * d, d) - at_update_.segment(node * d, d));
        along_step += value.head(d).dot(writer_.step().segment(node * d, d));
      }
      // As its row sees it, the point starts with this gap: removing an overlap would create energy.
      gap[point] -= std::min(gap_at_update_[point] - along_step, 0.0);
    }
  }

  void update_gap_views(std::size_t k, const Vector& displacement) const {
    PairViews& views = pair_views_[k];
    if (views.has_gaps && views.gaps_at == displacement) return;
    data_.pairs[k]->compute_views(displacement, SlidingPair::Content::gap, views.out_of_reach, views.any_depth,
                                  views.gaps);
    views.gaps_at = displacement;
    views.has_gaps = true;
  }

  /// Records which points face something at the start of the step: these admit any depth wherever the step ends.
  void update_start_views(std::size_t k, const Vector& displacement) const {
    PairViews& views = pair_views_[k];
    if (views.has_start && views.start_at == displacement) return;
    data_.pairs[k]->compute_views(displacement, SlidingPair::Content::gap, {}, {}, views.at_start);
    views.start_at = displacement;
    views.has_start = true;
    views.any_depth.resize(views.at_start.size());
    for (std::size_t i = 0; i < views.any_depth.size(); ++i) views.any_depth[i] = views.at_start[i].faces ? 1 : 0;
    views.has_gaps = views.has_couples = false;
  }

  /// Finds the points that cannot come into contact in a step with the given largest
  /// displacement. Infinite: none is far.
  void find_out_of_reach(std::size_t k, double way) const {
    const SlidingPair& pair = *data_.pairs[k];
    PairViews& views = pair_views_[k];
    std::vector<char>& out_of_reach = left_out_;
    out_of_reach.assign(pair.points().size(), 0);
    if (std::isfinite(way)) {
      const double reach = reach_of_sliding(way, pair.height());
      for (std::size_t i = 0; i < out_of_reach.size(); ++i)
        out_of_reach[i] = views.at_start[i].faces && views.at_start[i].distance > reach ? 1 : 0;
    }
    if (out_of_reach == views.out_of_reach) return;
    views.out_of_reach = out_of_reach;
    views.has_gaps = false;
  }

  void warn_of_long_step() const {
    for (const auto& pair : data_.pairs)
      has_warned_ = has_warned_ || warn_of_undetected_contact(*pair, at_update_, start_at_update_);
  }

  /// Rows of surfaces that are far apart are those of planes perpendicular to the initial normals, at any displacement.
  void set_apart(std::size_t k, bool was_apart, ContactRows& rows) const {
    pair_views_[k].is_apart = true;
    pair_views_[k].has_start = pair_views_[k].has_gaps = false;
    if (was_apart) return;
    const SlidingPair& pair = *data_.pairs[k];
    for (std::size_t i = 0; i < pair.points().size(); ++i) {
      rows.gap[number(k, i)] = data_.unpaired_gap;
      rows.gap_rounding[number(k, i)] = rounding(pair.points()[i], at_rest_);
      writer_.write_plane(pair.points()[i], pair.normal(i, at_rest_), rows);
    }
  }

  void update_pair(std::size_t k, const Vector& displacement, const StepStart* start, ContactRows& rows) const {
    const SlidingPair& pair = *data_.pairs[k];
    PairViews& views = pair_views_[k];
    views.is_apart = false;
    if (start != nullptr) {
      update_start_views(k, start->displacement);
      find_out_of_reach(k, largest_motion(pair, displacement, start->displacement));
    } else {
      views.any_depth.clear();
      views.has_start = views.has_gaps = views.has_couples = false;
      find_out_of_reach(k, std::numeric_limits<double>::infinity());
    }
    update_gap_views(k, displacement);
    views.left_out.assign(views.gaps.size(), 0);
    bool any_near = false;
    for (std::size_t i = 0; i < views.gaps.size(); ++i) {
      const Index point = number(k, i);
      rows.gap[point] = gap_of(views, i);
      rows.gap_rounding[point] = rounding(pair.points()[i], displacement);
      views.left_out[i] = views.is_out_of_reach(i) || !views.gaps[i].faces ? 1 : 0;
      any_near = any_near || views.left_out[i] == 0;
    }
    if (any_near)
      pair.compute_views(writer_.middle(), SlidingPair::Content::row, views.left_out, views.any_depth, views.middle);
    if (any_near && start != nullptr) evaluate_entering(pair, displacement, views);
    if (views.chosen) choose(start != nullptr, views);
    for (std::size_t i = 0; i < views.gaps.size(); ++i) {
      const double gap_rounding = rows.gap_rounding[number(k, i)];
      if (views.left_out[i] != 0) {
        writer_.write_plane(pair.points()[i], pair.normal(i, writer_.middle()), rows);
      } else if (start == nullptr) {
        writer_.write(pair.points()[i], views.middle[i], rows);
      } else if (views.enters(i)) {
        SlidingView& view = views.entering[i];
        writer_.correct(view, -std::numeric_limits<double>::infinity(), 0.0, gap_rounding);
        writer_.write(pair.points()[i], view, rows);
      } else {
        SlidingView& view = views.middle[i];
        const double change = views.gaps[i].gap - views.at_start[i].gap;
        // A point that comes over a rim has closed its gap there by sliding, mostly before it carried a force.
        const bool was_on_rim = views.at_start[i].gap > views.at_start[i].distance;
        writer_.correct(view, change, was_on_rim ? std::max(change, 0.0) : change, gap_rounding);
        writer_.write(pair.points()[i], view, rows);
      }
    }
  }

  /// Selects among the points that may come into contact in the step.
  void choose(bool is_step, PairViews& views) const {
    views_.assign(views.gaps.size(), nullptr);
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (views.left_out[i] == 0) views_[i] = is_step && views.enters(i) ? &views.entering[i] : &views.middle[i];
    }
    views.chosen->choose(views_);
  }

  /// Computes the views at the end, from which points that enter have their rows.
  void evaluate_entering(const SlidingPair& pair, const Vector& displacement, PairViews& views) const {
    bool any = false;
    left_out_.assign(views.gaps.size(), 1);
    for (std::size_t i = 0; i < views.gaps.size(); ++i) {
      if (views.enters(i)) left_out_[i] = 0;
      any = any || views.enters(i);
    }
    if (any) pair.compute_views(displacement, SlidingPair::Content::row, left_out_, views.any_depth, views.entering);
  }

  /// Rounding error of sums over segments of differences of positions.
  [[nodiscard]] double rounding(const SlidingPair::Point& point, const Vector& displacement) const {
    double size = extent_;
    for (const auto& [node, weight] : point.multiplier.trace)
      size = std::max(size, current_position(data_.node_positions, node, displacement).lpNorm<1>());
    return 64.0 * std::numeric_limits<double>::epsilon() * size;
  }

  void add_couples_of(std::size_t k, const Vector& displacement, const ContactRows& rows, const Vector& normal,
                      const Vector& tangential, Vector& force) const {
    const SlidingPair& pair = *data_.pairs[k];
    PairViews& views = pair_views_[k];
    if (views.is_apart || !couples_.find_forces(pair.points(), normal, tangential, left_out_)) return;
    // An iteration of a step begins at the displacement at which the previous one ended.
    if (!views.has_couples_at(displacement, left_out_)) {
      pair.compute_views(displacement, SlidingPair::Content::row, left_out_, views.any_depth, views.couples);
      views.couples_at = displacement;
      views.forceless = left_out_;
      views.has_couples = true;
    }
    for (std::size_t i = 0; i < left_out_.size(); ++i) {
      if (left_out_[i] == 0 && views.couples[i].faces)
        couples_.add(number(k, i), views.couples[i], displacement, rows, normal, tangential, force);
    }
  }

  SlidingContactData data_;
  double extent_;
  Vector at_rest_;                             ///< zero displacement
  mutable std::vector<PairViews> pair_views_;  ///< per pair
  mutable BroadPhase apart_;
  SurfaceDisplacements displacements_;
  mutable SlidingRows writer_;
  mutable Vector at_update_, start_at_update_, gap_at_update_;  ///< of the last update
  mutable bool is_frozen_ = false, was_frozen_ = false;         ///< the latter until the next step begins
  mutable bool has_frozen_ = false;                             ///< in the run so far
  mutable bool is_step_ = false;                                ///< whether the last update was of a step
  mutable bool has_warned_ = false;                             ///< whether the warning of too long steps was logged
  mutable std::vector<char> left_out_;
  mutable std::vector<const SlidingView*> views_;
  mutable SlidingCouples couples_;
};

}  // namespace

std::unique_ptr<ContactGeometry> make_sliding_contact(SlidingContactData data) {
  return std::make_unique<SlidingContact>(std::move(data));
}

}  // namespace ricochet
