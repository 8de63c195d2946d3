#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file A direction that turns with a surface.
namespace ricochet {

/// N(x) of the positions x = X + U of a few nodes, with the facets f of a surface around a point and their edges e_k
/// (of quadrilaterals their diagonals):
///   N(x) = s Σ_f ± a_f(x) + Σ_k β_k e_k(x),   β_k = c · e_k(X),
/// a_f the area vector between the vertices of a facet (in two dimensions the edge turned by a right angle), which
/// makes N linear in x in two dimensions and quadratic in three. The number s and the vector c, which is across
/// Σ_f ± a_f(X), are those with which N(X) is a given unit vector. Whatever they are, N turns with a surface that
/// turns, and no translation changes it; no order of facets or nodes matters. Everything has three coordinates; in two
/// dimensions the third is 0.
class TurningNormal {
 public:
  using Three = Eigen::Vector3d;

  /// Always `direction` (d).
  explicit TurningNormal(const Vector& direction);
  /// `direction`: N at X, of length 1. Facets (numbered through all blocks) that are seen nearly edge-on along it have
  /// no part; where all are, or where edges are along the sum of area vectors, N does not turn.
  TurningNormal(const DisplacementSpace& space, const std::vector<Index>& facets, const Vector& direction);

  /// Half of each: N of two surfaces that face each other. One that does not turn has no part.
  [[nodiscard]] static TurningNormal mean(const TurningNormal& one, const TurningNormal& other);

  [[nodiscard]] bool turns() const { return !crosses_.empty(); }
  /// The nodes that N depends on, each at least once.
  [[nodiscard]] std::vector<Index> nodes() const;
  /// N at X + U; `nodes`: X, d × count; `displacement`: empty: none.
  [[nodiscard]] Three at(const Points& nodes, const Vector& displacement) const;
  /// Calls visit(node, (∂N/∂x_node)ᵀ w) at X + U for all nodes that N depends on, some of them more than once.
  template <class Visit>
  void visit_derivative(const Points& nodes, const Vector& displacement, const Three& w, const Visit& visit) const;

 private:
  /// x_to − x_from; without nodes the unit vector across the plane.
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

  void add_facet(const DisplacementSpace& space, Index facet, const Three& direction);
  void fit(const DisplacementSpace& space, const Three& direction);
  [[nodiscard]] static Three vector(const Edge& edge, const Points& nodes, const Vector& displacement);

  Three constant_ = Three::Zero();
  std::vector<Cross> crosses_;
  std::vector<Line> lines_;
};

inline TurningNormal::Three TurningNormal::vector(const Edge& edge, const Points& nodes, const Vector& displacement) {
  if (edge.from < 0) return Three::UnitZ();
  const Index d = nodes.rows();
  Three result = Three::Zero();
  for (Index k = 0; k < d; ++k) result[k] = nodes(k, edge.to) - nodes(k, edge.from);
  if (displacement.size() == 0) return result;
  for (Index k = 0; k < d; ++k) result[k] += displacement[edge.to * d + k] - displacement[edge.from * d + k];
  return result;
}

template <class Visit>
void TurningNormal::visit_derivative(const Points& nodes, const Vector& displacement, const Three& w,
                                     const Visit& visit) const {
  const auto along = [&](const Edge& edge, const Three& value) {
    if (edge.from < 0) return;
    visit(edge.to, value);
    visit(edge.from, Three(-value));
  };
  for (const Cross& cross : crosses_) {
    along(cross.one, cross.factor * vector(cross.other, nodes, displacement).cross(w));
    along(cross.other, cross.factor * w.cross(vector(cross.one, nodes, displacement)));
  }
  for (const Line& line : lines_) along(line.edge, line.factor * w);
}

}  // namespace ricochet
