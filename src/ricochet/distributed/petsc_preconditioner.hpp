#pragma once

#include "ricochet/linear_algebra/preconditioner_factory.hpp"

/// @file Preconditioners by PETSc: algebraic multigrid and factorization of the whole body.
namespace ricochet {

/// Preconditioners with PreconditionerType::petsc_options; they know the rigid motions of the nodes. Options of the
/// user with the prefix "ricochet_" (in PETSC_OPTIONS) take precedence. Collective over all processes of the world.
[[nodiscard]] std::shared_ptr<const PreconditionerFactory> make_petsc_preconditioners();

}  // namespace ricochet
