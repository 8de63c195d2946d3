#pragma once

#include <vector>

#include "ricochet/fem/material_law.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Rotations of the bodies, fitted to the displacement.
namespace ricochet {

/// The rotation R of a body is the least-squares fit to its current positions x, i.e. it minimizes Σ |x_a − x̄ − R (X_a
/// − X̄)|² over the nodes: the orthogonal factor of Σ (x_a − x̄)(X_a − X̄)ᵀ. Bodies held by supports do not rotate as a
/// whole and have R = I; if their supports constrain a single component in 3D, as on a plane of symmetry, the body
/// rotates about that axis. Axisymmetric bodies do not rotate.
class BodyRotations {
 public:
  /// Takes the connected components of the graph of K as bodies. Keeps a reference.
  explicit BodyRotations(const SemidiscreteProblem& problem);

  [[nodiscard]] std::size_t count() const { return bodies_.size(); }
  /// Body of a node; −1 for tied nodes and for nodes of rigid bodies.
  [[nodiscard]] int body_of_node(Index node) const { return body_of_node_[std::size_t(node)]; }
  /// Whether some support acts on a body.
  [[nodiscard]] bool is_held(int body) const { return bodies_[std::size_t(body)].is_held; }
  [[nodiscard]] bool rotates(int body) const { return !bodies_[std::size_t(body)].fitted.empty(); }
  /// Axis of rotation of a body, 2 in 2D; −1 if free to rotate about any axis.
  [[nodiscard]] int axis(int body) const { return problem_.dimension == 2 ? 2 : bodies_[std::size_t(body)].axis; }
  /// Computes one rotation per body; in 2D about z.
  void fit(const Vector& displacement, std::vector<Tensor>& rotations) const;

 private:
  /// Upper bound on the nodes fitted per body. The rotation defines a frame to solve in, not a
  /// result, so a sample suffices.
  static constexpr Index most_fitted = 1024;
  struct Body {
    std::vector<Index> fitted;  ///< nodes in the fit; none if the body does not rotate
    int axis = -1;              ///< of rotation; −1 if any
    bool is_held = false;       ///< by some support
  };
  template <int d>
  [[nodiscard]] Tensor fit_body(const Body& body, const Vector& displacement) const;

  const SemidiscreteProblem& problem_;
  std::vector<Body> bodies_;
  std::vector<int> body_of_node_;
};

/// Angle of a rotation, in [0, π].
[[nodiscard]] double rotation_angle(const Tensor& rotation);

}  // namespace ricochet
