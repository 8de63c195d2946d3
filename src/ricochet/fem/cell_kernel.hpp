#pragma once

#include <array>

#include "ricochet/fem/cell_dilatation.hpp"
#include "ricochet/fem/element_matrices.hpp"
#include "ricochet/fem/finite_strain.hpp"
#include "ricochet/fem/kernel_block.hpp"
#include "ricochet/fem/point_law.hpp"

/// @file Kernel of a single cell: tangents, including those of viscoelastic branches, and stress for output.
/// pack_kernels.hpp has energy and forces of all cells. Not part of the public interface.
namespace ricochet {

/// Cell at a displacement. A local vector has d components per node of the cell.
template <int d>
class CellKernel {
 public:
  using LocalVector = std::array<double, most_cell_nodes * d>;

  CellKernel(const KernelBlock<d>& block, Index cell, const MaterialLaw& law, bool plane_stress, bool mean_dilatation)
      : block_(block), law_(law, plane_stress) {
    const auto lane = Index(block.lane[std::size_t(cell)]);
    pack_ = lane / block.width;
    lane_ = lane % block.width;
    for (int q = 0; q < block.points; ++q)
      weights_[std::size_t(q)] = block.weight[std::size_t(block.index(pack_, q) + lane_)];
    if (mean_dilatation && law.volumetric_modulus() > 0.0 && block.dilatation_functions.size() > 0) {
      volume_.modulus = law.volumetric_modulus();
      dilatation_.start(block.dilatation_functions, weights_.data(), block.points);
    }
  }

  void gather(const Index* nodes, const Vector& from, LocalVector& to) const {
    for (int i = 0; i < block_.nodes; ++i) {
      for (int a = 0; a < d; ++a) to[std::size_t(i * d + a)] = from[nodes[i] * d + a];
    }
  }

  /// Computes the gradients of the shape functions at a point.
  void go_to(int q) {
    const double* from = block_.inverse_of_pack(pack_, q) + lane_;
    std::array<double, d * d> inverse;
    for (double& entry : inverse) {
      entry = *from;
      from += block_.width;
    }
    const double* reference = block_.gradients.data() + q * block_.nodes * d;
    for (int i = 0; i < block_.nodes; ++i, reference += d) {
      for (std::size_t a = 0; a < d; ++a) {
        double sum = reference[0] * inverse[a];
        for (std::size_t k = 1; k < d; ++k) sum += reference[k] * inverse[k * d + a];
        gradients_[std::size_t(i) * d + a] = sum;
      }
    }
    if (!block_.is_axisymmetric()) return;
    const double radius = block_.radius[std::size_t(block_.index(pack_, q) + lane_)];
    for (int i = 0; i < block_.nodes; ++i)
      hoop_[std::size_t(i)] = block_.integration.displacement.values(i, q) / radius;
  }
  [[nodiscard]] double weight(int q) const { return weights_[std::size_t(q)]; }
  [[nodiscard]] Tensor gradient(const LocalVector& u) const {
    Tensor result = Tensor::Zero();
    for (int i = 0; i < block_.nodes; ++i) {
      for (int a = 0; a < d; ++a) {
        for (int b = 0; b < d; ++b) result(a, b) += u[std::size_t(i * d + a)] * gradients_[std::size_t(i * d + b)];
      }
    }
    if (d == 2 && block_.is_axisymmetric()) {
      for (int i = 0; i < block_.nodes; ++i) result(2, 2) += u[std::size_t(i * d)] * hoop_[std::size_t(i)];
    }
    return result;
  }
  /// Adds ∫ P ∇φ_a of this point to a local vector.
  void add_force(int q, const Tensor& stress, LocalVector& force) const {
    for (int i = 0; i < block_.nodes; ++i) {
      for (int a = 0; a < d; ++a) {
        double sum = 0.0;
        for (int b = 0; b < d; ++b) sum += stress(a, b) * gradients_[std::size_t(i * d + b)];
        force[std::size_t(i * d + a)] += weight(q) * sum;
      }
      if (d == 2 && block_.is_axisymmetric())
        force[std::size_t(i * d)] += weight(q) * stress(2, 2) * hoop_[std::size_t(i)];
    }
  }

  /// Displacement gradient at a point, from which F is formed, and the strain of its stress.
  struct PointMotion {
    Tensor gradient, strain;
  };
  [[nodiscard]] PointMotion motion_of(const LocalVector& u) const {
    const Tensor motion = gradient(u);
    return {motion, law_.strain(motion)};
  }

  /// Calls visit(q, F, E, S) at all points, with the stretch normal to the plane in F; the current gradients are those
  /// of q. The values are meaningless if det F is not positive. (For the linear law F = I.)
  template <class Visit>
  void visit_stress(const LocalVector& u, const Visit& visit) {
    find_dilatation(u);
    Tensor stress;
    for (int q = 0; q < block_.points; ++q) {
      go_to(q);
      const PointMotion at = motion_of(u);
      const Tensor& strain = at.strain;
      const Tensor deformation = deformation_of(at.gradient, strain);
      find_stress(q, strain, stress);
      visit(q, deformation, strain, stress);
    }
  }

  /// Energy density at a point, within visit_stress().
  [[nodiscard]] double energy_at(int q, const Tensor& strain) const {
    double density = law_.energy(strain);
    if (has_dilatation()) {
      const double theta = mean_[std::size_t(q)];  // Θ − 1
      density += volume_.energy(theta * (2.0 + theta)) - volume_.energy(determinant_change(2.0 * strain));
    }
    return density;
  }

  /// Adds the tangent in d × d blocks for pairs of nodes, in the order of element_matrices.hpp.
  void add_tangent(const LocalVector& u, double* blocks) {
    find_dilatation(u);
    Tensor stress;
    StressTangent tangent;
    for (int q = 0; q < block_.points; ++q) {
      go_to(q);
      const auto [motion, strain] = motion_of(u);
      const Tensor deformation = deformation_of(motion, strain);
      find_stress(q, strain, stress);
      find_tangent(q, strain, tangent);
      add_point_tangent(q, deformation, law_.is_linear() ? Tensor::Zero().eval() : stress, tangent, blocks);
    }
    if (has_dilatation()) add_volume_tangent(u, blocks);
    make_symmetric(blocks);
  }

  /// Adds the tangent, at zero stress, of the stress `modulus` times the deviator of the strain.
  void add_deviatoric_tangent(const LocalVector& u, double modulus, double* blocks) {
    StressTangent tangent = StressTangent::Zero();
    add_symmetric_product(Tensor::Identity(), modulus, tangent);
    add_dyad(Tensor::Identity(), Tensor::Identity(), -modulus / 3.0, tangent);
    for (int q = 0; q < block_.points; ++q) {
      go_to(q);
      const auto [motion, strain] = motion_of(u);
      add_point_tangent(q, deformation_of(motion, strain), Tensor::Zero(), tangent, blocks);
    }
    make_symmetric(blocks);
  }

  [[nodiscard]] bool has_dilatation() const { return volume_.modulus > 0.0; }
  [[nodiscard]] int points() const { return block_.points; }
  [[nodiscard]] int nodes() const { return block_.nodes; }

 protected:
  using PointValues = std::array<double, most_cell_points>;
  static constexpr int most_functions = CellDilatation<double>::most_functions;
  /// ∫ ψ_m ∂J/∂u of the functions ψ_m of the mean dilatation, and ∫ ψ_m ψ_n U″(Θ).
  using VolumeSlopes = std::array<LocalVector, most_functions>;
  using VolumeProduct = Eigen::Matrix<double, most_functions, most_functions>;

  [[nodiscard]] const PointLaw& law() const { return law_; }
  [[nodiscard]] const KernelBlock<d>& block() const { return block_; }
  [[nodiscard]] const CellDilatation<double>& dilatation() const { return dilatation_; }
  [[nodiscard]] const double* shape_gradient(int node) const { return gradients_.data() + node * d; }
  [[nodiscard]] double hoop(int node) const { return hoop_[std::size_t(node)]; }

  /// F. Under plane stress the stretch normal to the plane follows from the strain.
  [[nodiscard]] Tensor deformation_of(const Tensor& motion, const Tensor& strain) const {
    if (law_.is_linear()) return Tensor::Identity();
    Tensor result = Tensor::Identity() + motion;
    if (law_.is_plane_stress()) result(2, 2) = std::sqrt(1.0 + 2.0 * strain(2, 2));
    return result;
  }

  /// Computes Θ − 1 and the pressure p at all points from their strains strain(q), if there is a mean dilatation.
  template <class Strain>
  void find_dilatation_of(const Strain& strain) {
    if (!has_dilatation()) return;
    PointValues change;
    for (int q = 0; q < block_.points; ++q) change[std::size_t(q)] = volume_change(determinant_change(2.0 * strain(q)));
    dilatation_.project(change.data(), mean_.data());
    for (int q = 0; q < block_.points; ++q) change[std::size_t(q)] = slope(mean_[std::size_t(q)]);
    dilatation_.project(change.data(), pressure_.data());
  }
  void find_dilatation(const LocalVector& u) {
    find_dilatation_of([&](int q) {
      go_to(q);
      return motion_of(u).strain;
    });
  }

  // At a point, after find_dilatation(), with the pressure of the cell. The tangent is that at constant pressure.
  void find_stress(int q, const Tensor& strain, Tensor& stress) const {
    law_.stress(strain, stress);
    if (has_dilatation()) add_mean_pressure(q, strain, stress);
  }
  void find_tangent(int q, const Tensor& strain, StressTangent& tangent) const {
    law_.tangent(strain, tangent);
    if (has_dilatation()) add_mean_tangent(q, strain, tangent);
  }
  /// U′ and U″ of U(J) = (K/4)(J² − 1 − 2 ln J) at J = 1 + j.
  [[nodiscard]] double slope(double j) const { return 0.5 * volume_.modulus * j * (2.0 + j) / (1.0 + j); }
  [[nodiscard]] double curvature(double j) const {
    const double volume = 1.0 + j;
    return 0.5 * volume_.modulus * (1.0 + 1.0 / (volume * volume));
  }

  /// Adds the correction S += (p − U′(J)) J C⁻¹.
  void add_mean_pressure(int q, const Tensor& strain, Tensor& stress) const {
    const double s = determinant_change(2.0 * strain), volume = std::sqrt(1.0 + s);
    const Tensor inverse = inverse_metric(strain);
    stress += (pressure_[std::size_t(q)] * volume - volume_.stress_factor(s)) * inverse;
  }
  /// Adds the derivative ∂/∂E of the correction with p constant: p J (C⁻¹ ⊗ C⁻¹ − 2 C⁻¹ ⊙ C⁻¹)
  /// replaces the tangent of U(J).
  void add_mean_tangent(int q, const Tensor& strain, StressTangent& tangent) const {
    const double s = determinant_change(2.0 * strain), volume = std::sqrt(1.0 + s);
    const Tensor inverse = inverse_metric(strain);
    const double p = pressure_[std::size_t(q)] * volume;
    VolumetricEnergy{-volume_.modulus}.add_tangent(s, inverse, tangent);
    add_dyad(inverse, inverse, p, tangent);
    add_symmetric_product(inverse, -2.0 * p, tangent);
  }

  /// Computes the rows of B of a node: derivatives of the strain components (shear doubled) by its displacements, at F.
  template <class Rows>
  void strain_rows(int node, const Tensor& f, Rows&& rows) const {
    std::array<double, 3> g{};
    for (int a = 0; a < d; ++a) g[std::size_t(a)] = gradients_[std::size_t(node * d + a)];
    for (int k = 0; k < d; ++k) {
      rows(0, k) = f(k, 0) * g[0];
      rows(1, k) = f(k, 1) * g[1];
      rows(2, k) = d == 3 ? f(k, 2) * g[2] : 0.0;
      rows(3, k) = f(k, 0) * g[1] + f(k, 1) * g[0];
      rows(4, k) = d == 3 ? f(k, 1) * g[2] + f(k, 2) * g[1] : 0.0;
      rows(5, k) = d == 3 ? f(k, 2) * g[0] + f(k, 0) * g[2] : 0.0;
    }
    if (d == 2 && block_.is_axisymmetric()) rows(2, 0) = f(2, 2) * hoop_[std::size_t(node)];
  }

  void add_point_tangent(int q, const Tensor& f, const Tensor& stress, const StressTangent& tangent, double* blocks) {
    std::array<Eigen::Matrix<double, 6, d>, most_cell_nodes> rows;
    for (int i = 0; i < block_.nodes; ++i) strain_rows(i, f, rows[std::size_t(i)]);
    const StressTangent weighted = weight(q) * tangent;
    for (int j = 0; j < block_.nodes; ++j) {
      const Eigen::Matrix<double, 6, d> right = weighted * rows[std::size_t(j)];
      Eigen::Matrix<double, d, 1> traction = Eigen::Matrix<double, d, 1>::Zero();
      for (int a = 0; a < d; ++a) {
        for (int b = 0; b < d; ++b) traction[a] += weight(q) * stress(a, b) * gradients_[std::size_t(j * d + b)];
      }
      for (int i = 0; i <= j; ++i, blocks += d * d) {
        const Eigen::Matrix<double, d, d> block = rows[std::size_t(i)].transpose() * right;
        double geometric = 0.0;
        for (int a = 0; a < d; ++a) geometric += gradients_[std::size_t(i * d + a)] * traction[a];
        for (int a = 0; a < d; ++a) {
          for (int b = 0; b < d; ++b) blocks[a * d + b] += block(a, b);
          blocks[a * d + a] += geometric;
        }
        if (d == 2 && block_.is_axisymmetric()) {
          blocks[0] += weight(q) * stress(2, 2) * hoop_[std::size_t(i)] * hoop_[std::size_t(j)];
        }
      }
    }
  }

  /// Makes the result exactly symmetric: the diagonal blocks are symmetric only up to rounding.
  void make_symmetric(double* blocks) const {
    for (int j = 0; j < block_.nodes; ++j) {
      double* const own = blocks + pair_number(j, j) * d * d;
      for (int a = 0; a < d; ++a) {
        for (int b = 0; b < a; ++b) own[a * d + b] = own[b * d + a];
      }
    }
  }

  /// Adds ∫ ψ_m A ∇φ of a point, A = ∂J/∂H.
  void add_volume_slopes(int q, const Tensor& slope, VolumeSlopes& slopes) const {
    for (int m = 0; m < dilatation_.functions(); ++m)
      add_force(q, dilatation_.function(m, q) * slope, slopes[std::size_t(m)]);
  }
  /// Adds ∫ ψ_m ψ_n U″(Θ) of a point.
  void add_volume_product(int q, VolumeProduct& product) const {
    const double second = weight(q) * curvature(mean_[std::size_t(q)]);
    for (int m = 0; m < dilatation_.functions(); ++m) {
      const double value = dilatation_.function(m, q);
      for (int n = 0; n < dilatation_.functions(); ++n) product(m, n) += value * second * dilatation_.function(n, q);
    }
  }

  /// Adds the tangent of U(Θ): Σ_mn b_m b_nᵀ ∫ ψ_m ψ_n U″(Θ), b_m = ∫ ψ_m ∂J/∂u.
  void add_volume_tangent(const LocalVector& u, double* blocks) {
    const int count = dilatation_.functions();
    VolumeSlopes slopes{};
    VolumeProduct product = VolumeProduct::Zero();
    for (int q = 0; q < block_.points; ++q) {
      go_to(q);
      const Tensor f = Tensor::Identity() + gradient(u);
      const Tensor cofactor = f.determinant() * f.inverse().transpose();
      add_volume_slopes(q, cofactor, slopes);
      add_volume_product(q, product);
    }
    for (int j = 0; j < block_.nodes; ++j) {
      for (int i = 0; i <= j; ++i, blocks += d * d) {
        for (int m = 0; m < count; ++m) {
          for (int n = 0; n < count; ++n) {
            for (int a = 0; a < d; ++a) {
              for (int b = 0; b < d; ++b) {
                blocks[a * d + b] += product(m, n) * slopes[std::size_t(m)][std::size_t(i * d + a)] *
                                     slopes[std::size_t(n)][std::size_t(j * d + b)];
              }
            }
          }
        }
      }
    }
  }

 private:
  const KernelBlock<d>& block_;
  PointLaw law_;
  Index pack_, lane_;
  VolumetricEnergy volume_;  ///< modulus 0 if there is no mean dilatation
  CellDilatation<double> dilatation_;
  PointValues weights_;          // only the first block_.points are set
  PointValues mean_, pressure_;  // set only by find_dilatation(): a kernel is constructed for every cell in every pass
  std::array<double, most_cell_nodes * d> gradients_;
  std::array<double, most_cell_nodes> hoop_;  ///< φ/r in axisymmetric bodies
};

}  // namespace ricochet
