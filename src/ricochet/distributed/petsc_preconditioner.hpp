#pragma once

#include "ricochet/linear_algebra/preconditioner_maker.hpp"

/// @file Algebraic multigrid and a factor of the whole body, by PETSc.
namespace ricochet {

/// "gamg": PETSc's smoothed aggregation, with the rigid motions of the nodes. "boomeramg": hypre's. "mumps": a Cholesky
/// factor by MUMPS. Options of PETSc with the prefix "ricochet_" (in PETSC_OPTIONS) change them. All processes of the
/// world take part.
[[nodiscard]] std::shared_ptr<const PreconditionerMaker> make_petsc_preconditioners();

}  // namespace ricochet
