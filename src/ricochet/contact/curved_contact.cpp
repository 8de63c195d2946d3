#include "ricochet/contact/curved_contact.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ricochet/contact/contact_directions.hpp"

namespace ricochet {

namespace {

/// Points with gaps up to this multiple of the last change of the gaps are updated, because
/// they may soon come into contact.
constexpr double ahead = 4.0;

/// Obstacles at their positions at an instant.
class PosedObstacles {
 public:
  PosedObstacles(const std::vector<const Obstacle*>& obstacles, double time, const Vector& displacement) {
    for (std::size_t k = 0; k < std::min(obstacles.size(), few_.size()); ++k)
      few_[k].emplace(obstacles[k]->at(time, displacement));
    for (std::size_t k = few_.size(); k < obstacles.size(); ++k)
      others_.push_back(obstacles[k]->at(time, displacement));
  }
  [[nodiscard]] const PosedObstacle& operator[](std::size_t k) const {
    return k < few_.size() ? *few_[k] : others_[k - few_.size()];
  }

 private:
  std::array<std::optional<PosedObstacle>, 8> few_;  ///< stored without allocation
  std::vector<PosedObstacle> others_;
};

class CurvedContact final : public ContactGeometry {
 public:
  explicit CurvedContact(CurvedContactData data) : data_(std::move(data)) {}

  void gaps(const Vector& displacement, double time, Vector& gap) const override {
    const PosedObstacles posed(data_.obstacles, time, displacement);
    for (const CurvedContactData::Point& point : data_.points)
      gap[point.number] = posed[point.obstacle].gap(position(point, displacement));
  }

  void node_gaps(const Vector& displacement, double time, Vector& gap) const override {
    const PosedObstacles posed(data_.obstacles, time, displacement);
    for (const CurvedContactData::Node& node : data_.nodes)
      gap[node.entry] = posed[node.obstacle].gap(node_position(node.node, displacement));
  }

  [[nodiscard]] SpaceVector node_normal(Index entry, const Vector& displacement, double time) const override {
    const CurvedContactData::Node* const curved = find_node(entry);
    if (curved == nullptr) return data_.node_normals.col(entry);
    return data_.obstacles[curved->obstacle]->at(time, displacement).normal(node_position(curved->node, displacement));
  }

  [[nodiscard]] bool has_node(Index entry) const override { return find_node(entry) != nullptr; }

  void update(const Vector& displacement, double time, const StepStart* start, ContactRows& rows) const override {
    ++revision_;
    gap_ = rows.gap;
    const PosedObstacles posed(data_.obstacles, time, displacement);
    const PosedObstacles at_start(data_.obstacles, start != nullptr ? start->time : time,
                                  start != nullptr ? start->displacement : displacement);
    double change = 0.0;
    for (const CurvedContactData::Point& point : data_.points) {
      rows.gap[point.number] = posed[point.obstacle].gap(position(point, displacement));
      change = std::max(change, std::abs(rows.gap[point.number] - gap_[point.number]));
    }
    const double reach = ahead * change;
    for (const CurvedContactData::Point& point : data_.points) {
      if (rows.gap[point.number] > std::max(reach, rows.gap_rounding[point.number])) continue;
      const SpaceVector at = position(point, displacement);
      const SpaceVector from = start != nullptr ? position(point, start->displacement) : at;
      const SpaceVector normal = start == nullptr
                                     ? posed[point.obstacle].normal(at)
                                     : normal_of_step(at_start[point.obstacle], from, posed[point.obstacle], at);
      write_rows(point, normal, rows);
      const FreeMotion* const body = data_.obstacles[point.obstacle]->free_motion();
      if (body == nullptr) continue;
      const SpaceVector centre =
          start == nullptr ? body->centre(displacement)
                           : SpaceVector(0.5 * (body->centre(start->displacement) + body->centre(displacement)));
      write_body(point, *body, 0.5 * (from + at) - centre,
                 start == nullptr ? body->axes(displacement) : body->axes_at_start(), rows);
    }
  }

  void prepare_update(const Vector& displacement, double time, const StepStart* start,
                      ContactRows& rows) const override {
    update(displacement, time, start, rows);
  }

  /// The torque on a rigid body is that of the force at the position of the point.
  void add_couples(const Vector& displacement, const ContactRows& rows, const Vector& normal, const Vector& tangential,
                   Vector& force) const override {
    const Index d = dimension();
    for (const CurvedContactData::Point& point : data_.points) {
      const FreeMotion* const body = data_.obstacles[point.obstacle]->free_motion();
      if (body == nullptr) continue;
      const SpaceVector on_point = rows.force(point.number, normal, tangential);
      if (on_point.isZero(0.0)) continue;
      std::array<double, 6> correction{};
      body->write_row(-on_point, position(point, displacement) - body->centre(displacement), body->axes_at_start(),
                      correction.data());
      const auto add = [&](const SparseRowMatrix& matrix, Index row, double reaction) {
        const double* const has = matrix.valuePtr() + matrix.outerIndexPtr()[row + 1] - d;
        for (Index k = 0; k < d; ++k) correction[std::size_t(d + k)] -= reaction * has[k];
      };
      add(rows.gap_operator, point.number, normal[point.number]);
      for (Index row = point.number * (d - 1); tangential.size() > 0 && row < (point.number + 1) * (d - 1); ++row)
        add(rows.tangential_trace, row, -tangential[row]);
      for (Index k = 0; k < d; ++k) force[body->rotation_node() * d + k] += correction[std::size_t(d + k)];
    }
  }

  /// Number of row entries of free rigid bodies.
  [[nodiscard]] Index row_value_count() const override {
    Index count = 0;
    for (const CurvedContactData::Point& point : data_.points)
      count += data_.obstacles[point.obstacle]->free_motion() != nullptr ? 2 * dimension() * dimension() : 0;
    return count;
  }
  [[nodiscard]] Vector row_values(const ContactRows& rows) const override {
    Vector result(row_value_count());
    Index at = 0;
    visit_body_entries(rows, [&](const double* values) {
      for (Index k = 0; k < 2 * dimension(); ++k) result[at++] = values[k];
    });
    return result;
  }

  void restore(const Points& normals, const Vector& gap, const Vector& row_values, ContactRows& rows) const override {
    ++revision_;
    rows.gap = gap;
    for (const CurvedContactData::Point& point : data_.points) {
      write_rows(point, normals.col(point.number), rows);
      if (data_.obstacles[point.obstacle]->free_motion() != nullptr)
        rows.revision[std::size_t(point.number)] = revision_;
    }
    Index at = 0;
    visit_body_entries(rows, [&](double* values) {
      for (Index k = 0; k < 2 * dimension(); ++k) values[k] = row_values[at++];
    });
  }

  [[nodiscard]] const CurvedContactData* curved() const override { return &data_; }

 private:
  [[nodiscard]] Index dimension() const { return data_.node_positions.rows(); }
  /// Calls visit(the last 2d entries of a row) for the row of G and those of B_T of each point at a free rigid body.
  template <class Rows, class Visit>
  void visit_body_entries(Rows& rows, const Visit& visit) const {
    const Index d = dimension();
    for (const CurvedContactData::Point& point : data_.points) {
      if (data_.obstacles[point.obstacle]->free_motion() == nullptr) continue;
      visit(rows.gap_operator.valuePtr() + rows.gap_operator.outerIndexPtr()[point.number + 1] - 2 * d);
      for (Index row = point.number * (d - 1); row < (point.number + 1) * (d - 1); ++row)
        visit(rows.tangential_trace.valuePtr() + rows.tangential_trace.outerIndexPtr()[row + 1] - 2 * d);
    }
  }
  /// Returns null for a node that is not at a curved obstacle.
  [[nodiscard]] const CurvedContactData::Node* find_node(Index entry) const {
    const auto found = std::ranges::lower_bound(data_.nodes, entry, {}, &CurvedContactData::Node::entry);
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

  /// Writes the tangents, and the values of the rows of G and B_T, whose pattern is that of the trace.
  void write_rows(const CurvedContactData::Point& point, const SpaceVector& normal, ContactRows& rows) const {
    if (rows.normals.col(point.number) == normal) return;
    rows.revision[std::size_t(point.number)] = revision_;
    write_directions(point.number, normal, point.is_free, data_.trace, rows);
    double* gap = rows.gap_operator.valuePtr() + rows.gap_operator.outerIndexPtr()[point.number];
    for (SparseRowMatrix::InnerIterator entry(data_.trace, point.number); entry; ++entry) {
      for (Index k = 0; k < normal.size(); ++k) *gap++ = entry.value() * normal[k];
    }
  }

  /// Writes the entries for a free rigid body: minus the motion of its material point. Its nodes are the last of a row.
  void write_body(const CurvedContactData::Point& point, const FreeMotion& body, const SpaceVector& arm,
                  const Pose::Rotation& axes, ContactRows& rows) const {
    rows.revision[std::size_t(point.number)] = revision_;
    const Index d = arm.size(), entries = 2 * d;
    const auto write = [&](const SpaceVector& direction, SparseRowMatrix& matrix, Index row) {
      double* const values = matrix.valuePtr() + matrix.outerIndexPtr()[row + 1] - entries;
      body.write_row(-direction, arm, axes, values);
    };
    write(rows.normal(point.number), rows.gap_operator, point.number);
    for (Index j = 0; j < d - 1; ++j) {
      const Index row = point.number * (d - 1) + j;
      const bool slips = rows.slips[std::size_t(row)] != 0;
      write(slips ? SpaceVector(rows.tangents[std::size_t(point.number)].col(j)) : SpaceVector(SpaceVector::Zero(d)),
            rows.tangential_trace, row);
    }
  }

  CurvedContactData data_;
  mutable Vector gap_;         ///< at the previous update
  mutable long revision_ = 0;  ///< number of the last update; different rows never share it
};

}  // namespace

std::unique_ptr<ContactGeometry> make_curved_contact(CurvedContactData data) {
  return std::make_unique<CurvedContact>(std::move(data));
}

}  // namespace ricochet
