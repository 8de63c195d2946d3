#pragma once

#include <string>

/// @file PETSc, where nobody has begun it.
namespace ricochet {

/// Begins PETSc for as long as it lives. MPI is there.
class PetscSession {
 public:
  PetscSession();
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;

 private:
  bool began_ = false;
};

/// What PETSc calls an error of this number.
[[nodiscard]] std::string petsc_message(int code);

}  // namespace ricochet
