#include <gtest/gtest.h>

#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

// The ways to solve a step, compared on the same cases: a factor of the whole body with the possible contact points,
// the same with all contact points, and conjugate gradients around a patch. They must agree.

namespace ricochet::test_support::step_solvers_test {

struct Variant {
  std::string name, time, mass, contact;
  bool smooth;  ///< does not amplify rounding when a contact opens
};

std::vector<Variant> variants() {
  const std::string trapezoidal = "scheme = \"newmark\"\npreset = \"trapezoidal\"\n";
  return {
      {"NewmarkEquivalent", trapezoidal, "equivalent", "", true},
      {"NewmarkEquivalentFriction", trapezoidal, "equivalent", "friction = 0.3\n", true},
      {"NewmarkConsistent", trapezoidal, "consistent", "", false},
      {"KlrConserving", "scheme = \"klr-conserving\"\n", "consistent", "friction = 0.3\n", false},
      {"Midpoint", "scheme = \"midpoint\"\n", "lumped", "", false},
      {"ReducedKane", "scheme = \"reduced-kane\"\nreaction_weight = \"end\"\n", "equivalent", "friction = 0.3\n", true},
      {"ReducedKaneAdaptive", "scheme = \"reduced-kane\"\n", "equivalent", "", true},
      {"MeanReaction", "scheme = \"mean-reaction\"\n", "equivalent", "", true},
      {"ReducedMidpoint", "scheme = \"reduced-midpoint\"\n", "equivalent", "", true}};
}

struct Frame {
  Vector displacement, normal, tangential, supports;
};

std::vector<Frame> frames(const std::string& text, const std::vector<std::string>& overrides, SolverMethod method) {
  CaseRun run(text, overrides);
  EXPECT_EQ(run.simulation().methods().back().method, method);
  std::vector<Frame> result;
  run.run([&] {
    const State& state = run.state();
    result.push_back({state.displacement, state.forces.normal_reaction, state.forces.tangential_reaction,
                      state.forces.support_reaction});
  });
  return result;
}

/// Frames before the first reopening of a contact; all of them for smooth schemes.
std::size_t comparable(const std::vector<Frame>& all, bool smooth) {
  for (std::size_t k = 1; k < all.size() && !smooth; ++k) {
    if (((all[k - 1].normal.array() > 0.0) && !(all[k].normal.array() > 0.0)).any()) return k;
  }
  return all.size();
}

/// Largest differences relative to the largest of each in the run.
void expect_agreement(const std::vector<Frame>& expected, const std::vector<Frame>& found, bool smooth,
                      double tolerance) {
  ASSERT_EQ(expected.size(), found.size());
  double u = 0.0, r = 0.0, s = 0.0, u_size = 0.0, r_size = 0.0, s_size = 0.0;
  const std::size_t count = comparable(expected, smooth);
  EXPECT_GT(count, 3U);
  for (std::size_t k = 0; k < count; ++k) {
    u_size = std::max(u_size, expected[k].displacement.lpNorm<Eigen::Infinity>());
    r_size = std::max(r_size, expected[k].normal.lpNorm<Eigen::Infinity>());
    u = std::max(u, (expected[k].displacement - found[k].displacement).lpNorm<Eigen::Infinity>());
    r = std::max(r, (expected[k].normal - found[k].normal).lpNorm<Eigen::Infinity>());
    if (expected[k].tangential.size() > 0)
      r = std::max(r, (expected[k].tangential - found[k].tangential).lpNorm<Eigen::Infinity>());
    if (expected[k].supports.size() > 0) {
      s_size = std::max(s_size, expected[k].supports.lpNorm<Eigen::Infinity>());
      s = std::max(s, (expected[k].supports - found[k].supports).lpNorm<Eigen::Infinity>());
    }
  }
  EXPECT_GT(r_size, 0.0) << "no contact";
  EXPECT_LE(u, tolerance * u_size);
  EXPECT_LE(r, tolerance * r_size);
  EXPECT_LE(s, tolerance * s_size);
}

class StepSolvers : public testing::TestWithParam<Variant> {};

TEST_P(StepSolvers, Agree) {
  const Variant& variant = GetParam();
  for (const ThrownBody& body : thrown_bodies()) {
    SCOPED_TRACE(body.name);
    const std::string text = thrown_case(body, variant.mass, variant.time, variant.contact);
    const auto direct = frames(text, {"solver.method=direct"}, SolverMethod::direct);
    const auto all = frames(text, {"solver.method=direct", "solver.contact_points=all"}, SolverMethod::direct);
    expect_agreement(direct, all, variant.smooth, 1e-9);
    // Errors of single steps accumulate over the run.
    const auto iterative = frames(text, {"solver.method=iterative", "solver.tolerance=1e-12"}, SolverMethod::iterative);
    expect_agreement(direct, iterative, variant.smooth, 1e-8);
  }
}

/// At rest, loaded only by the motion of a support; multipliers at the edge of another one press its nodes.
TEST(StepSolversBySupports, Agree) {
  const std::string square =
      "Rectangle(1)={0,0,0,1,1}; Physical Surface(\"body\")={1}; Physical Curve(\"bottom\")={1}; "
      "Physical Curve(\"top\")={3}; Physical Curve(\"left\")={4};";
  for (const std::string time : {"scheme = \"newmark\"\npreset = \"trapezoidal\"\n", "scheme = \"reduced-kane\"\n"}) {
    SCOPED_TRACE(time);
    const std::string text =
        "[mesh]\nfile = \"" + mesh_geometry("supported_square", square, 0.2, 1) +
        "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\n"
        "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"
        "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\nfriction = 0.3\nmultipliers = \"p1\"\n"
        "[[support]]\ngroup = \"left\"\ncomponents = [\"x\"]\n"
        "[[support]]\ngroup = \"top\"\ncomponents = [\"y\"]\nvalue = \"-0.01*t^2\"\n[time]\n" +
        time + "step = 0.01\nend = 0.5\n";
    const auto direct = frames(text, {"solver.method=direct"}, SolverMethod::direct);
    const auto iterative = frames(text, {"solver.method=iterative", "solver.tolerance=1e-12"}, SolverMethod::iterative);
    expect_agreement(direct, iterative, true, 1e-8);
  }
}

/// A static start has no inertia to help an iteration: held by contact alone, it uses a factor if that fits.
TEST(StepSolversAtRest, Agree) {
  const std::string square =
      "Rectangle(1)={0,0,0,1,1}; Physical Surface(\"body\")={1}; Physical Curve(\"bottom\")={1};";
  const std::string text = "[mesh]\nfile = \"" + mesh_geometry("square", square, 0.2, 1) +
                           "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\n"
                           "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"
                           "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n[load]\ngravity = [0.0, -1.0]\n"
                           "[initial]\ndisplacement = \"static\"\n[time]\nscheme = \"newmark\"\npreset = "
                           "\"trapezoidal\"\nstep = 0.01\nend = 0.2\n";
  const auto direct = frames(text, {"solver.method=direct"}, SolverMethod::direct);
  const auto iterative = frames(text, {"solver.method=iterative", "solver.tolerance=1e-12"}, SolverMethod::iterative);
  expect_agreement(direct, iterative, true, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(All, StepSolvers, testing::ValuesIn(variants()),
                         [](const auto& info) { return info.param.name; });

}  // namespace ricochet::test_support::step_solvers_test
