#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/contact/construction/make_contact_boundary.hpp"
#include "ricochet/contact/contact_stress.hpp"
#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "ricochet/simulation/history/momentum_account.hpp"
#include "ricochet/simulation/history/sensor.hpp"
#include "ricochet/simulation/impact/impacts.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"
#include "support/two_bodies.hpp"

/// @file Contact of axisymmetric bodies: uniform pressures, closed balances of energy and momentum under every scheme,
/// and a rod equivalent to a bar.
namespace ricochet::test_support::contact_test {

constexpr double pi = std::numbers::pi;

struct Blocks {
  CellShape lower, upper;
  int geometry_degree, degree;
  std::string multipliers;

  [[nodiscard]] std::string label() const {
    const auto name = [](CellShape shape) { return shape == CellShape::triangle ? "triangles" : "quadrilaterals"; };
    return fmt::format("{}_on_{}_geometry{}_degree{}_{}", name(upper), name(lower), geometry_degree, degree,
                       multipliers);
  }
};

std::vector<Blocks> all_blocks() {
  std::vector<Blocks> result;
  for (const int degree : {1, 2}) {
    for (const char* multipliers : {"p1", "dual"}) {
      result.push_back({CellShape::triangle, CellShape::quadrilateral, 1, degree, multipliers});
      result.push_back({CellShape::quadrilateral, CellShape::triangle, degree, degree, multipliers});
    }
  }
  result.push_back({CellShape::triangle, CellShape::quadrilateral, 1, 2, "p0"});
  return result;
}

class AxisymmetricPressure : public testing::TestWithParam<Blocks> {
 protected:
  static constexpr double pressure = 0.03, lambda = 30.0, mu = 20.0;

  /// One cylinder of radius and height 1 on another one, with non-matching meshes.
  [[nodiscard]] std::string mesh() const {
    const Blocks& given = GetParam();
    StackedBoxes stack;
    stack.lower_shape = given.lower;
    stack.upper_shape = given.upper;
    stack.lower_counts = {4, 3};
    stack.upper_counts = {5, 4};
    stack.geometry_degree = given.geometry_degree;
    return write_mesh("axisymmetric_" + given.label() + ".msh", make_stack(stack));
  }
  [[nodiscard]] std::string head(const std::string& file) const {
    return fmt::format(
        "[mesh]\nfile = \"{}\"\ndegree = {}\nplane = \"axisymmetric\"\n[[material]]\ngroup = \"all\"\n"
        "density = 1.0\nlambda = {}\nmu = {}\n[initial]\ndisplacement = \"static\"\n[time]\nstep = 0.01\nend = 0.01\n"
        "[[traction]]\ngroup = \"upper.y1\"\nvalue = [0.0, {}]\n",
        file, GetParam().degree, lambda, mu, -pressure);
  }
  void expect_uniform(const CaseRun& run, double height) const {
    const ContactBoundary& contact = run.problem().contact;
    const Vector& reaction = run.state().forces.normal_reaction;
    EXPECT_NEAR(reaction.sum(), pressure * pi, 1e-9 * pressure * pi);
    EXPECT_NEAR(contact.weights.sum(), pi, 1e-11);
    const Vector found = contact.pressure_recovery * reaction;
    for (const double value : found) EXPECT_NEAR(value, pressure, 1e-8 * pressure);
    const double young = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), poisson = 0.5 * lambda / (lambda + mu);
    for (Index node = 0; node < run.problem().nodes.cols(); ++node) {
      const auto at = run.problem().nodes.col(node);
      const auto u = run.state().displacement.segment(2 * node, 2);
      EXPECT_NEAR(u[0], poisson * pressure / young * at[0], 1e-8 * pressure / young);
      EXPECT_NEAR(u[1], -pressure / young * (at[1] + height), 1e-8 * pressure / young);
    }
  }
};

TEST_P(AxisymmetricPressure, BetweenBodiesWhoseMeshesDoNotMatch) {
  const CaseRun run(head(mesh()) +
                    fmt::format("[[contact]]\ngroup = \"upper.y0\"\nagainst = \"lower.y1\"\nmultipliers = \"{}\"\n"
                                "[[support]]\ngroup = \"lower.y0\"\ncomponents = [\"y\"]\nvalue = 0.0\n",
                                GetParam().multipliers));
  expect_uniform(run, 0.0);
}

TEST_P(AxisymmetricPressure, OnAPlaneAndThroughATie) {
  const CaseRun run(head(mesh()) +
                    fmt::format("[[contact]]\ngroup = \"upper.y0\"\nagainst = \"lower.y1\"\ntied = true\n"
                                "[[contact]]\ngroup = \"lower.y0\"\nobstacle = \"floor\"\nmultipliers = \"{}\"\n"
                                "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, -0.001]\nnormal = [0.0, 1.0]\n",
                                GetParam().multipliers));
  const double young = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
  expect_uniform(run, 0.001 * young / pressure);
}

INSTANTIATE_TEST_SUITE_P(Blocks, AxisymmetricPressure, testing::ValuesIn(all_blocks()),
                         [](const auto& info) { return info.param.label(); });

/// Section of a cylinder in contact with a plane below.
struct Side {
  std::unique_ptr<MeshedBody> test;
  std::unique_ptr<Obstacle> obstacle;
  ContactBoundary boundary;
  Eigen::Vector2d normal = Eigen::Vector2d(0.2, 1.0).normalized();  ///< normal of the obstacle, a cone

  Side(const ElementKind& kind, const std::string& multipliers) {
    test = make_meshed_body(make_checked_box_mesh({kind.shape, {2, 2}, kind.geometry_degree, 0.15, swirl_map(0.03)}),
                            kind.displacement_degree, PlaneState::axisymmetric);
    obstacle = make_plane(Eigen::Vector2d(0.0, -0.5), normal);
    const ContactPair pair{"y0", test->mesh.group("y0", 1).members, "plane", obstacle.get(), {}, multipliers};
    boundary = make_contact_boundary(test->body, {pair}, [](Index, int) { return true; });
  }
};

void each_side(const std::function<void(const Side&, const std::string&)>& check) {
  for (const ElementKind& kind : all_element_kinds()) {
    if (kind.dimension() != 2 || !kind.contains_affine()) continue;
    for (const std::string& multipliers : multiplier_space_names())
      check(Side(kind, multipliers), kind.label() + ' ' + multipliers);
  }
}

TEST(Axisymmetry, ContactStressIsExactForUniformStrains) {
  each_side([](const Side& side, const std::string& label) {
    const double a = 0.3, b = -0.2;
    const Vector displacement = interpolate(
        side.test->space, [&](const Vector& x) -> Vector { return Eigen::Vector2d(a * x[0], b * x[1] + 0.7); });
    const Material material = test_material();
    const double axial = material.lambda() * (2.0 * a + b) + 2.0 * material.mu() * b;
    const Vector expected = side.boundary.weights * (-axial * side.normal[1]);
    const Vector found = make_contact_stress(side.test->body, side.boundary).rows * displacement;
    EXPECT_LT((found - expected).lpNorm<Eigen::Infinity>(), 1e-11 * expected.lpNorm<Eigen::Infinity>()) << label;
  });
}

TEST(Axisymmetry, ContactStressIsBoundedByTheElasticEnergy) {
  each_side([](const Side& side, const std::string& label) {
    const ContactStress stress = make_contact_stress(side.test->body, side.boundary);
    const SymmetricEigen modes =
        symmetric_eigen(Matrix(assemble_stiffness(side.test->body, node_graph(side.test->space))));
    const Index rest = modes.values.size() - 1;
    Matrix rows = Matrix(stress.rows) * modes.vectors.rightCols(rest) *
                  modes.values.tail(rest).cwiseSqrt().cwiseInverse().asDiagonal();
    for (Index i = 0; i < rows.rows(); ++i) {
      if (stress.stiffness[i] > 0.0) rows.row(i) /= std::sqrt(stress.stiffness[i]);
    }
    const Vector values = symmetric_eigenvalues(Matrix(rows * rows.transpose()));
    EXPECT_LE(values[values.size() - 1], 1.0 + 1e-10) << label;
    EXPECT_GE(values[values.size() - 1], 0.05) << label << ": the bound is of the right size";
  });
}

/// Averages over a group are weighted with its rings: the mean of r over a full cylinder is 2/3 of the radius.
TEST(Axisymmetry, ProbesOfGroupsTakeMeansOverRings) {
  const Side side({CellShape::triangle, 1, 2}, "nodal");
  State state;
  state.displacement = interpolate(side.test->space, [](const Vector& x) -> Vector { return x; });
  state.velocity = 2.0 * state.displacement;
  const Vector none;
  const Observation observation{state, none, none, none};
  for (const bool of_facets : {false, true}) {
    const std::vector<Index>& members = side.test->mesh.group(of_facets ? "y0" : "body", of_facets ? 1 : 2).members;
    const auto sensor = of_facets ? make_facet_group_sensor("end", side.test->body, members)
                                  : make_cell_group_sensor("all", side.test->body, members);
    std::vector<double> row;
    sensor->observe(observation, row);
    EXPECT_NEAR(row[0], 2.0 / 3.0, 1e-13);
    EXPECT_NEAR(row[1], of_facets ? 0.0 : 0.5, 1e-13);
  }
}

/// One half of the section of a ball of radius 1; the group "contact" includes its axis.
std::string ball_mesh(int order) {
  return mesh_geometry(
      fmt::format("half_section{}", order),
      "Point(1)={0,1.03,0}; Point(2)={0,0.03,0}; Point(3)={1,1.03,0}; Point(4)={0,2.03,0}; Circle(1)={2,1,3}; "
      "Circle(2)={3,1,4}; Line(3)={4,2}; Curve Loop(1)={1,2,3}; Plane Surface(1)={1}; "
      "Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1,3}; Physical Curve(\"upper\")={2};",
      order == 1 ? 0.25 : 0.4, order);
}

std::string ball_case(int order, const std::string& mass, const std::string& time, const std::string& contact = "",
                      const std::string& normal = "[0.0, 1.0]", const std::string& more = "") {
  const bool is_explicit =
      time.find("\"cd-lagrange\"") != std::string::npos || time.find("\"taylor-flanagan\"") != std::string::npos;
  return fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = {}\nplane = \"axisymmetric\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\n"
      "lambda = 30.0\nmu = 20.0\n{}[obstacle.plane]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = {}\n"
      "[[contact]]\ngroup = \"contact\"\nobstacle = \"plane\"\n{}[load]\ngravity = [0.0, -1.0]\n[initial]\n"
      "velocity = [\"0.1*x\", \"-0.5+0.1*x*x\"]\n[mass]\ntype = \"{}\"\n[time]\n{}step = {}\nend = 1.2\n",
      ball_mesh(order), order, more, normal, contact, mass, time, is_explicit ? 0.001 : 0.01);
}

double largest_violation(const CaseRun& run, const MomentumAccount& account, double start, double at) {
  const double size = account.size() + std::abs(start);
  return size > 0.0 && run.problem().axisymmetric ? std::abs(at - start - account.impulse().force[1]) / size : 0.0;
}

/// Expects the account of energy and the balance of the momentum along the axis to close in every step.
void expect_balances(const std::string& text, const std::string& name) {
  std::unique_ptr<CaseRun> run;
  try {
    run = std::make_unique<CaseRun>(text);
  } catch (const Error& problem) {
    EXPECT_NE(std::string(problem.what()).find("indefinite"), std::string::npos) << name << ": " << problem.what();
    return;
  }
  HistoryRecorder recorder(run->problem(), *run->model().rotation);
  MomentumAccount account(run->problem(), run->scheme(), run->state());
  const auto column = [&](const std::string& wanted) { return column_index(recorder.columns(), wanted); };
  const auto row = [&]() -> const std::vector<double>& {
    return recorder.row(run->state(), run->simulation().account());
  };
  const double start = row()[column("momentum_y")];
  double energy = 0.0, residual = 0.0, momentum = 0.0, force = 0.0;
  run->run(
      [&] {
        account.enter_step(run->state());
        const std::vector<double>& now = row();
        energy = std::max({energy, now[column("kinetic_energy")], now[column("elastic_energy")]});
        residual = std::max(residual, std::abs(now[column("energy_residual")]));
        momentum = std::max(momentum, largest_violation(*run, account, start, now[column("momentum_y")]));
        force = std::max(force, now[column("contact_force_y")]);
        EXPECT_EQ(now[column("momentum_x")], 0.0);
        EXPECT_EQ(now[column("angular_momentum_z")], 0.0);
      },
      false);
  EXPECT_LE(residual, 1e-12 * energy) << name;
  EXPECT_LE(momentum, 1e-12) << name;
  EXPECT_GT(force, 0.1) << name;
  EXPECT_TRUE(run->state().displacement.allFinite()) << name;
}

TEST(Axisymmetry, BalancesHoldUnderEveryScheme) {
  for (const std::string& scheme : scheme_names()) {
    for (const std::string& mass : masses_of(scheme)) {
      expect_balances(ball_case(1, mass, time_of(scheme)), scheme + ", " + mass);
    }
  }
}

TEST(Axisymmetry, BalancesHoldWithFrictionInEveryMultiplierSpace) {
  for (const std::string& multipliers : multiplier_space_names()) {
    for (const int order : {1, 2}) {
      for (const char* normal : {"[0.0, 1.0]", "[-0.3, 1.0]"}) {  // a floor, and a cone
        const std::string contact =
            fmt::format("friction = 0.3\nmultipliers = \"{}\"\nunstable_multipliers = \"allow\"\n", multipliers);
        expect_balances(ball_case(order, "equivalent", "", contact, normal, "damping = { mass = 0.05 }\n"),
                        fmt::format("{}, degree {}, normal {}", multipliers, order, normal));
      }
    }
  }
}

/// An impact depends on the motion along the axis alone: the ball's mass, no spin, a normal along the axis.
TEST(Axisymmetry, ImpactsAreAlongTheAxis) {
  for (const char* normal : {"[0.0, 1.0]", "[-0.3, 1.0]"}) {
    CaseRun run(ball_case(2, "equivalent", "", "friction = 0.2\n", normal));
    const SemidiscreteProblem& problem = run.problem();
    ImpactRecorder impacts(problem, run.scheme(), run.state(), run.model().contact_pairs,
                           std::vector<int>(std::size_t(problem.nodes.cols()), 0), {0.3});
    run.run([&] { impacts.enter_step(run.state(), 0.0); }, false);
    ASSERT_FALSE(impacts.impacts().empty());
    const Impact impact = impacts.impacts().front();
    const double mass = 4.0 / 3.0 * pi, inertia = 0.4 * mass;
    EXPECT_NEAR(impact.mass, mass, 1e-3 * mass);
    const RigidBody& ball = impacts.bodies().front();
    EXPECT_NEAR(ball.centre[1], 1.03, 1e-4);
    EXPECT_EQ(ball.centre[0], 0.0);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(ball.inertia(k, k), inertia, 2e-3 * inertia);
    EXPECT_EQ(impact.normal(), Eigen::Vector3d::UnitY());
    EXPECT_EQ(impact.impulse[0], 0.0);
    EXPECT_EQ(impact.before.velocity[0], 0.0);
    EXPECT_EQ(impact.after.spin.norm(), 0.0);
    ASSERT_TRUE(impact.ended);
    const Eigen::Vector3d left = impact.mass * (impact.after.velocity - impact.before.velocity) - impact.impulse;
    EXPECT_NEAR(left[1], -impact.mass * (impact.end - impact.begin), 0.05 * impact.mass);  // gravity
  }
}

/// Without lateral contraction a rod is a bar: it moves like a strip, with forces πR² times those per width.
TEST(Axisymmetry, ARodWithoutLateralContractionIsAStrip) {
  StackedBoxes stack;
  stack.lower_shape = CellShape::quadrilateral;
  stack.lower_counts = {3, 20};
  stack.distortion = 0.0;
  stack.lower_map = [](const Vector& x) -> Vector { return Eigen::Vector2d(0.4 * x[0], 0.1 + 2.0 * x[1]); };
  const Mesh bar = make_box_mesh({stack.lower_shape, stack.lower_counts, 1, stack.distortion, stack.lower_map});
  const std::string mesh = write_mesh("rod_or_strip.msh", bar);
  const auto text = [&](const char* plane) {
    return fmt::format(
        "[mesh]\nfile = \"{}\"\nplane = \"{}\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 900.0\n"
        "poisson = 0.0\n[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"
        "[[contact]]\ngroup = \"y0\"\nobstacle = \"floor\"\n[initial]\nvelocity = [0.0, -10.0]\n"
        "[mass]\ntype = \"consistent\"\n[time]\nscheme = \"newmark\"\nbeta = 0.5\ngamma = 0.5\nstep = 0.001\n"
        "end = 0.2\n",
        mesh, plane);
  };
  CaseRun rod(text("axisymmetric")), strip(text("strain"));
  const double factor = pi * 0.4;  // πR² relative to the width R
  double largest = 0.0;
  rod.run(
      [&] {
        ASSERT_TRUE(strip.session().step());
        const double force = strip.state().forces.normal_reaction.sum();
        largest = std::max(largest, force);
        ASSERT_NEAR(rod.state().forces.normal_reaction.sum(), factor * force, 1e-9 * factor * 400.0);
        ASSERT_LE((rod.state().displacement - strip.state().displacement).lpNorm<Eigen::Infinity>(), 1e-11);
      },
      false);
  EXPECT_GT(largest, 0.4 * 250.0);  // ρcv = 300 per area
}

/// A tube, 1 < r < 2, shrunk on a pin and free to slide along it: p = E u/a / ((b² + a²)/(b² − a²) + ν).
TEST(Axisymmetry, AShrunkTubePressesAsLameSays) {
  const Mesh tube = make_box_mesh({CellShape::quadrilateral, {16, 6}, 1, 0.0, [](const Vector& x) -> Vector {
                                     return Eigen::Vector2d(1.0 + x[0], 0.5 * x[1]);
                                   }});
  const double young = 1000.0, poisson = 0.3, overlap = 0.001;
  const CaseRun run(fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = 2\nplane = \"axisymmetric\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\n"
      "young = {}\npoisson = {}\n[obstacle.pin]\ntype = \"plane\"\npoint = [{}, 0.0]\nnormal = [1.0, 0.0]\n"
      "[[contact]]\ngroup = \"x0\"\nobstacle = \"pin\"\nmultipliers = \"dual\"\n[initial]\n"
      "displacement = \"static\"\n[time]\nstep = 0.01\nend = 0.01\n",
      write_mesh("tube.msh", tube), young, poisson, 1.0 + overlap));
  const double pressure = young * overlap / (5.0 / 3.0 + poisson);
  const Vector& reaction = run.state().forces.normal_reaction;
  EXPECT_NEAR(reaction.sum(), pi * pressure, 1e-5 * pressure);
  const Vector found = run.problem().contact.pressure_recovery * reaction;
  for (const double value : found) EXPECT_NEAR(value, pressure, 1e-3 * pressure);
}

/// Contact alone is enough for a static start: only the translation along the axis is free.
TEST(Axisymmetry, ABallThatLiesOnAPlaneIsInEquilibrium) {
  std::string text = ball_case(2, "equivalent", "");
  const std::string velocity = "velocity = [\"0.1*x\", \"-0.5+0.1*x*x\"]";
  text.replace(text.find(velocity), velocity.size(), "displacement = \"static\"");
  const CaseRun run(text);
  const double weight = 4.0 / 3.0 * pi;
  EXPECT_NEAR(run.state().forces.normal_reaction.sum(), weight, 1e-3 * weight);
  std::string thrown = text;
  thrown.replace(thrown.find("gravity = [0.0, -1.0]"), 21, "gravity = [0.0, 1.0]");
  EXPECT_THROW(CaseRun{thrown}, Error);
}

}  // namespace ricochet::test_support::contact_test
