#include <gtest/gtest.h>

#include "ricochet/base/error.hpp"
#include "ricochet/step/stage_solve.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"

/// @file Message of a step that fails because an iteration has inverted a cell.
namespace ricochet::test_support::inverted_cells_test {

/// Contact nodes move so far into the body that they invert cells; a stage of the whole body then cannot be solved and
/// reports why.
class LostStages final : public StageSolve {
 public:
  LostStages(const SemidiscreteProblem& problem, double shift) : stages_(2), solution_(2) {
    for (Stage& stage : stages_) stage.rows = problem.contact.rows;
    solution_[0].increment.setZero(problem.dof_count());
    for (const Index dof : problem.contact_dofs) {
      if (dof % problem.dimension == 1) solution_[0].increment[dof] = shift;
    }
  }
  Stage& stage(std::size_t number) override { return stages_.at(number); }
  const StageSolution& solve(std::size_t number) override {
    if (number == 1) throw Error(ErrorKind::not_converged, "W has non-finite entries");
    return solution_[0];
  }
  [[nodiscard]] double newton_tolerance() const override { return 1e-9; }
  [[nodiscard]] double renewal_price() const override { return 10.0; }
  void rotate_operators(const Vector&) override {}
  void renew_operators(const Vector&, const Vector&) override {}

 private:
  std::vector<Stage> stages_;
  std::vector<StageSolution> solution_;
};

std::string message_of_step(CaseRun& run, double shift) {
  LostStages stages(run.problem(), shift);
  State state = run.state();
  Vector increment;
  return message_of([&] { run.scheme().advance(run.problem(), state, stages, increment); }, ErrorKind::not_converged);
}

TEST(InvertedCells, AreNamedWhereTheContactProblemFailsForThem) {
  const std::string mesh = mesh_geometry("inverted-cells",
                                         "Rectangle(1) = {0, 0, 0, 1, 0.5};\nPhysical Surface(\"body\") = {1};\n"
                                         "Physical Curve(\"bottom\") = {1};\n",
                                         0.125, 1);
  CaseRun run(
      "[mesh]\nfile = \"" + mesh +
      "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\nlaw = \"neo-hookean\"\n"
      "[obstacle.floor]\ntype = \"plane\"\npoint = [0, -0.01]\nnormal = [0, 1]\n[[contact]]\ngroup = \"bottom\"\n"
      "obstacle = \"floor\"\n[initial]\nvelocity = [0, -1]\n[time]\nstep = 1e-3\nend = 0.01\n");
  // Cells at the bottom are about 0.11 high.
  const std::string inverted = message_of_step(run, 0.2);
  EXPECT_TRUE(has(inverted, "cell "));
  EXPECT_TRUE(has(inverted, "is inverted"));
  EXPECT_EQ(message_of_step(run, 0.01), "W has non-finite entries");
}

}  // namespace ricochet::test_support::inverted_cells_test
