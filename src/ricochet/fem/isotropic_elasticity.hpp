#pragma once

#include <Eigen/Core>

/// @file Isotropic linear elasticity: W = ½λ (tr ε)² + μ ε : ε, σ = λ tr ε I + 2μ ε, ε the symmetric part of the
/// displacement gradient. Assembly and stress output both use these formulas.
namespace ricochet {

/// λ and μ effective in a body of the given dimension and plane state.
struct IsotropicElasticity {
  double lambda = 0.0;
  double mu = 0.0;

  /// Converts the 3D parameters: plane stress condenses the stress-free direction, λ := 2λμ/(λ+2μ).
  [[nodiscard]] static IsotropicElasticity of(double lambda, double mu, bool plane_stress) {
    return {plane_stress ? 2.0 * lambda * mu / (lambda + 2.0 * mu) : lambda, mu};
  }

  template <class Tensor>
  [[nodiscard]] double energy(const Eigen::MatrixBase<Tensor>& strain) const {
    const double trace = strain.trace();
    return 0.5 * lambda * trace * trace + mu * strain.squaredNorm();
  }
  /// Stress normal to the plane under plane strain.
  template <class Tensor>
  [[nodiscard]] double out_of_plane_stress(const Eigen::MatrixBase<Tensor>& strain) const {
    return lambda * strain.trace();
  }
  // Contributions of the hoop strain of an axisymmetric body, which has no shear components.
  template <class Tensor>
  [[nodiscard]] double hoop_energy(const Eigen::MatrixBase<Tensor>& strain, double hoop) const {
    return hoop * (lambda * strain.trace() + (0.5 * lambda + mu) * hoop);
  }
  [[nodiscard]] double hoop_pressure(double hoop) const { return lambda * hoop; }
  [[nodiscard]] double hoop_stress(double hoop) const { return (lambda + 2.0 * mu) * hoop; }
  /// Adds the hoop terms to the result of add_tangent<2>, with the hoop strains h_i, h_j of radial
  /// displacements of the two nodes.
  void add_hoop_tangent(const double* gi, double hi, const double* gj, double hj, double* result) const {
    result[0] += lambda * (hi * gj[0] + gi[0] * hj) + (lambda + 2.0 * mu) * (hi * hj);
    result[1] += lambda * (hi * gj[1]);
    result[2] += lambda * (gi[1] * hj);
  }

  template <class Strain, class Stress>
  void stress(const Eigen::MatrixBase<Strain>& strain, Eigen::MatrixBase<Stress>& result) const {
    const double pressure = lambda * strain.trace();
    result = 2.0 * mu * strain;
    result.diagonal().array() += pressure;
  }
  /// Adds factor · (λ g_i g_jᵀ + μ g_j g_iᵀ + μ g_i·g_j I): the tangent between the displacements of two nodes whose
  /// shape functions have the gradients g_i, g_j. d × d numbers, row by row.
  template <int d>
  void add_tangent(const double* gi, const double* gj, double* result) const {
    double product = 0.0;
    for (int a = 0; a < d; ++a) product += gi[a] * gj[a];
    for (int a = 0; a < d; ++a) {
      for (int b = 0; b < d; ++b) result[a * d + b] += lambda * (gi[a] * gj[b]) + mu * (gi[b] * gj[a]);
      result[a * d + a] += mu * product;
    }
  }
};

}  // namespace ricochet
