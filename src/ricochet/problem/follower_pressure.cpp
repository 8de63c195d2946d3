#include "ricochet/problem/follower_pressure.hpp"

#include <array>
#include <utility>

#include "ricochet/fem/exterior_facets.hpp"

namespace ricochet {

FollowerPressure::FollowerPressure(const Body& body) : body_(body) {
  const bool axisymmetric = is_axisymmetric(body);
  for (const CellBlock& block : body.mesh->facets) {
    const int degree = product_quadrature_degree(block.shape, body.mesh->degree, body.space->degree, axisymmetric);
    rules_.emplace_back(block.shape, body.mesh->degree, body.space->degree, degree + 1, axisymmetric);
  }
}

/// Returns 1 if the normal defined by the facet's vertices points away from the vertices of its cell, else −1.
double FollowerPressure::outward_side(const Facet& facet, Index cell) const {
  const CellBlock& block = body_.mesh->facets[facet.block];
  const Index* const nodes = block.cell(facet.local);
  const auto at = [&](int k) { return body_.mesh->nodes.col(nodes[k]); };
  Vector normal, centre = Vector::Zero(body_.mesh->dimension);
  if (body_.mesh->dimension == 2) {
    const Eigen::Vector2d along = at(1) - at(0);
    normal = Eigen::Vector2d(along[1], -along[0]);
  } else {
    const Eigen::Vector3d first = at(1) - at(0), second = at(2) - at(0);
    normal = first.cross(second);
  }
  const int vertices = vertex_count(block.shape);
  for (int k = 0; k < vertices; ++k) centre += at(k) / vertices;
  return normal.dot(centre - location_of_cell(*body_.mesh, cell).centre) > 0.0 ? 1.0 : -1.0;
}

void FollowerPressure::add(const std::vector<Index>& facets, Expression pressure) {
  Surface surface{{}, std::move(pressure)};
  const std::vector<std::vector<Index>> cells = cells_of_facets(*body_.mesh, facets);
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const IndexInBlocks location = locate_in_blocks(body_.mesh->facets, facets[i]);
    Facet facet{location.block, location.local, 1.0};
    facet.side = outward_side(facet, cells[i].front());
    surface.facets.push_back(facet);
  }
  surfaces_.push_back(std::move(surface));
}

/// Facet at one point of its quadrature rule.
struct FollowerPressure::Point {
  const Surface& surface;
  const Index* nodes;    ///< in the displacement space
  const Matrix& shape;   ///< gradients of φ, nodes × (d−1)
  const Matrix& values;  ///< φ, nodes × points
  Index q;
  double weight;                          ///< of the reference facet; its sign makes the normal point outward
  Eigen::Vector3d undeformed;             ///< position
  std::array<Eigen::Vector3d, 2> slopes;  ///< y,₁ and y,₂; in 2D the second is e_z
  double ring = 1.0;                      ///< 2π y₁
  [[nodiscard]] Eigen::Vector3d normal() const { return slopes[0].cross(slopes[1]); }
};

/// Calls visit(point) for all quadrature points of all facets.
template <int d, class Visit>
void FollowerPressure::visit_points(const Vector& displacement, const Visit& visit) const {
  for (const Surface& surface : surfaces_) {
    for (const Facet& facet : surface.facets) {
      const BlockIntegration& rule = rules_[facet.block];
      const Index* const geometry = body_.mesh->facets[facet.block].cell(facet.local);
      const Index* const nodes = body_.space->facets[facet.block].cell(facet.local);
      for (Index q = 0; q < rule.rule.weights.size(); ++q) {
        const auto number = std::size_t(q);
        const Matrix& shape = rule.displacement.gradients[number];
        Point point{surface,
                    nodes,
                    shape,
                    rule.displacement.values,
                    q,
                    facet.side * rule.rule.weights[q],
                    Eigen::Vector3d::Zero(),
                    {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()}};
        for (Index k = 0; k < rule.geometry.values.rows(); ++k)
          point.undeformed.head<d>() += rule.geometry.values(k, q) * body_.mesh->nodes.col(geometry[k]);
        const auto map = jacobian<d, d - 1>(body_.mesh->nodes, geometry, rule.geometry.gradients[number]);
        for (int a = 0; a < d - 1; ++a) point.slopes[std::size_t(a)].head<d>() = map.col(a);
        Eigen::Matrix<double, d, 1> moved = Eigen::Matrix<double, d, 1>::Zero();
        for (Index k = 0; k < shape.rows() && displacement.size() > 0; ++k) {
          const auto u = displacement.segment<d>(nodes[k] * d);
          for (int a = 0; a < d - 1; ++a) point.slopes[std::size_t(a)].head<d>() += shape(k, a) * u;
          moved += rule.displacement.values(k, q) * u;
        }
        if (rule.axisymmetric) point.ring = ring_length(point.undeformed[0] + moved[0]);
        visit(point);
      }
    }
  }
}

template <int d, class Pressure>
void FollowerPressure::add_forces(const Vector& displacement, const Pressure& pressure, Vector& load) const {
  visit_points<d>(displacement, [&](const Point& at) {
    const Eigen::Vector3d force = -pressure(at) * at.weight * at.ring * at.normal();
    for (Index k = 0; k < at.shape.rows(); ++k)
      load.segment<d>(at.nodes[k] * d) += at.values(k, at.q) * force.head<d>();
  });
}

const Vector& FollowerPressure::complete(const Vector& displacement) const {
  if (body_.tied == nullptr || body_.tied->empty() || displacement.size() == 0) return displacement;
  complete_ = displacement;
  body_.tied->complete(complete_, body_.mesh->dimension);
  return complete_;
}

template <class Pressure>
void FollowerPressure::add_condensed(const Vector& displacement, const Pressure& pressure, Vector& load) const {
  const int d = body_.mesh->dimension;
  force_.setZero(load.size());
  const Vector& at = complete(displacement);
  d == 2 ? add_forces<2>(at, pressure, force_) : add_forces<3>(at, pressure, force_);
  if (body_.tied != nullptr && !body_.tied->empty()) body_.tied->condense_load(force_, d);
  load += force_;
}

namespace {

double value_of(const Expression& pressure, const Eigen::Vector3d& at, double time) {
  return pressure(at[0], at[1], at[2], time);
}

double mean_of(const Expression& pressure, const Eigen::Vector3d& at, double start, double end) {
  const double later = value_of(pressure, at, end);
  return pressure.depends_on_time() ? 0.5 * (value_of(pressure, at, start) + later) : later;
}

}  // namespace

void FollowerPressure::add_force(const Vector& displacement, double time, Vector& load, double part) const {
  last_ = {time, part};
  add_condensed(
      displacement, [&](const Point& at) { return part * value_of(at.surface.pressure, at.undeformed, time); }, load);
}

void FollowerPressure::add_mean_force(const Vector& displacement, double start, double end, Vector& load) const {
  last_ = {end, 1.0};
  add_condensed(
      displacement, [&](const Point& at) { return mean_of(at.surface.pressure, at.undeformed, start, end); }, load);
}

namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d result;
  result << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
  return result;
}

}  // namespace

/// −∂force_i/∂u_j = p φ_i (ring ∂n/∂u_j + n ⊗ ∂ring/∂u_j),   ∂n/∂u_j = φ_j,₂ [y,₁]× − φ_j,₁ [y,₂]×.
/// `weighted` is p times the weight of a point.
template <int d, class Weight>
SparseMatrix FollowerPressure::stiffness_of(const Vector& displacement, const Weight& weighted, bool symmetric) const {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&entries](Index row, Index column, double value) {
    entries.emplace_back(int(row), int(column), value);
  };
  visit_points<d>(displacement, [&](const Point& at) {
    const double factor = (symmetric ? 0.5 : 1.0) * weighted(at);
    const Eigen::Matrix3d along = cross_matrix(at.slopes[0]), across = cross_matrix(at.slopes[1]);
    for (Index j = 0; j < at.shape.rows(); ++j) {
      Eigen::Matrix3d change = -at.shape(j, 0) * across;
      if constexpr (d == 3) change += at.shape(j, 1) * along;
      change *= factor * at.ring;
      if (rules_.front().axisymmetric) change.col(0) += factor * ring_length(at.values(j, at.q)) * at.normal();
      for (Index i = 0; i < at.shape.rows(); ++i) {
        for (int a = 0; a < d; ++a) {
          for (int b = 0; b < d; ++b) {
            const double value = at.values(i, at.q) * change(a, b);
            add(at.nodes[i] * d + a, at.nodes[j] * d + b, value);
            if (symmetric) add(at.nodes[j] * d + b, at.nodes[i] * d + a, value);
          }
        }
      }
    }
  });
  SparseMatrix result(body_.space->dof_count(), body_.space->dof_count());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

template <class Weight>
SparseMatrix FollowerPressure::complete_stiffness(const Vector& displacement, const Weight& weighted,
                                                  bool symmetric) const {
  const int d = body_.mesh->dimension;
  const Vector& at = complete(displacement);
  SparseMatrix result = d == 2 ? stiffness_of<2>(at, weighted, symmetric) : stiffness_of<3>(at, weighted, symmetric);
  if (body_.tied == nullptr || body_.tied->empty()) return result;
  return symmetric ? body_.tied->condense(result, d) : body_.tied->condense_general(result, d);
}

SparseMatrix FollowerPressure::stiffness(const Vector& displacement) const {
  const auto weighted = [&](const Point& at) {
    return at.weight * last_.part * value_of(at.surface.pressure, at.undeformed, last_.time);
  };
  return complete_stiffness(displacement, weighted, true);
}

SparseMatrix FollowerPressure::mean_stiffness(const Vector& displacement, double start, double end) const {
  const auto weighted = [&](const Point& at) {
    return at.weight * mean_of(at.surface.pressure, at.undeformed, start, end);
  };
  return complete_stiffness(displacement, weighted, false);
}

}  // namespace ricochet
