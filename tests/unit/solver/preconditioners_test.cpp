#include <gtest/gtest.h>

#include "ricochet/base/error.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/linear_algebra/preconditioner_factory.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Preconditioners by name, those of the library and one of a user's program.
namespace ricochet {
namespace {

long diagonals_made = 0;

/// P = the diagonal of A.
class Diagonal final : public Preconditioner {
 public:
  Diagonal(const SparseMatrix& part, const std::vector<char>& solved) : inverse_(part.diagonal().cwiseInverse()) {
    for (std::size_t dof = 0; dof < solved.size(); ++dof) {
      if (solved[dof] == 0) inverse_[Index(dof)] = 1.0;
    }
    ++diagonals_made;
  }
  void apply(const Vector& r, Vector& z) const override { z = inverse_.cwiseProduct(r); }

 private:
  Vector inverse_;
};

std::unique_ptr<Preconditioner> make_diagonal(const SparseMatrix& part, const std::vector<char>& solved,
                                              const Points& /*nodes*/, const Ranks& /*ranks*/) {
  return std::make_unique<Diagonal>(part, solved);
}

class OutsidePreconditioner : public ::testing::Test {
 protected:
  void SetUp() override { preconditioner_registry().add({"diagonal", {.make = make_diagonal}}); }
  void TearDown() override { preconditioner_registry().remove("diagonal"); }
};

Vector end_of_run(const std::string& text, const std::string& preconditioner) {
  test_support::CaseRun run(text, {"solver.method=iterative", "solver.tolerance=1e-12", "time.end=0.2",
                                   "solver.preconditioner=" + preconditioner});
  run.run([] {});
  return run.state().displacement;
}

TEST_F(OutsidePreconditioner, SolvesTheSteps) {
  const std::string text =
      test_support::thrown_case(test_support::thrown_bodies().front(), "equivalent", "scheme = \"reduced-kane\"\n");
  const Vector blocks = end_of_run(text, "block-jacobi");
  EXPECT_EQ(diagonals_made, 0);
  const Vector diagonal = end_of_run(text, "diagonal");
  EXPECT_GT(diagonals_made, 0);
  EXPECT_GT(blocks.lpNorm<Eigen::Infinity>(), 0.0);
  EXPECT_LE((diagonal - blocks).lpNorm<Eigen::Infinity>(), 1e-8 * blocks.lpNorm<Eigen::Infinity>());
}

TEST_F(OutsidePreconditioner, IsInTheSchema) { EXPECT_NE(case_schema().find("\"diagonal\""), std::string::npos); }

TEST(Preconditioners, AreMadeInOneWay) {
  EXPECT_TRUE(preconditioner_registry().all().front().type.is_block_diagonal);
  int fallbacks = 0;
  for (const Registration<PreconditionerType>& entry : preconditioner_registry().all()) {
    const PreconditionerType& type = entry.type;
    EXPECT_EQ(int{type.is_block_diagonal} + int{type.make != nullptr} + int{!type.petsc_options.empty()}, 1)
        << entry.name;
    fallbacks += int{type.is_fallback};
  }
  EXPECT_EQ(fallbacks, 1);
}

TEST(Preconditioners, OfPetscAreRefusedWithoutIt) {
  const std::string text =
      test_support::thrown_case(test_support::thrown_bodies().front(), "equivalent", "scheme = \"reduced-kane\"\n");
  for (const Registration<PreconditionerType>& entry : preconditioner_registry().all()) {
    if (entry.type.petsc_options.empty()) continue;
    try {
      static_cast<void>(end_of_run(text, entry.name));
      ADD_FAILURE() << entry.name;
    } catch (const Error& problem) {
      EXPECT_NE(std::string(problem.what()).find("\"" + entry.name + "\" is available in `ricochet-mpi` only"),
                std::string::npos)
          << problem.what();
    }
  }
}

TEST(Preconditioners, OfPetscAreRefusedByTheFactoryToo) {
  EXPECT_THROW(static_cast<void>(make_named_preconditioner(fallback_preconditioner(), {}, {}, {}, one_rank(), nullptr)),
               Error);
}

}  // namespace
}  // namespace ricochet
