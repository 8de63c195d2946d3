#include <gtest/gtest.h>
#include <petscsys.h>

/// @file All ranks run the same tests, and all fail if one does.

int main(int count, char** arguments) {
  ::testing::InitGoogleTest(&count, arguments);
  if (PetscInitialize(&count, &arguments, nullptr, nullptr) != 0) return 1;
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank > 0) {
    // Only one rank reports passed tests.
    auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
  }
  int failed = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  PetscFinalize();
  return failed;
}
