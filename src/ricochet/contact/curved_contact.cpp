#include "ricochet/contact/curved_contact.hpp"

#include <algorithm>
#include <cmath>

#include "ricochet/contact/contact_directions.hpp"

namespace ricochet {

namespace {

/// Gaps up to so many times what they have changed by: points that may touch soon.
constexpr double ahead = 4.0;

class CurvedContact final : public ContactGeometry {
 public:
  explicit CurvedContact(CurvedContactData data) : data_(std::move(data)) {}

  void gaps(const Vector& displacement, double time, Vector& gap) const override {
    for (const CurvedContactData::Point& point : data_.points)
      gap[point.number] = point.obstacle->gap(position(point, displacement, time));
  }

  void node_gaps(const Vector& displacement, double time, Vector& gap) const override {
    for (const CurvedContactData::Node& node : data_.nodes)
      gap[node.entry] = node.obstacle->gap(position(node, displacement, time));
  }

  [[nodiscard]] SpaceVector node_normal(Index entry, const Vector& displacement, double time) const override {
    const CurvedContactData::Node* const curved = find_node(entry);
    return curved != nullptr ? curved->obstacle->normal(position(*curved, displacement, time))
                             : SpaceVector(data_.node_normals.col(entry));
  }

  [[nodiscard]] bool has_node(Index entry) const override { return find_node(entry) != nullptr; }

  void update(const Vector& displacement, double time, const StepStart* start, ContactRows& rows) const override {
    ++revision_;
    gap_ = rows.gap;
    gaps(displacement, time, rows.gap);
    double change = 0.0;
    for (const CurvedContactData::Point& point : data_.points)
      change = std::max(change, std::abs(rows.gap[point.number] - gap_[point.number]));
    const double reach = ahead * change;
    for (const CurvedContactData::Point& point : data_.points) {
      if (rows.gap[point.number] > std::max(reach, rows.gap_rounding[point.number])) continue;
      const SpaceVector at = position(point, displacement, time);
      write_rows(point,
                 start == nullptr
                     ? point.obstacle->normal(at)
                     : point.obstacle->normal_of_step(position(point, start->displacement, start->time), at),
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
  /// Seen from the obstacle where it was at t = 0.
  [[nodiscard]] static SpaceVector seen_from(const Obstacle& obstacle, SpaceVector position, double time) {
    if (obstacle.moves()) position -= obstacle.translation(time);
    return position;
  }
  [[nodiscard]] SpaceVector position(const CurvedContactData::Node& node, const Vector& displacement,
                                     double time) const {
    return seen_from(*node.obstacle, node_position(node.node, displacement), time);
  }
  [[nodiscard]] SpaceVector position(const CurvedContactData::Point& point, const Vector& displacement,
                                     double time) const {
    SpaceVector result = SpaceVector::Zero(data_.node_positions.rows());
    for (SparseRowMatrix::InnerIterator entry(data_.trace, point.number); entry; ++entry)
      result += entry.value() * node_position(entry.col(), displacement);
    return seen_from(*point.obstacle, result, time);
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
