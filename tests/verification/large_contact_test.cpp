#include <gtest/gtest.h>

#include "ricochet/mass/mass.hpp"
#include "ricochet/solver/delassus/delassus_columns.hpp"
#include "ricochet/solver/delassus/direct_stage.hpp"
#include "ricochet/solver/stage/stage_operator.hpp"
#include "ricochet/solver/step_estimate.hpp"
#include "support/case_run.hpp"

// A whole skin as contact boundary must not cost more than a small part of it: the counted quantities do not depend on
// the machine.

namespace ricochet::test_support::large_contact_test {

/// A ball of degree 2: "skin" is its whole surface, "cap" the part near its lowest point.
std::string ball_case(const std::string& group) {
  const std::string geometry =
      "cap = Pi/6; Sphere(1)={0,0,1.01,1,-Pi/2,-Pi/2+cap}; Sphere(2)={0,0,1.01,1,-Pi/2+cap,Pi/2}; Coherence; "
      "Physical Volume(\"ball\")={1,2}; Physical Surface(\"cap\")={1}; Physical Surface(\"skin\")={1,3};";
  return "[mesh]\nfile = \"" + mesh_geometry("large_contact", geometry, 0.3, 2) +
         "\"\ndegree = 2\n[[material]]\ngroup = \"ball\"\ndensity = 1000.0\nyoung = 1.0e7\npoisson = 0.3\n"
         "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n"
         "[[contact]]\ngroup = \"" +
         group +
         "\"\nobstacle = \"floor\"\nfriction = 0.3\n[initial]\nvelocity = [0.5, 0.0, -1.0]\n"
         "[time]\nscheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = 1.0e-3\nend = 0.02\n";
}

double matrix_share(const CaseRun& run, const CaseRun& of) {
  return double(run.problem().mass.to_sparse().nonZeros()) / double(of.problem().mass.to_sparse().nonZeros());
}

TEST(LargeContact, AWholeSkinMakesNoLargerFactorThanACap) {
  const CaseRun consistent(ball_case("cap"), {"mass.type=consistent"}), cap(ball_case("cap")), skin(ball_case("skin")),
      wide(ball_case("skin"), {"mass.type=equivalent-nodewise"});
  ASSERT_GT(skin.problem().contact.size(), 5 * cap.problem().contact.size());
  EXPECT_LE(matrix_share(skin, consistent), 1.0);
  EXPECT_GE(matrix_share(wide, consistent), 2.0) << "the mesh is too small to tell";
}

TEST(LargeContact, TheFactorOfAWholeSkinIsThatOfTheConsistentMass) {
  CaseRun consistent(ball_case("skin"), {"mass.type=consistent"}), skin(ball_case("skin")),
      compact(ball_case("skin"), {"mass.type=equivalent-compact"});
  EXPECT_EQ(skin.simulation().factor_entries(), consistent.simulation().factor_entries()) << "one pattern";
  EXPECT_LE(double(compact.simulation().factor_entries()), 1.1 * double(consistent.simulation().factor_entries()));
}

/// The estimate from the symbolic analysis, compared with the computed factor and columns.
TEST(LargeContact, EstimatesAreWhatIsMade) {
  CaseRun run(ball_case("skin"));
  const std::vector<OperatorCoefficients> operators = run.scheme().operators(run.problem());
  const std::vector<StageEstimate> estimates = estimate_step_solver(run.problem(), operators);
  ASSERT_EQ(estimates.size(), operators.size());
  ASSERT_EQ(estimates[0].chosen.method, SolverMethod::direct);
  EXPECT_EQ(estimates[0].factor_bytes, 8.0 * double(run.simulation().factor_entries()));
  EXPECT_GE(estimates[0].peak_bytes, estimates[0].factor_bytes);

  AnalysedOperator analysed = analyse_operator(run.problem(), operators[0]);
  analysed.factor.factorize();
  DelassusColumns columns(analysed.factor);
  const std::vector<int> number = number_dofs(run.problem(), analysed.dofs);
  std::vector<Eigen::Triplet<double>> entries;
  const Index points = 40, rows = 3;
  const ContactBoundary& contact = run.problem().contact;
  const auto add = [&](const SparseRowMatrix& from, Index row, Index column) {
    for (SparseRowMatrix::InnerIterator entry(from, row); entry; ++entry)
      entries.emplace_back(number[std::size_t(entry.col())], int(column), entry.value());
  };
  for (Index k = 0; k < points; ++k) {
    const Index point = k * contact.size() / points;
    add(contact.rows->gap_operator, point, rows * k);
    add(contact.rows->tangential_trace, 2 * point, rows * k + 1);
    add(contact.rows->tangential_trace, 2 * point + 1, rows * k + 2);
  }
  SparseMatrix transposed(static_cast<Index>(analysed.dofs.size()), rows * points);
  transposed.setFromTriplets(entries.begin(), entries.end());
  Matrix w;
  columns.append(transposed, w);
  const double made = 8.0 * double(columns.entries()) / double(points);
  EXPECT_GE(estimates[0].bytes_per_point, 0.4 * made);  // adjacent columns share the union of their paths
  EXPECT_LE(estimates[0].bytes_per_point, 1.1 * made);
}

}  // namespace ricochet::test_support::large_contact_test
