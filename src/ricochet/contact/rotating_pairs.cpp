#include "ricochet/contact/rotating_pairs.hpp"

#include <algorithm>

#include "ricochet/contact/contact_directions.hpp"

namespace ricochet {

namespace {

using Vector3 = Eigen::Vector3d;
using Point = RotatingPairsData::Point;
using Node = RotatingPairsData::Node;

/// Points with gaps up to this multiple of the last change of the gaps are updated, because
/// they may soon come into contact.
constexpr double ahead_of_pairs = 4.0;

class RotatingPairs final : public ContactGeometry {
 public:
  explicit RotatingPairs(RotatingPairsData data) : data_(std::move(data)) {}

  void gaps(const Vector& displacement, double, Vector& gap) const override {
    for (const Point& point : data_.points)
      gap[point.number] = normal(point, displacement).dot(across(point, displacement)) + point.offset;
  }

  void node_gaps(const Vector& displacement, double, Vector& gap) const override {
    for (const Node& node : data_.nodes) {
      Vector3 apart = position(node.node, displacement);
      for (SparseRowMatrix::InnerIterator entry(data_.opposite_projection, node.entry); entry; ++entry)
        apart -= entry.value() * position(entry.col(), displacement);
      gap[node.entry] = normal(node, displacement).dot(apart) + node.offset;
    }
  }

  [[nodiscard]] SpaceVector node_normal(Index entry, const Vector& displacement, double) const override {
    const Node* const node = find_node(entry);
    return node != nullptr ? SpaceVector(normal(*node, displacement).head(dimension()))
                           : SpaceVector(data_.node_normals.col(entry));
  }

  [[nodiscard]] bool has_node(Index entry) const override { return find_node(entry) != nullptr; }

  void update(const Vector& displacement, double /*time*/, const StepStart* start, ContactRows& rows) const override {
    ++revision_;
    gap_ = rows.gap;
    gaps(displacement, 0.0, rows.gap);
    double reach = 0.0;
    for (const Point& point : data_.points)
      reach = std::max(reach, ahead_of_pairs * std::abs(rows.gap[point.number] - gap_[point.number]));
    const Vector& before = start != nullptr ? start->displacement : displacement;
    middle_ = 0.5 * (before + displacement);
    for (const Point& point : data_.points) {
      if (rows.gap[point.number] > std::max(reach, rows.gap_rounding[point.number])) continue;
      const Vector& row = row_of_step(point, before, displacement);
      write_rows(point, normal_.head(dimension()), row, rows);
    }
  }

  void prepare_update(const Vector& displacement, double time, const StepStart* start,
                      ContactRows& rows) const override {
    update(displacement, time, start, rows);
  }

  void add_couples(const Vector& displacement, const ContactRows& rows, const Vector& normal, const Vector& tangential,
                   Vector& force) const override {
    const Index d = dimension();
    const auto add = [&](Index node, const Vector3& value) { force.segment(node * d, d) += value.head(d); };
    for (const Point& point : data_.points) {
      const double reaction = normal[point.number];
      if (reaction == 0.0 && (tangential.size() == 0 || tangential.segment(point.number * (d - 1), d - 1).isZero(0.0)))
        continue;
      if (!point.normal.rotates()) continue;
      const Vector3 area_normal = point.normal.at(data_.node_positions, displacement);
      Vector3 along = reaction * area_normal.normalized();
      along.head(d) += rows.force(point.number, normal, tangential) - reaction * rows.normal(point.number);
      for (SparseRowMatrix::InnerIterator entry(data_.trace, point.number); entry; ++entry)
        add(entry.col(), entry.value() * along);
      const Vector3 moment = across(point, displacement).cross(along);
      point.normal.visit_derivative(data_.node_positions, displacement,
                                    area_normal.cross(moment) / area_normal.squaredNorm(), add);
      rows.visit_normal(point.number, [&](Index dof, double value) { force[dof] -= value * reaction; });
      if (tangential.size() == 0) continue;
      for (Index row = point.number * (d - 1); row < (point.number + 1) * (d - 1); ++row)
        rows.visit_tangential(row, [&](Index dof, double value) { force[dof] += value * tangential[row]; });
    }
  }

  [[nodiscard]] Vector row_values(const ContactRows& rows) const override {
    Vector result(row_value_count());
    Index first = 0;
    for (const Point& point : data_.points) {
      const auto count = Index(point.nodes.size()) * dimension();
      result.segment(first, count) = Eigen::Map<const Vector>(row_begin(point, rows), count);
      first += count;
    }
    return result;
  }
  [[nodiscard]] Index row_value_count() const override {
    Index count = 0;
    for (const Point& point : data_.points) count += Index(point.nodes.size()) * dimension();
    return count;
  }

  void restore(const Points& normals, const Vector& gap, const Vector& row_values, ContactRows& rows) const override {
    ++revision_;
    rows.gap = gap;
    Index first = 0;
    for (const Point& point : data_.points) {
      const auto count = Index(point.nodes.size()) * dimension();
      row_ = row_values.segment(first, count);
      write_rows(point, normals.col(point.number), row_, rows);
      first += count;
    }
  }

 private:
  /// Returns null for a node that faces no other body.
  [[nodiscard]] const Node* find_node(Index entry) const {
    const auto found = std::ranges::lower_bound(data_.nodes, entry, {}, &Node::entry);
    return found != data_.nodes.end() && found->entry == entry ? &*found : nullptr;
  }
  [[nodiscard]] Index dimension() const { return data_.node_positions.rows(); }
  [[nodiscard]] Vector3 position(Index node, const Vector& displacement) const {
    const Index d = dimension();
    Vector3 result = Vector3::Zero();
    for (Index k = 0; k < d; ++k) result[k] = data_.node_positions(k, node) + displacement[node * d + k];
    return result;
  }
  /// Returns y.
  [[nodiscard]] Vector3 across(const Point& point, const Vector& displacement) const {
    Vector3 result = Vector3::Zero();
    for (SparseRowMatrix::InnerIterator entry(data_.trace, point.number); entry; ++entry)
      result += entry.value() * position(entry.col(), displacement);
    return result;
  }
  template <class Item>
  [[nodiscard]] Vector3 normal(const Item& item, const Vector& displacement) const {
    return item.normal.at(data_.node_positions, displacement).normalized();
  }
  [[nodiscard]] static double* row_begin(const Point& point, ContactRows& rows) {
    return rows.gap_operator.valuePtr() + rows.gap_operator.outerIndexPtr()[point.number];
  }
  [[nodiscard]] static const double* row_begin(const Point& point, const ContactRows& rows) {
    return rows.gap_operator.valuePtr() + rows.gap_operator.outerIndexPtr()[point.number];
  }

  /// Computes G of the step, and its direction in normal_; middle_ must be the middle of the step.
  const Vector& row_of_step(const Point& point, const Vector& before, const Vector& after) const {
    const Index d = dimension();
    row_.setZero(Index(point.nodes.size()) * d);
    const auto add = [&](Index node, const Vector3& value) {
      const auto at = std::ranges::lower_bound(point.nodes, node) - point.nodes.begin();
      row_.segment(at * d, d) += value.head(d);
    };
    const Vector3 start = point.normal.at(data_.node_positions, before),
                  end = point.normal.at(data_.node_positions, after);
    const double start_length = start.norm(), end_length = end.norm();
    const double length = 0.5 * (start_length + end_length);
    const Vector3 mean = 0.5 * (start / start_length + end / end_length);
    for (SparseRowMatrix::InnerIterator entry(data_.trace, point.number); entry; ++entry)
      add(entry.col(), entry.value() * mean);
    if (point.normal.rotates()) {
      const Vector3 apart = 0.5 * (across(point, before) + across(point, after));
      const Vector3 w = (apart - (0.5 / length) * mean.dot(apart) * (start + end)) / length;
      point.normal.visit_derivative(data_.node_positions, middle_, w, add);
    }
    normal_ = mean.normalized();
    return row_;
  }

  /// Writes the tangents, and the values of the rows of G and B_T.
  void write_rows(const Point& point, const SpaceVector& normal, const Vector& row, ContactRows& rows) const {
    Eigen::Map<Vector> gap_row(row_begin(point, rows), row.size());
    if (gap_row == row) return;
    gap_row = row;
    rows.revision[std::size_t(point.number)] = revision_;
    write_directions(point.number, normal, point.is_free, data_.trace, rows);
  }

  RotatingPairsData data_;
  mutable Vector gap_;           ///< at the previous update
  mutable Vector middle_, row_;  ///< of the current step
  mutable Vector3 normal_ = Vector3::Zero();
  mutable long revision_ = 0;  ///< number of the last update; different rows never share it
};

}  // namespace

std::unique_ptr<ContactGeometry> make_rotating_pairs(RotatingPairsData data) {
  return std::make_unique<RotatingPairs>(std::move(data));
}

}  // namespace ricochet
