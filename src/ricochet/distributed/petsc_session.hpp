#pragma once

#include <string>

/// @file Initialization of PETSc, unless it is already initialized.
namespace ricochet {

/// Initializes PETSc for its own lifetime. MPI must be initialized.
class PetscSession {
 public:
  PetscSession();
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;

 private:
  bool began_ = false;
};

/// Returns PETSc's message for an error code.
[[nodiscard]] std::string petsc_message(int code);

}  // namespace ricochet
