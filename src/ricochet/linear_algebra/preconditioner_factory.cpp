#include "ricochet/linear_algebra/preconditioner_factory.hpp"

#include <stdexcept>

#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

std::vector<Registration<PreconditionerType>> preconditioners() {
  std::vector<Registration<PreconditionerType>> all;
  all.push_back({"block-jacobi", {.is_block_diagonal = true}});
  all.push_back({"gamg", {.petsc_options = "-pc_type gamg", .is_fallback = true}});
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

const std::string& fallback_preconditioner() {
  for (const Registration<PreconditionerType>& entry : preconditioner_registry().all()) {
    if (entry.type.is_fallback) return entry.name;
  }
  throw std::logic_error("no preconditioner is registered as the fallback");
}

std::unique_ptr<Preconditioner> make_named_preconditioner(const std::string& name, const SparseMatrix& part,
                                                          const std::vector<char>& solved, const Points& nodes,
                                                          const Ranks& ranks, const PreconditionerFactory* petsc) {
  const PreconditionerType& type = preconditioner_registry().find(name).type;
  if (type.make != nullptr) return type.make(part, solved, nodes, ranks);
  if (petsc == nullptr)
    throw Error(ErrorKind::invalid_input, "preconditioner \"" + name + "\" needs PETSc, which only ricochet-mpi has");
  return petsc->make(name, part, solved, nodes, ranks);
}

}  // namespace ricochet
