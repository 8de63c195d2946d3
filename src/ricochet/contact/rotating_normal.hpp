#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file Direction that rotates with a surface.
namespace ricochet {

/// N(x) as a function of the positions x = X + U of a few nodes, with the facets f of a surface around a point and
/// their edges e_k (of quadrilaterals their diagonals):
///   N(x) = s Σ_f ± a_f(x) + Σ_k β_k e_k(x),   β_k = c · e_k(X),
/// a_f the area vector between the vertices of a facet (in 2D the edge rotated by a right angle), so that N is linear
/// in x in 2D and quadratic in 3D. The number s and the vector c, which is perpendicular to Σ_f ± a_f(X), are chosen so
/// that N(X) is a given unit vector. For any s and c, N rotates with the surface, and no translation changes it; the
/// order of facets or nodes does not matter. All vectors have three components; in 2D the third is 0.
class RotatingNormal {
 public:
  using Vector3 = Eigen::Vector3d;

  /// Constant `direction` (d).
  explicit RotatingNormal(const Vector& direction);
  /// `direction`: N at X, of length 1. Facets (numbered through all blocks) seen nearly edge-on along it are excluded;
  /// if all are, or if edges are parallel to the sum of area vectors, N does not rotate.
  RotatingNormal(const DisplacementSpace& space, const std::vector<Index>& facets, const Vector& direction);

  /// Mean of the N of two surfaces that face each other. One that does not rotate is excluded.
  [[nodiscard]] static RotatingNormal mean(const RotatingNormal& one, const RotatingNormal& other);

  [[nodiscard]] bool rotates() const { return !crosses_.empty(); }
  /// Nodes on which N depends, each at least once.
  [[nodiscard]] std::vector<Index> nodes() const;
  /// N at X + U; `nodes`: X, d × count; `displacement`: zero if empty.
  [[nodiscard]] Vector3 at(const Points& nodes, const Vector& displacement) const;
  /// Calls visit(node, (∂N/∂x_node)ᵀ w) at X + U for all nodes on which N depends, some of them more than once.
  template <class Visit>
  void visit_derivative(const Points& nodes, const Vector& displacement, const Vector3& w, const Visit& visit) const;

 private:
  /// x_to − x_from; if from < 0 the unit vector normal to the plane.
  struct Edge {
    Index from = -1, to = -1;
  };
  /// factor · one × other.
  struct Cross {
    Edge one, other;
    double factor = 1.0;
  };
  struct Line {
    Edge edge;
    double factor = 0.0;
  };

  void add_facet(const DisplacementSpace& space, Index facet, const Vector3& direction);
  void fit(const DisplacementSpace& space, const Vector3& direction);
  [[nodiscard]] static Vector3 vector(const Edge& edge, const Points& nodes, const Vector& displacement);

  Vector3 constant_ = Vector3::Zero();
  std::vector<Cross> crosses_;
  std::vector<Line> lines_;
};

inline RotatingNormal::Vector3 RotatingNormal::vector(const Edge& edge, const Points& nodes,
                                                      const Vector& displacement) {
  if (edge.from < 0) return Vector3::UnitZ();
  const Index d = nodes.rows();
  Vector3 result = Vector3::Zero();
  for (Index k = 0; k < d; ++k) result[k] = nodes(k, edge.to) - nodes(k, edge.from);
  if (displacement.size() == 0) return result;
  for (Index k = 0; k < d; ++k) result[k] += displacement[edge.to * d + k] - displacement[edge.from * d + k];
  return result;
}

template <class Visit>
void RotatingNormal::visit_derivative(const Points& nodes, const Vector& displacement, const Vector3& w,
                                      const Visit& visit) const {
  const auto along = [&](const Edge& edge, const Vector3& value) {
    if (edge.from < 0) return;
    visit(edge.to, value);
    visit(edge.from, Vector3(-value));
  };
  for (const Cross& cross : crosses_) {
    along(cross.one, cross.factor * vector(cross.other, nodes, displacement).cross(w));
    along(cross.other, cross.factor * w.cross(vector(cross.one, nodes, displacement)));
  }
  for (const Line& line : lines_) along(line.edge, line.factor * w);
}

}  // namespace ricochet
