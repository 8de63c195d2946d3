#pragma once

#include "ricochet/fem/branch_kernels.hpp"
#include "ricochet/fem/cell_kernel.hpp"
#include "ricochet/fem/strain_path.hpp"

/// @file Kernel of a single cell for the tangent of the mean stress along the path of the strain (strain_path.hpp).
/// Not part of the public interface.
///
/// Let x change by a ψ and Δ̂ by b ψ (PathVariation). Ē = E(x) + ⅛ (∇Δ̂)ᵀ∇Δ̂ and ΔE = sym(F_xᵀ∇Δ̂) then change by
///   dĒ = sym(G₀ᵀ∇ψ), G₀ = a F_x + ¼ b ∇Δ̂,   dΔE = sym(G₁ᵀ∇ψ), G₁ = b F_x + a ∇Δ̂,
/// so that the strain Ē + τ ΔE changes as Green's strain does at a displacement with the deformation gradient
/// G₀ + τ G₁. With C_q = ∂S/∂E at the Gauss points of the path, C⁰ = Σ w_q C_q and C¹ = Σ w_q τ_q C_q, the force
/// D = ∫ F_x S̄ : ∇φ changes by
///   ∫ F_xᵀ∇φ : (C⁰ dĒ + C¹ dΔE) + a S̄ : (∇φ)ᵀ∇ψ,
/// which is symmetric for b = 0 at Δ̂ = 0 only. Mean dilatation and the number c that makes the work of a cell exact
/// couple all points of a cell: both contribute products of vectors with one component per dof of the cell.
namespace ricochet {

template <int d>
class CellPathKernel : public CellKernel<d> {
 public:
  using typename CellKernel<d>::LocalVector;
  /// Square matrix of a cell, column by column.
  using LocalMatrix = Eigen::Map<Eigen::MatrixXd>;

  CellPathKernel(const KernelBlock<d>& block, Index cell, const MaterialLaw& law, bool plane_stress,
                 bool mean_dilatation, const PathVariation& variation)
      : CellKernel<d>(block, cell, law, plane_stress, mean_dilatation), variation_(variation) {}

  /// Computes F_x, Ē, ΔE, G₀ and G₁ at all points. The strain of the linear law does not matter, as its tangent is
  /// constant, and its F is I.
  void set_path(const LocalVector& middle, const LocalVector& increment) {
    const auto [a, b] = variation_;
    for (int q = 0; q < this->points(); ++q) {
      this->go_to(q);
      Tensor gradient = Tensor::Zero(), change = Tensor::Zero();
      if (!this->law().is_linear()) {
        gradient = this->gradient(middle);
        change = this->gradient(increment);
      }
      Point& at = at_[std::size_t(q)];
      at.deformation = Tensor::Identity() + gradient;
      at.mean = green_strain(gradient) + 0.125 * transposed_product(change, change);
      const Tensor product = transposed_product(at.deformation, change);
      at.change = 0.5 * (product + product.transpose());
      at.by_mean = a * at.deformation + 0.25 * b * change;
      at.by_change = b * at.deformation + a * change;
      at.stress.setZero();
      at.of_mean.setZero();
      at.of_change.setZero();
    }
  }

  /// Adds S̄, C⁰ and C¹ of the law at all points, and the products of vectors to the matrix. Requires set_path().
  void add_law(PathRule rule, LocalMatrix& matrix) {
    const PathGaussRule& gauss = gauss_rule_of(rule);
    work_slope_.fill(0.0);
    for (std::size_t k = 0; k < std::size_t(gauss.count); ++k) add_at(gauss.points[k], gauss.weights[k], matrix);
    if (is_exact(rule)) add_exact_work(matrix);
  }

  /// Adds those of the mean stress 2gμ q̄ of the viscoelastic branches. `internal`: A of the cell, point by point.
  void add_branches(const std::vector<BranchNumbers>& branches, const double* internal) {
    const Tensor unit = Tensor::Identity();
    for (int q = 0; q < this->points(); ++q) {
      Point& at = at_[std::size_t(q)];
      const Tensor mean = deviator_of(at.mean), end = deviator_of(at.mean + 0.5 * at.change);
      for (const auto& [modulus, rule] : branches) {
        at.stress += 2.0 * modulus * rule.mean(mean, end, read_tensor(internal));
        internal += internal_components;
        const auto add = [&](double stiffness, StressTangent& to) {
          add_symmetric_product(unit, 2.0 * modulus * stiffness, to);
          add_dyad(unit, unit, -2.0 / 3.0 * modulus * stiffness, to);
        };
        add(rule.mean_stiffness(), at.of_mean);
        add(rule.change_stiffness(), at.of_change);
      }
    }
  }

  /// Adds ∫ F_xᵀ∇φ : (C⁰ dĒ + C¹ dΔE) + a S̄ : (∇φ)ᵀ∇ψ to the matrix, after the functions above.
  void add_points(LocalMatrix& matrix) {
    for (int q = 0; q < this->points(); ++q) {
      this->go_to(q);
      const Point& at = at_[std::size_t(q)];
      const Rows left = rows_of(at.deformation);
      Rows right = at.of_mean * rows_of(at.by_mean);
      right.noalias() += at.of_change * rows_of(at.by_change);
      matrix.noalias() += this->weight(q) * (left.transpose() * right);
      if (!this->law().is_linear()) add_geometric(variation_.middle * this->weight(q) * at.stress, matrix);
    }
  }

 private:
  using Rows = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, most_cell_nodes * d>;
  using typename CellKernel<d>::VolumeProduct;
  using typename CellKernel<d>::VolumeSlopes;

  struct Point {
    Tensor deformation, mean, change;  ///< F_x, Ē, ΔE
    Tensor by_mean, by_change;         ///< G₀, G₁
    Tensor stress;                     ///< S̄
    StressTangent of_mean, of_change;  ///< C⁰, C¹
  };

  [[nodiscard]] Index size() const { return Index(this->nodes()) * d; }
  [[nodiscard]] auto as_vector(const LocalVector& local) const {
    return Eigen::Map<const Eigen::VectorXd>(local.data(), size());
  }
  [[nodiscard]] Rows rows_of(const Tensor& f) const {
    Rows rows(6, size());
    for (int i = 0; i < this->nodes(); ++i) this->strain_rows(i, f, rows.template middleCols<d>(i * d));
    return rows;
  }
  static Tensor product_of(const StressTangent& tangent, const Tensor& strain) {
    Eigen::Matrix<double, 6, 1> components;
    components << strain.diagonal(), 2.0 * strain(0, 1), 2.0 * strain(1, 2), 2.0 * strain(2, 0);
    const Eigen::Matrix<double, 6, 1> stress = tangent * components;
    return read_tensor(stress.data());
  }

  /// Computes the strains at τ, and with mean dilatation the pressures.
  void move_to(double tau) {
    for (int q = 0; q < this->points(); ++q) {
      const Point& at = at_[std::size_t(q)];
      Tensor& strain = strains_[std::size_t(q)];
      strain = at.mean + tau * at.change;
      this->law().complete(strain);
    }
    this->find_dilatation_of([this](int q) -> const Tensor& { return strains_[std::size_t(q)]; });
  }

  /// Adds the point τ of the path with a weight.
  void add_at(double tau, double weight, LocalMatrix& matrix) {
    move_to(tau);
    Tensor stress;
    StressTangent tangent;
    for (int q = 0; q < this->points(); ++q) {
      Point& at = at_[std::size_t(q)];
      this->find_stress(q, strains_[std::size_t(q)], stress);
      this->find_tangent(q, strains_[std::size_t(q)], tangent);
      at.stress += weight * stress;
      at.of_mean += weight * tangent;
      at.of_change += weight * tau * tangent;
    }
    if (this->has_dilatation()) add_volume(tau, weight, matrix);
  }

  /// Adds the change of the pressure of the cell at τ: Σ_mn b_m c_nᵀ ∫ ψ_m ψ_n U″(Θ) with b_m = ∫ ψ_m J C⁻¹ : F_xᵀ∇φ,
  /// c_n = ∫ ψ_n J C⁻¹ : (G₀ + τ G₁)ᵀ∇ψ. Its work on ΔE is a part of the derivative of S̄ : ΔE.
  void add_volume(double tau, double weight, LocalMatrix& matrix) {
    VolumeSlopes left{}, right{};
    VolumeProduct product = VolumeProduct::Zero();
    Eigen::Vector4d work = Eigen::Vector4d::Zero();
    const int count = this->dilatation().functions();
    for (int q = 0; q < this->points(); ++q) {
      this->go_to(q);
      const Point& at = at_[std::size_t(q)];
      const Tensor& strain = strains_[std::size_t(q)];
      const Tensor slope = std::sqrt(1.0 + determinant_change(2.0 * strain)) * inverse_metric(strain);
      this->add_volume_slopes(q, at.deformation * slope, left);
      this->add_volume_slopes(q, (at.by_mean + tau * at.by_change) * slope, right);
      this->add_volume_product(q, product);
      for (int m = 0; m < count; ++m)
        work[m] += this->weight(q) * this->dilatation().function(m, q) * double_dot(slope, at.change);
    }
    product *= weight;
    const Eigen::Vector4d of_work = product * work;
    for (int n = 0; n < count; ++n) {
      const auto change = as_vector(right[std::size_t(n)]);
      for (int m = 0; m < count; ++m)
        matrix.noalias() += (product(m, n) * as_vector(left[std::size_t(m)])) * change.transpose();
      add_work_slope(-of_work[n], change);
    }
  }
  template <class Local>
  void add_work_slope(double factor, const Local& change) {
    Eigen::Map<Eigen::VectorXd>(work_slope_.data(), size()) += factor * change;
  }

  /// Adds c ΔE to S̄, c = ∫ (W(Ē + ½ ΔE) − W(Ē − ½ ΔE) − S̄ : ΔE) / ∫ ΔE : ΔE, and its derivative c dΔE + dc ΔE.
  /// The work of the stress at both ends, S(Ē ± ½ ΔE) : (dĒ ± ½ dΔE), is the change of the energies in dc.
  void add_exact_work(LocalMatrix& matrix) {
    double lacking = 0.0, square = 0.0;
    LocalVector forces{};  // ∫ ΔE : F_xᵀ∇φ
    for (const double sign : {1.0, -1.0}) lacking += sign * add_end(0.5 * sign);
    for (int q = 0; q < this->points(); ++q) {
      this->go_to(q);
      const Point& at = at_[std::size_t(q)];
      lacking -= this->weight(q) * double_dot(at.stress, at.change);
      square += this->weight(q) * double_dot(at.change, at.change);
      const Tensor by_mean = product_of(at.of_mean, at.change), by_change = product_of(at.of_change, at.change);
      this->add_force(q, -at.by_mean * by_mean - at.by_change * (by_change + at.stress), work_slope_);
      this->add_force(q, at.deformation * at.change, forces);
    }
    if (!(square > 0.0)) return;
    const double factor = lacking / square;
    for (int q = 0; q < this->points(); ++q) {
      this->go_to(q);
      Point& at = at_[std::size_t(q)];
      this->add_force(q, -2.0 * factor * at.by_change * at.change, work_slope_);
      at.stress += factor * at.change;
      add_symmetric_product(Tensor::Identity(), factor, at.of_change);
    }
    matrix.noalias() += (as_vector(forces) / square) * as_vector(work_slope_).transpose();
  }
  /// Adds 2τ times the derivative of the energy of the cell at the end τ of the path; returns that energy.
  double add_end(double tau) {
    move_to(tau);
    double energy = 0.0;
    Tensor stress;
    for (int q = 0; q < this->points(); ++q) {
      this->go_to(q);
      const Point& at = at_[std::size_t(q)];
      const Tensor& strain = strains_[std::size_t(q)];
      energy += this->weight(q) * this->energy_at(q, strain);
      this->find_stress(q, strain, stress);
      this->add_force(q, 2.0 * tau * (at.by_mean + tau * at.by_change) * stress, work_slope_);
    }
    return energy;
  }

  /// Adds S : (∇φ)ᵀ∇ψ at a point.
  void add_geometric(const Tensor& stress, LocalMatrix& matrix) const {
    const auto s = stress.topLeftCorner<d, d>();
    for (int j = 0; j < this->nodes(); ++j) {
      const Eigen::Matrix<double, d, 1> traction =
          s * Eigen::Map<const Eigen::Matrix<double, d, 1>>(this->shape_gradient(j));
      for (int i = 0; i < this->nodes(); ++i) {
        const double value = Eigen::Map<const Eigen::Matrix<double, d, 1>>(this->shape_gradient(i)).dot(traction);
        matrix.template block<d, d>(i * d, j * d).diagonal().array() += value;
        if (d == 2 && this->block().is_axisymmetric())
          matrix(i * d, j * d) += stress(2, 2) * this->hoop(i) * this->hoop(j);
      }
    }
  }

  PathVariation variation_;
  std::array<Point, most_cell_points> at_;
  std::array<Tensor, most_cell_points> strains_;  ///< at the current point of the path
  LocalVector work_slope_;  ///< derivative of ∫ (W(Ē + ½ ΔE) − W(Ē − ½ ΔE) − S̄ : ΔE)
};

}  // namespace ricochet
