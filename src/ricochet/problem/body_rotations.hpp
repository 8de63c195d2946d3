#pragma once

#include <vector>

#include "ricochet/fem/material_law.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file How far each body has turned.
namespace ricochet {

/// The rotation R of a body is that which fits its places x best in the sense of least squares,
/// Σ |x_a − x̄ − R (X_a − X̄)|² over nodes: the orthogonal part of Σ (x_a − x̄)(X_a − X̄)ᵀ. Bodies that supports hold do
/// not turn as a whole, and have R = I; where these hold one component in space alone, as on a plane of symmetry, a
/// body turns about that axis. Axisymmetric bodies do not turn.
class BodyRotations {
 public:
  /// Bodies are the connected components of the graph of K. Keeps a reference.
  explicit BodyRotations(const SemidiscreteProblem& problem);

  [[nodiscard]] std::size_t count() const { return bodies_.size(); }
  /// −1 for nodes that follow others.
  [[nodiscard]] int body_of_node(Index node) const { return body_of_node_[static_cast<std::size_t>(node)]; }
  [[nodiscard]] bool turns(int body) const { return !bodies_[static_cast<std::size_t>(body)].fitted.empty(); }
  /// The axis that a body turns about, 2 in the plane; −1: any.
  [[nodiscard]] int axis(int body) const {
    return problem_.dimension == 2 ? 2 : bodies_[static_cast<std::size_t>(body)].axis;
  }
  /// One per body; in the plane they turn about z.
  void fit(const Vector& displacement, std::vector<Tensor>& rotations) const;

 private:
  /// The rotation is a frame to solve in and no result: a sample of nodes has it near enough.
  static constexpr Index most_fitted = 1024;
  struct Body {
    std::vector<Index> fitted;  ///< nodes; none: it does not turn
    int axis = -1;              ///< that it turns about; −1: any
  };
  template <int d>
  [[nodiscard]] Tensor fit_body(const Body& body, const Vector& displacement) const;

  const SemidiscreteProblem& problem_;
  std::vector<Body> bodies_;
  std::vector<int> body_of_node_;
};

/// The angle of a rotation, in [0, π].
[[nodiscard]] double rotation_angle(const Tensor& rotation);

}  // namespace ricochet
