#pragma once

#include "ricochet/linear_algebra/preconditioner_factory.hpp"

/// @file Algebraic multigrid and factorization of the whole body, by PETSc.
namespace ricochet {

/// "gamg": PETSc's smoothed aggregation, with the rigid motions of the nodes. "boomeramg": hypre's BoomerAMG. "mumps":
/// a Cholesky factor by MUMPS. Options of PETSc with the prefix "ricochet_" (in PETSC_OPTIONS) change them. Collective
/// over all processes of the world.
[[nodiscard]] std::shared_ptr<const PreconditionerFactory> make_petsc_preconditioners();

}  // namespace ricochet
