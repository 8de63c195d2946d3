#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file Stress and strain energy of cells.
namespace ricochet {

struct BlockIntegration;
class ElasticCells;

/// Number of components of symmetric 3 × 3 tensors, in 2D as well: xx, xy, xz, yy, yz, zz, the order of XDMF.
inline constexpr int tensor_components = 6;

/// Largest of some values, and its cell; of equal values the first.
struct LargestOfCells {
  double value = -1.0;
  Index cell = -1;
  LargestOfCells& operator+=(const LargestOfCells& other) {
    if (other.value > value) *this = other;
    return *this;
  }
};

/// Means over each cell of the stress σ = λ tr ε I + 2μ ε and of ½ σ : ε, by the quadrature of the stiffness: the sum
/// of the energy densities times the volumes of the cells is ½UᵀKU. In 2D σ_zz is that of plane strain, or zero; in
/// axisymmetric bodies it is the hoop stress. For laws of finite strain the Cauchy stress, and the energy per
/// undeformed volume; with the internal strains of a state both include the viscoelastic branches (elastic_cells.hpp).
class CellStress {
 public:
  /// Keeps a reference.
  explicit CellStress(const Body& body);
  ~CellStress();
  CellStress(CellStress&&) noexcept;

  /// Evaluates all cells, numbered through all blocks. `stress`: 6 per cell; `energy_density`: one.
  void evaluate(const Vector& displacement, std::vector<double>& stress, std::vector<double>& energy_density,
                const Vector& internal = {}) const;
  /// Largest von Mises stress of these means. Does not allocate.
  [[nodiscard]] LargestOfCells largest_von_mises(const Vector& displacement, const Vector& internal = {}) const;

 private:
  template <int d>
  void evaluate_block(std::size_t block, Index first_cell, const Vector& displacement, const Vector& internal,
                      double* stress, double* energy_density) const;

  template <int d>
  [[nodiscard]] LargestOfCells largest_in_block(std::size_t block, Index first_cell, const Vector& displacement,
                                                const Vector& internal) const;

  const Body& body_;
  /// Per block; null for straight simplices of degree 1.
  std::vector<std::unique_ptr<const BlockIntegration>> integrations_;
  std::unique_ptr<const ElasticCells> finite_;  ///< null if all laws are linear
};

/// √(3/2 s : s) with the deviator s.
[[nodiscard]] double von_mises_stress(const double* stress);
/// Eigenvalues, largest first.
[[nodiscard]] std::array<double, 3> principal_stresses(const double* stress);

/// Volume of every cell (area in 2D, volume of the ring in axisymmetric bodies), numbered through all blocks.
[[nodiscard]] Vector cell_volumes(const Body& body);

}  // namespace ricochet
