#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/registry.hpp"
#include "ricochet/base/types.hpp"

/// @file Mass matrices. All act on one scalar per node (M = m ⊗ I). To add one: a file with a class and its
/// registration, and one line in mass.cpp.
namespace ricochet {

class CellMasses;

/// The mass that is built for one that chooses.
struct MassChoice {
  std::string name;
  std::string reason;                ///< empty where it goes by the dimension alone, or nothing was to choose
  std::optional<SparseMatrix> mass;  ///< where it had to be built for the choice
  Parameters parameters = {};        ///< the values of its keys
};

/// What a mass is built from.
struct MassInput {
  const SparseMatrix* consistent = nullptr;  ///< ∫ρ φ_i φ_j, nodes × nodes; or ∫aρ φ_i φ_j, damping with rates a ≥ 0
  const Points* nodes = nullptr;             ///< positions, d × nodes
  std::vector<Index> contact_nodes;  ///< ascending, each once
  /// ∫ρ φ_i φ_j when `consistent` is damping, which may vanish somewhere; null: the same.
  const SparseMatrix* inertia = nullptr;
  /// The cells that `consistent` is the sum of; null where nobody works cell by cell.
  const CellMasses* cells = nullptr;

  [[nodiscard]] const SparseMatrix& inertia_matrix() const { return inertia != nullptr ? *inertia : *consistent; }
  /// Per node: 1 for contact nodes, 0 for free ones.
  [[nodiscard]] std::vector<char> marked_contact_nodes() const;
  /// Throws Error(invalid_input) without `cells`, on behalf of the mass of this name.
  void require_cells(const std::string& name) const;
};

/// A way to distribute the mass of a body over its nodes.
class MassConstruction {
 public:
  virtual ~MassConstruction() = default;
  /// The scalar mass matrix, nodes × nodes, exactly symmetric. With removes_contact_inertia() the rows and columns of
  /// the contact nodes are zero (not stored). Throws Error(invalid_input) which says what stands in the way, where, and
  /// what to use instead.
  [[nodiscard]] virtual SparseMatrix build(const MassInput& input) const = 0;
  /// True when contact nodes get no inertia: the equivalent masses of the source's section 5.
  [[nodiscard]] virtual bool removes_contact_inertia() const { return false; }
  /// The mass that this one is built as, if it is one that chooses: by the inertia, so that damping has the same.
  [[nodiscard]] virtual std::optional<MassChoice> choose(const MassInput&) const { return {}; }
};

using MassConstructor = std::function<std::unique_ptr<MassConstruction>(const Parameters& parameters)>;
using MassRegistration = Registration<MassConstructor>;

/// All masses. A program of one's own may add to them.
[[nodiscard]] Registry<MassConstructor>& mass_registry();
[[nodiscard]] inline std::vector<std::string> mass_names() {
  return mass_registry().names();
}
/// By the name used in a case file, with the values of its keys; throws Error(invalid_input) that lists the names.
[[nodiscard]] std::unique_ptr<MassConstruction> make_mass(const std::string& name, Parameters parameters = {});
/// The mass that is built for the one asked for, with the values of its keys.
[[nodiscard]] MassChoice mass_to_build(const std::string& asked, const Parameters& parameters, const MassInput& input);

/// A diagonal mass: row sums where they are all positive (degree 1: total mass and centre of gravity are kept), else
/// the diagonal of the consistent mass, scaled to keep the total.
[[nodiscard]] Vector lumped_diagonal(const SparseMatrix& consistent);

/// Proof by factorization that the block of the given nodes (all when empty) is positive definite.
[[nodiscard]] bool is_positive_definite(const SparseMatrix& mass, const std::vector<Index>& excluded_nodes);

}  // namespace ricochet
