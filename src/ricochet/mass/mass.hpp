#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/registry.hpp"
#include "ricochet/base/types.hpp"

/// @file Mass matrices. All act on one scalar per node (M = m ⊗ I). To add one: a file with a class and its
/// registration, and one line in mass.cpp.
namespace ricochet {

class CellMasses;

/// Mass selected by an automatic mass type.
struct MassChoice {
  std::string name;
  std::string reason;                ///< empty if the dimension alone decides, or if there was no choice
  std::optional<SparseMatrix> mass;  ///< if building it was part of the choice
  Parameters parameters = {};        ///< values of its keys
};

/// Input of a mass construction.
struct MassInput {
  const SparseMatrix* consistent = nullptr;  ///< ∫ρ φ_i φ_j, nodes × nodes; or ∫aρ φ_i φ_j, damping with rates a ≥ 0
  const Points* nodes = nullptr;             ///< positions, d × nodes
  std::vector<Index> contact_nodes;  ///< ascending, unique
  /// ∫ρ φ_i φ_j if `consistent` is damping, which may vanish in places; null: `consistent` itself.
  const SparseMatrix* inertia = nullptr;
  /// Cells whose matrices sum to `consistent`; null if no construction works cell by cell.
  const CellMasses* cells = nullptr;

  [[nodiscard]] const SparseMatrix& inertia_matrix() const { return inertia != nullptr ? *inertia : *consistent; }
  /// Per node: 1 for contact nodes, 0 for massive nodes, those off the contact boundary.
  [[nodiscard]] std::vector<char> marked_contact_nodes() const;
  /// Throws Error(invalid_input) in the name of a mass type if `cells` is null.
  void require_cells(const std::string& name) const;
};

/// Method of distributing the mass of a body over its nodes.
struct MassType {
  /// Returns the scalar mass matrix, nodes × nodes, exactly symmetric. With `removes_contact_inertia` the rows and
  /// columns of the contact nodes are zero (not stored). Throws Error(invalid_input) with the obstacle, its location
  /// and an alternative.
  std::function<SparseMatrix(const MassInput& input, const Parameters& values)> build;
  /// Whether contact nodes have no inertia: the equivalent masses of section 5 of the source.
  bool removes_contact_inertia = false;
  /// Returns the mass type that this one selects, based on the inertia, so that damping uses the same; null unless the
  /// type is automatic.
  std::function<MassChoice(const MassInput& input)> choose = nullptr;
};
using MassRegistration = Registration<MassType>;

/// Registry of all masses. A program may add its own.
[[nodiscard]] Registry<MassType>& mass_registry();
[[nodiscard]] inline std::vector<std::string> mass_names() { return mass_registry().names(); }
/// Builds a mass by its name in case files, with the values of its keys; throws Error(invalid_input) that lists the
/// names, and as MassType::build does.
[[nodiscard]] SparseMatrix build_mass(const std::string& name, const MassInput& input, Parameters values = {});
/// Mass to be built for the requested type, with the values of its keys.
[[nodiscard]] MassChoice mass_to_build(const std::string& requested, const Parameters& parameters,
                                       const MassInput& input);

/// Diagonal mass: the row sums if all are positive (degree 1: total mass and centre of gravity are preserved), else the
/// diagonal of the consistent mass scaled to the same total.
[[nodiscard]] Vector lumped_diagonal(const SparseMatrix& consistent);

/// Returns whether the block without the given nodes is positive definite, as proved by a factorization.
[[nodiscard]] bool is_positive_definite(const SparseMatrix& mass, const std::vector<Index>& excluded_nodes);

}  // namespace ricochet
