#include "ricochet/distributed/petsc_session.hpp"

#include <petscsys.h>

namespace ricochet {

PetscSession::PetscSession() {
  PetscBool is_begun = PETSC_FALSE;
  PetscInitialized(&is_begun);
  if (is_begun != PETSC_FALSE) return;
  // The program itself handles signals and messages.
  PetscOptionsSetValue(nullptr, "-no_signal_handler", "");
  began_ = PetscInitializeNoArguments() == 0;
  if (began_) PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr);
}

PetscSession::~PetscSession() {
  if (began_) PetscFinalize();
}

std::string petsc_message(int code) {
  const char* text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  return text != nullptr ? text : "an unnamed error";
}

}  // namespace ricochet
