#include "ricochet/linear_algebra/preconditioner_factory.hpp"

#include <algorithm>

namespace ricochet {

namespace {

std::vector<Registration<PreconditionerType>> preconditioners() {
  std::vector<Registration<PreconditionerType>> all;
  all.push_back({"block-jacobi", {.is_block_diagonal = true}});
  all.push_back({"gamg", {.petsc_options = "-pc_type gamg", .suits_long_steps = true}});
  // The defaults of BoomerAMG for three dimensions take four times as long on elastic bodies.
  all.push_back({"boomeramg",
                 {.petsc_options = "-pc_type hypre -pc_hypre_type boomeramg -pc_hypre_boomeramg_strong_threshold 0.5 "
                                   "-pc_hypre_boomeramg_coarsen_type HMIS -pc_hypre_boomeramg_interp_type ext+i "
                                   "-pc_hypre_boomeramg_P_max 4"}});
  all.push_back({"mumps", {.petsc_options = "-pc_type cholesky -pc_factor_mat_solver_type mumps"}});
  return all;
}

}  // namespace

Registry<PreconditionerType>& preconditioner_registry() {
  static Registry<PreconditionerType> registry("preconditioner", preconditioners());
  return registry;
}

const std::string& preconditioner_of_long_steps() {
  const std::vector<Registration<PreconditionerType>>& all = preconditioner_registry().all();
  return std::find_if(all.begin(), all.end(), [](const auto& entry) { return entry.type.suits_long_steps; })->name;
}

std::unique_ptr<Preconditioner> make_named_preconditioner(const std::string& name, const SparseMatrix& part,
                                                          const std::vector<char>& solved, const Points& nodes,
                                                          const Ranks& ranks, const PreconditionerFactory* petsc) {
  const PreconditionerType& type = preconditioner_registry().find(name).type;
  return type.make != nullptr ? type.make(part, solved, nodes, ranks) : petsc->make(name, part, solved, nodes, ranks);
}

}  // namespace ricochet
