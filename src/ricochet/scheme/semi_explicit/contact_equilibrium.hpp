#pragma once

#include <vector>

#include "ricochet/scheme/contact_stiffness.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/step/stage.hpp"

/// @file Contact nodes without inertia in an explicit step: their equilibrium at the end of it,
///   K_cc u_c + K_ci u_i = L_c + Gᵀ r_N − B_Tᵀ r_T,
/// posed as a stage on the contact dofs. The other nodes have moved by ΔU; contact nodes, at δ = 0, as in the previous
/// step. K U at the end is (K U)_c + K_c ΔU: the increments are small, so no digits are lost to a rigid motion.
namespace ricochet {

class ContactEquilibrium {
 public:
  /// Gathers the rows of K that belong to contact dofs, and the dofs that they couple with.
  void analyse(const SemidiscreteProblem& problem);
  /// Dofs of contact nodes, including supported ones.
  [[nodiscard]] const std::vector<Index>& contact_node_dofs() const { return contact_node_dofs_; }

  /// Fills the stage for the end of the step. `force` is K U at its start, `load` the load at its end, `supported_next`
  /// the prescribed displacements there.
  void require(const SemidiscreteProblem& problem, const State& state, const Vector& force, const Vector& load,
               const Vector& supported_next, double step, Stage& stage);

 private:
  void predict(const SemidiscreteProblem& problem, const State& state, const Vector& supported_next, double step);

  ContactStiffness stiffness_;            ///< K_c
  std::vector<Index> near_dofs_;          ///< dofs with an entry in K_c
  std::vector<Index> contact_node_dofs_;  ///< of contact nodes, including supported ones
  Vector predicted_;                      ///< ΔU on near dofs
  Vector base_, middle_, rate_;           ///< U + ΔU, U + ΔU/2, ΔU/h on contact nodes
  Vector row_force_;
};

}  // namespace ricochet
