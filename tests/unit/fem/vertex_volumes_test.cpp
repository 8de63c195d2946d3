#include "ricochet/fem/vertex_volumes.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/log.hpp"
#include "support/case_run.hpp"
#include "support/pair_rows.hpp"
#include "support/two_bodies.hpp"

namespace ricochet::test_support {
namespace {

/// Squares of one cell of degree 2.
std::string squares(const std::string& displacement) {
  const Mesh mesh = make_stack({.lower_shape = CellShape::quadrilateral,
                                .upper_shape = CellShape::quadrilateral,
                                .lower_counts = {1, 1},
                                .upper_counts = {1, 1},
                                .upper_map = affine_map(Matrix::Identity(2, 2), Vector::Unit(2, 1) * 5.0)});
  return "[mesh]\nfile = \"" + write_mesh("vertex-volumes.msh", mesh) +
         "\"\ndegree = 2\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nyoung = 1.0\npoisson = 0.3\nlaw = "
         "\"neo-hookean\"\n[mass]\ntype = \"consistent\"\n[initial]\ndisplacement = [\"" +
         displacement + "\", \"0\"]\n[time]\nscheme = \"hht-alpha\"\nstep = 1e-6\nend = 1e-6\n";
}

TEST(VertexVolumes, AreThoseOfAStretchThatVaries) {
  const CaseRun run(squares("0.3*x+0.1*x^2"));
  const VertexVolumes volumes(run.model().body);
  EXPECT_EQ(volumes.smallest(run.state().displacement).cell, -1);
  const VertexVolumes::Smallest found = volumes.smallest(Vector(-run.state().displacement));
  EXPECT_NEAR(found.ratio, 1.0 - 0.3 - 0.2, 1e-14);
  EXPECT_GE(found.cell, 0);
}

}  // namespace
}  // namespace ricochet::test_support
