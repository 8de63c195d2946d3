#include "ricochet/contact/curved_contact.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ricochet/contact/contact_directions.hpp"

namespace ricochet {

namespace {

/// Gaps up to so many times what they have changed by: points that may touch soon.
constexpr double ahead = 4.0;

/// The obstacles where they are at an instant.
class Placing {
 public:
  Placing(const std::vector<const Obstacle*>& obstacles, double time) {
    for (std::size_t k = 0; k < std::min(obstacles.size(), few_.size()); ++k) few_[k].emplace(obstacles[k]->at(time));
    for (std::size_t k = few_.size(); k < obstacles.size(); ++k) others_.push_back(obstacles[k]->at(time));
  }
  [[nodiscard]] const PlacedObstacle& operator[](std::size_t k) const {
    return k < few_.size() ? *few_[k] : others_[k - few_.size()];
  }

 private:
  std::array<std::optional<PlacedObstacle>, 8> few_;  ///< without allocation
  std::vector<PlacedObstacle> others_;
};

class CurvedContact final : public ContactGeometry {
 public:
  explicit CurvedContact(CurvedContactData data) : data_(std::move(data)) {}

  void gaps(const Vector& displacement, double time, Vector& gap) const override {
    const Placing placing(data_.obstacles, time);
    for (const CurvedContactData::Point& point : data_.points)
      gap[point.number] = placing[point.obstacle].gap(position(point, displacement));
  }

  void node_gaps(const Vector& displacement, double time, Vector& gap) const override {
    const Placing placing(data_.obstacles, time);
    for (const CurvedContactData::Node& node : data_.nodes)
      gap[node.entry] = placing[node.obstacle].gap(node_position(node.node, displacement));
  }

  [[nodiscard]] SpaceVector node_normal(Index entry, const Vector& displacement, double time) const override {
    const CurvedContactData::Node* const curved = find_node(entry);
    if (curved == nullptr) return data_.node_normals.col(entry);
    return data_.obstacles[curved->obstacle]->at(time).normal(node_position(curved->node, displacement));
  }

  [[nodiscard]] bool has_node(Index entry) const override { return find_node(entry) != nullptr; }

  void update(const Vector& displacement, double time, const StepStart* start, ContactRows& rows) const override {
    ++revision_;
    gap_ = rows.gap;
    const Placing placing(data_.obstacles, time), at_start(data_.obstacles, start != nullptr ? start->time : time);
    double change = 0.0;
    for (const CurvedContactData::Point& point : data_.points) {
      rows.gap[point.number] = placing[point.obstacle].gap(position(point, displacement));
      change = std::max(change, std::abs(rows.gap[point.number] - gap_[point.number]));
    }
    const double reach = ahead * change;
    for (const CurvedContactData::Point& point : data_.points) {
      if (rows.gap[point.number] > std::max(reach, rows.gap_rounding[point.number])) continue;
      const SpaceVector at = position(point, displacement);
      write_rows(point,
                 start == nullptr ? placing[point.obstacle].normal(at)
                                  : normal_of_step(at_start[point.obstacle], position(point, start->displacement),
                                                   placing[point.obstacle], at),
                 rows);
    }
  }

  void restore(const Points& normals, const Vector& gap, const Vector&, ContactRows& rows) const override {
    ++revision_;
    rows.gap = gap;
    for (const CurvedContactData::Point& point : data_.points) write_rows(point, normals.col(point.number), rows);
  }

 private:
  /// Null: none at a curved obstacle.
  [[nodiscard]] const CurvedContactData::Node* find_node(Index entry) const {
    const auto found = std::lower_bound(data_.nodes.begin(), data_.nodes.end(), entry,
                                        [](const CurvedContactData::Node& node, Index e) { return node.entry < e; });
    return found != data_.nodes.end() && found->entry == entry ? &*found : nullptr;
  }
  [[nodiscard]] SpaceVector node_position(Index node, const Vector& displacement) const {
    const Index d = data_.node_positions.rows();
    return data_.node_positions.col(node) + displacement.segment(node * d, d);
  }
  [[nodiscard]] SpaceVector position(const CurvedContactData::Point& point, const Vector& displacement) const {
    SpaceVector result = SpaceVector::Zero(data_.node_positions.rows());
    for (SparseRowMatrix::InnerIterator entry(data_.trace, point.number); entry; ++entry)
      result += entry.value() * node_position(entry.col(), displacement);
    return result;
  }

  /// Tangents, and the values of the rows of G and B_T, whose pattern is that of the trace.
  void write_rows(const CurvedContactData::Point& point, const SpaceVector& normal, ContactRows& rows) const {
    if (rows.normals.col(point.number) == normal) return;
    rows.revision[static_cast<std::size_t>(point.number)] = revision_;
    write_directions(point.number, normal, point.is_free, data_.trace, rows);
    double* gap = rows.gap_operator.valuePtr() + rows.gap_operator.outerIndexPtr()[point.number];
    for (SparseRowMatrix::InnerIterator entry(data_.trace, point.number); entry; ++entry) {
      for (Index k = 0; k < normal.size(); ++k) *gap++ = entry.value() * normal[k];
    }
  }

  CurvedContactData data_;
  mutable Vector gap_;         ///< at the look before
  mutable long revision_ = 0;  ///< of the last update: no two rows that differ have the same
};

}  // namespace

std::unique_ptr<ContactGeometry> make_curved_contact(CurvedContactData data) {
  return std::make_unique<CurvedContact>(std::move(data));
}

}  // namespace ricochet
