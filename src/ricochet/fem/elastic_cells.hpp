#pragma once

#include <initializer_list>
#include <memory>
#include <vector>

#include "ricochet/fem/node_graph.hpp"
#include "ricochet/fem/strain_path.hpp"
#include "ricochet/fem/stress.hpp"

/// @file Elastic energy of a body, W(U) = Σ over cells ∫ W(E) over the undeformed cell, and its derivatives, for every
/// material law:
///   force     F_a = ∫ F S ∇φ_a          (F = I + H, H the displacement gradient; for the linear law F = I)
///   tangent   K_ab = ∫ B_aᵀ (∂S/∂E) B_b + (∇φ_a · S ∇φ_b) I,   B_a the derivative of E by the displacement of node a.
/// In cells with mean dilatation, the part U(J) of the energy is evaluated at a projection Θ of J onto the
/// functions that are constant over the cell (for quadrilaterals and hexahedra of degree 2: linear), which does
/// not lock as the material becomes incompressible (J. C. Simo, R. L. Taylor, K. S. Pister, Comput. Methods
/// Appl. Mech. Engrg. 51 (1985) 177–208): in all formulas the projection of U′(Θ) replaces U′(J). The force
/// remains the derivative of the energy.
///
/// The quadrature is that of the stiffness, so that small displacements produce the forces of the linear body.
namespace ricochet {

/// Smallest volume ratio at the points of some cells: not positive where a cell is inverted, −∞ where the thickness of
/// a plate is undefined.
struct CellVolume {
  Index cell = -1;  ///< numbered through all blocks; −1 if none
  double volume_ratio = 1.0;
};

/// Input of the viscoelastic branches for a step (relaxation.hpp). Displacements are per dof.
struct BranchStep {
  const Vector& middle;     ///< at which forces act over the step
  const Vector& increment;  ///< u₁ − u⁺, from which Ē follows as in path_force()
  const Vector& start;      ///< u₀
  const Vector& end;        ///< u₁
  const Vector& internal;   ///< A at the start
  double step;              ///< h
};

enum class BranchStress;

/// Points at which the energy of a cell is evaluated: those of the quadrature of the stiffness, or close to its nodes.
enum class CellPoints { quadrature, nodes };

class ElasticCells {
 public:
  /// Keeps references. Without a graph only energies of the laws are available: no force, no tangent, no branch.
  explicit ElasticCells(const Body& body, const NodeGraph* graph = nullptr);
  /// Restricts the sums to some cells, ascending, which must be those of the graph.
  ElasticCells(const Body& body, const NodeGraph* graph, std::vector<int> cells,
               CellPoints points = CellPoints::quadrature);
  ~ElasticCells();
  ElasticCells(const ElasticCells&) = delete;
  ElasticCells& operator=(const ElasticCells&) = delete;

  /// Returns the smallest ratio of all cells, if it is below 1.
  [[nodiscard]] CellVolume smallest_volume(const Vector& displacement) const;
  /// Computes the force per dof. If a cell is inverted the force is meaningless; that cell is returned.
  [[nodiscard]] CellVolume force(const Vector& displacement, Vector& result) const;
  /// Computes the forces at a displacement `middle` of the mean stress S̄ along the path of the strain from that of
  /// `middle` − ½ `increment` to that of `middle` + ½ `increment` (strain_path.hpp): their work on the increment is the
  /// change of the energy up to the error of the rule, and a rigid motion has none.
  [[nodiscard]] CellVolume path_force(const Vector& middle, const Vector& increment, const PathRules& rules,
                                      Vector& result) const;
  /// Returns a ∂D/∂x + b ∂D/∂Δ̂ of the force D(x, Δ̂) of path_force(), with x = `middle`, Δ̂ = `increment`, and a and b
  /// of the `variation`: in general not symmetric, on the pattern of the graph. At Δ̂ = 0 it is a times the tangent.
  /// (cell_path_kernel.hpp has the formulas.) It is assembled cell by cell, which takes 1.3 to 2.7 times as long as
  /// tangent() with two or three points, and up to 6 times with five. For solvers with the exact tangent; meaningless
  /// if a cell is inverted.
  [[nodiscard]] SparseMatrix path_tangent(const Vector& middle, const Vector& increment, const PathRules& rules,
                                          const PathVariation& variation) const;
  /// Includes the derivative of mean_branch_force(), with u₁ = x + ½ Δ̂ in place of the `end` of the step.
  [[nodiscard]] SparseMatrix path_tangent(const BranchStep& step, const PathRules& rules,
                                          const PathVariation& variation) const;
  /// Raises the rules of the cells whose strain changes more than their rule is for. Returns whether any was raised.
  bool raise_path_rules(const Vector& middle, const Vector& increment, PathRules& rules) const;
  [[nodiscard]] double energy(const Vector& displacement) const;
  /// Number of components of nodes at quadrature points: Σ over cells points × nodes × dimension.
  [[nodiscard]] double size() const;
  /// Tangent, exactly symmetric, on the pattern of the graph. An empty displacement is zero. With a `step` it includes
  /// the tangent of the branches over a step of this length, at zero stress of theirs.
  [[nodiscard]] SparseMatrix tangent(const Vector& displacement, double step = 0.0) const;
  /// Computes means over one cell of the Cauchy stress (weighted by the undeformed volume) and of the energy
  /// per undeformed volume, including those of branches. `stress`: 6, in the order of XDMF. `internal`:
  /// empty if no branch has stress.
  void cell_stress(std::size_t block, Index local, Index cell, const Vector& displacement, const Vector& internal,
                   double* stress, double& energy_density) const;
  /// Computes the mean over one cell of Green's strain, weighted by the undeformed volume, with the strain normal to
  /// the plane under plane stress and the hoop strain of axisymmetric bodies. `strain`: 6, in the order of XDMF.
  void cell_strain(std::size_t block, Index local, Index cell, const Vector& displacement, double* strain) const;

  // Viscoelastic branches of the materials, relaxation.hpp (elastic_cells_branches.cpp): their contribution to energy
  // and forces. The internal strains are one vector for the whole body, even if these are only some of its cells: six
  // numbers, xx, yy, zz, xy, yz, zx, per branch of each quadrature point.
  [[nodiscard]] Index internal_size() const { return internal_begin_.empty() ? 0 : internal_begin_.back(); }
  /// Sets A = dev E: no branch has stress.
  void relax(const Vector& displacement, Vector& internal) const;
  /// Energy of the branches at an instant.
  [[nodiscard]] double branch_energy(const Vector& displacement, const Vector& internal) const;
  /// Computes the force of q̄, at the middle.
  void mean_branch_force(const BranchStep& step, Vector& result) const;
  /// Computes the force of q₁, at the end.
  void end_branch_force(const BranchStep& step, Vector& result) const;
  /// Integral of the potential RelaxationRule::start_energy() at a displacement.
  [[nodiscard]] double start_branch_energy(const BranchStep& step, const Vector& displacement) const;
  /// Computes A₁; returns the energy that the step dissipates, ≥ 0.
  [[nodiscard]] double advance_internal(const BranchStep& step, Vector& internal) const;

 private:
  template <int d>
  struct Blocks;
  template <int d>
  [[nodiscard]] const Blocks<d>& blocks() const;
  template <int d>
  class CellStrips;
  template <int d>
  class StripWork;
  template <int d>
  class PathWork;
  template <int d>
  class BranchStrips;
  template <int d, template <int> class Strips, class Work>
  void for_each_part(const Work& work) const;
  struct PackNumbers;
  struct PackInput;
  struct PackSum;
  struct PackPart;
  template <template <int> class Strips, class Work>
  CellVolume visit_strips(std::initializer_list<PackInput> inputs, std::initializer_list<PackSum> sums,
                          const Work& work) const;
  [[nodiscard]] SparseMatrix assemble_path_tangent(const Vector& middle, const Vector& increment,
                                                   const PathRules& rules, const PathVariation& variation,
                                                   const BranchStep* step) const;
  void find_internal_offsets();
  struct BranchDisplacements;
  template <class Find>
  void visit_branches(const BranchDisplacements& displacements, const Find& find, Vector* forces) const;
  void add_up_branches(BranchStress of, const BranchDisplacements& displacements, Vector& result) const;
  template <class Find>
  double sum_branches(const BranchDisplacements& displacements, const Find& find) const;

  const Body& body_;
  const NodeGraph* graph_;
  std::vector<int> cells_;             ///< empty: all
  std::vector<Index> internal_begin_;  ///< per cell, and the end; empty if there are no branches
  std::unique_ptr<Blocks<2>> plane_;
  std::unique_ptr<Blocks<3>> solid_;
};

}  // namespace ricochet
