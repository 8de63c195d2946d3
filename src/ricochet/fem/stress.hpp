#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file Stress and strain energy of cells.
namespace ricochet {

struct BlockIntegration;
class ElasticCells;

/// Symmetric 3 × 3 tensors, also in the plane, by xx, xy, xz, yy, yz, zz: the order of XDMF.
inline constexpr int tensor_components = 6;

/// The largest of some values, and which one it is; the first of those that are equal.
struct LargestOfCells {
  double value = -1.0;
  Index cell = -1;
  LargestOfCells& operator+=(const LargestOfCells& other) {
    if (other.value > value) *this = other;
    return *this;
  }
};

/// Means over each cell of the stress σ = λ tr ε I + 2μ ε and of ½ σ : ε, by the quadrature of the stiffness: the sum
/// of the energy densities times the volumes of the cells is ½UᵀKU. In the plane σ_zz is that of plane strain, or zero;
/// in axisymmetric bodies it is the hoop stress.
/// Of laws of finite strain the Cauchy stress, and the energy per undeformed volume; with the internal strains of a
/// state those of branches that relax are in both (elastic_cells.hpp).
class CellStress {
 public:
  /// Keeps a reference.
  explicit CellStress(const Body& body);
  ~CellStress();
  CellStress(CellStress&&) noexcept;

  /// Cells are numbered through all blocks. `stress`: 6 per cell; `energy_density`: one.
  void evaluate(const Vector& displacement, std::vector<double>& stress, std::vector<double>& energy_density,
                const Vector& internal = {}) const;
  /// The largest von Mises stress of these means. Allocates nothing.
  [[nodiscard]] LargestOfCells largest_von_mises(const Vector& displacement, const Vector& internal = {}) const;

 private:
  template <int d>
  void evaluate_block(std::size_t block, Index first_cell, const Vector& displacement, const Vector& internal,
                      double* stress, double* energy_density) const;

  template <int d>
  [[nodiscard]] LargestOfCells largest_in_block(std::size_t block, Index first_cell, const Vector& displacement,
                                                const Vector& internal) const;

  const Body& body_;
  /// Per block; none for straight simplices of degree 1.
  std::vector<std::unique_ptr<const BlockIntegration>> integrations_;
  std::unique_ptr<const ElasticCells> finite_;  ///< null: all laws are linear
};

/// √(3/2 s : s) with the deviator s.
[[nodiscard]] double von_mises_stress(const double* stress);
/// Eigenvalues, largest first.
[[nodiscard]] std::array<double, 3> principal_stresses(const double* stress);

/// Volume of every cell (area in the plane, volume of the ring in axisymmetric bodies), numbered through all blocks.
[[nodiscard]] Vector cell_volumes(const Body& body);

}  // namespace ricochet
