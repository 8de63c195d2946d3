#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "ricochet/base/log.hpp"
#include "ricochet/contact/construction/make_contact_boundary.hpp"
#include "ricochet/fem/reference_element.hpp"
#include "ricochet/simulation/simulation.hpp"
#include "support/box_mesh.hpp"

/// @file A manufactured elastodynamic solution: a travelling wave on a box with one side driven, tractions on the
/// others and a body force; orders of the displacement's error in h.
namespace ricochet::test_support::manufactured_solution_test {

/// u_i(x, t) = a_i sin(k_i·x + φ_i − ωt): no symmetry, all components of stress, all sides loaded.
/// A quantity linear in u is cos(ωt) · (its value at t = 0) + sin(ωt) · (its value at ωt = π/2).
struct Wave {
  int dimension;
  double frequency = 2.3;  ///< ω
  Matrix wave;             ///< row i: k_i
  Vector amplitude, phase;

  explicit Wave(int d) : dimension(d) {
    Matrix k(3, 3);
    k << 1.4, -0.9, 0.7, 0.8, 1.5, -0.6, -0.7, 1.0, 1.3;
    wave = k.topLeftCorner(d, d);
    amplitude = Vector::LinSpaced(d, 1.0, 0.7);
    phase = Vector::LinSpaced(d, 0.3, 1.2);
  }

  [[nodiscard]] Vector angle(const Vector& x, double turn) const {
    return wave * x + phase - Vector::Constant(dimension, turn);
  }
  /// Displacement at ωt = turn.
  [[nodiscard]] Vector displacement(const Vector& x, double turn) const {
    return amplitude.cwiseProduct(angle(x, turn).array().sin().matrix());
  }
  [[nodiscard]] Vector velocity(const Vector& x, double turn) const {
    return -frequency * amplitude.cwiseProduct(angle(x, turn).array().cos().matrix());
  }
  [[nodiscard]] Matrix stress(const Vector& x, double turn) const {
    const Material material = test_material();
    const Matrix h = amplitude.cwiseProduct(angle(x, turn).array().cos().matrix()).asDiagonal() * wave;
    return material.lambda() * h.trace() * Matrix::Identity(dimension, dimension) + material.mu() * (h + h.transpose());
  }
  /// ρ ü − div σ = −ρω²u − (λ+μ) ∇(div u) − μ Δu, with ∂_i ∂_j u_j = −k_ji k_jj u_j.
  [[nodiscard]] Vector body_force(const Vector& x, double turn) const {
    const Material material = test_material();
    const Vector u = displacement(x, turn);
    Vector force = -material.density * frequency * frequency * u;
    for (int i = 0; i < dimension; ++i) {
      force[i] += material.mu() * wave.row(i).squaredNorm() * u[i];
      for (int j = 0; j < dimension; ++j)
        force[i] += (material.lambda() + material.mu()) * wave(j, i) * wave(j, j) * u[j];
    }
    return force;
  }
};

/// Load of the body force and of the tractions on all sides but x = 0, at ωt = turn.
Vector load_at(const MeshedBody& test, const Wave& wave, double turn) {
  const int d = test.mesh.dimension;
  Vector load = Vector::Zero(test.space.dof_count());
  add_body_load(
      test.body, [&](const Vector& x, Vector& force) { force = wave.body_force(x, turn); }, load);
  for (int axis = 0; axis < d; ++axis) {
    for (const int end : {0, 1}) {
      if (axis == 0 && end == 0) continue;
      add_facet_load(
          test.body, test.mesh.group(std::string(1, "xyz"[axis]) + (end == 1 ? "1" : "0"), d - 1).members,
          [&](const Vector& x, Vector& force) { force = (end == 1 ? 1.0 : -1.0) * wave.stress(x, turn).col(axis); },
          load);
    }
  }
  return load;
}

SemidiscreteProblem make_problem(const MeshedBody& test, const Wave& wave, bool integrate_at_every_instant) {
  const int d = test.mesh.dimension;
  const NodeGraph graph = node_graph(test.space);
  SemidiscreteProblem problem;
  problem.dimension = d;
  problem.nodes = test.space.nodes;
  problem.internal_force = std::make_shared<LinearElasticity>(assemble_stiffness(test.body, graph), problem.nodes);
  problem.loads = Loads(test.space.dof_count());
  if (integrate_at_every_instant) {
    problem.loads.add_general(
        [&test, wave](double time, Vector& load) { load += load_at(test, wave, wave.frequency * time); });
  } else {
    const std::map<std::string, double> parameters{{"w", wave.frequency}};
    problem.loads.add_separable(load_at(test, wave, 0.0), Expression("cos(w*t)", parameters));
    problem.loads.add_separable(load_at(test, wave, 0.5 * M_PI), Expression("sin(w*t)", parameters));
  }
  for (const Index node : facet_nodes(test.space, test.mesh.group("x0", d - 1).members)) {
    const Vector at_start = wave.displacement(test.space.nodes.col(node), 0.0);
    const Vector at_quarter = wave.displacement(test.space.nodes.col(node), 0.5 * M_PI);
    for (int k = 0; k < d; ++k) {
      problem.supports.add(node * d + k,
                           Expression(fmt::format("({:.17g})*cos({:.17g}*t)+({:.17g})*sin({:.17g}*t)", at_start[k],
                                                  wave.frequency, at_quarter[k], wave.frequency)));
    }
  }
  problem.supports.finish();
  problem.contact = make_contact_boundary(test.body, {}, [](Index, int) { return true; });
  finish_problem(problem, expand_to_components(assemble_scalar_mass(test.body, graph), d), false);
  return problem;
}

/// ‖u_h − u‖ in L², by quadrature on the cells.
double error_norm(const MeshedBody& test, const Wave& wave, const Vector& displacement, double turn) {
  const int d = test.mesh.dimension;
  double sum = 0.0;
  const CellBlock& geometry = test.mesh.cells[0];
  const CellBlock& cells = test.space.cells[0];
  const QuadratureRule rule = quadrature(geometry.shape, 2 * test.space.degree + 3);
  const Tabulation map = ReferenceElement::get(geometry.shape, test.mesh.degree).tabulate(rule.points);
  const Tabulation shape = ReferenceElement::get(geometry.shape, test.space.degree).tabulate(rule.points);
  Matrix nodes(d, geometry.nodes_per_cell), values(d, cells.nodes_per_cell);
  for (Index cell = 0; cell < cells.size(); ++cell) {
    for (int k = 0; k < geometry.nodes_per_cell; ++k) nodes.col(k) = test.mesh.nodes.col(geometry.cell(cell)[k]);
    for (int k = 0; k < cells.nodes_per_cell; ++k) values.col(k) = displacement.segment(cells.cell(cell)[k] * d, d);
    for (Index q = 0; q < rule.weights.size(); ++q) {
      const Matrix jacobian = nodes * map.gradients[std::size_t(q)];
      const Vector difference = values * shape.values.col(q) - wave.displacement(nodes * map.values.col(q), turn);
      sum += rule.weights[q] * jacobian.determinant() * difference.squaredNorm();
    }
  }
  return std::sqrt(sum);
}

/// Runs with the trapezoidal rule to t = 0.8; root mean square of the error norm at the quarters of that time.
double run_error(const MeshedBody& test, const SemidiscreteProblem& problem, const Wave& wave, int quarter_steps) {
  log::set_level(log::Level::warning);  // differences of the supports' formulas give the first velocity: expected
  const double step = 0.2 / quarter_steps;
  const auto scheme = make_scheme("newmark", step, {{"preset", "trapezoidal"}});
  InitialConditions initial;
  initial.displacement = interpolate(test.space, [&](const Vector& x) { return wave.displacement(x, 0.0); });
  initial.velocity = interpolate(test.space, [&](const Vector& x) { return wave.velocity(x, 0.0); });
  Simulation simulation(problem, *scheme, initial);
  double sum = 0.0;
  for (int quarter = 0; quarter < 4; ++quarter) {
    for (int i = 0; i < quarter_steps; ++i) simulation.advance();
    const State& state = simulation.state();
    sum += std::pow(error_norm(test, wave, state.displacement, wave.frequency * state.time), 2);
  }
  return std::sqrt(sum / 4.0);
}

std::unique_ptr<MeshedBody> make_body(const ElementKind& kind, int count) {
  const std::vector<int> counts(static_cast<std::size_t>(kind.dimension()), count);
  return make_meshed_body(make_checked_box_mesh({kind.shape, counts, kind.geometry_degree, 0.12, swirl_map(0.06)}),
                          kind.displacement_degree);
}

class ManufacturedSolution : public testing::TestWithParam<ElementKind> {};

TEST_P(ManufacturedSolution, ConvergesWithOneOrderMoreThanTheDegree) {
  const ElementKind& kind = GetParam();
  const int d = kind.dimension();
  const int k = kind.displacement_degree;
  const Wave wave(d);
  std::vector<int> counts{2, 4, 8};
  if (d == 2) counts = k == 1 ? std::vector<int>{8, 16, 32, 64} : std::vector<int>{4, 8, 16, 32};
  if (d == 3) counts = k == 1 ? std::vector<int>{4, 8, 16} : std::vector<int>{2, 4, 6};
  std::vector<double> errors;
  std::printf("%-42s", kind.label().c_str());
  double order = 0.0;
  for (const int count : counts) {
    const auto test = make_body(kind, count);
    const SemidiscreteProblem problem = make_problem(*test, wave, false);
    // Δt ~ h for degree 1 and h^(3/2) for degree 2: the error in time decreases as in space, far below it.
    const int steps = k == 1 ? count : int(std::ceil(1.5 * std::pow(count, 1.5)));
    errors.push_back(run_error(*test, problem, wave, steps));
    std::printf("  %2d: %.2e", count, errors.back());
    const std::size_t n = errors.size();
    if (n > 1) {
      order = std::log(errors[n - 2] / errors[n - 1]) / std::log(double(counts[n - 1]) / double(counts[n - 2]));
      std::printf(" (%.2f)", order);
    }
  }
  std::printf("\n");
  EXPECT_GE(order, k + 1 - 0.25);
}

INSTANTIATE_TEST_SUITE_P(Elements, ManufacturedSolution, testing::ValuesIn(all_element_kinds()),
                         [](const auto& info) { return info.param.label(); });

/// A load integrated anew at every instant equals the combination of the two patterns.
TEST(ManufacturedSolutionLoads, GeneralAndSeparableAgree) {
  const Wave wave(2);
  const auto test = make_body({CellShape::quadrilateral, 2, 2}, 4);
  const SemidiscreteProblem separable = make_problem(*test, wave, false);
  const SemidiscreteProblem general = make_problem(*test, wave, true);
  for (const double time : {0.0, 0.37, 1.9}) {
    Vector a, b;
    separable.loads.total(time, a);
    general.loads.total(time, b);
    EXPECT_GT(a.lpNorm<Eigen::Infinity>(), 0.0);
    EXPECT_LE((a - b).lpNorm<Eigen::Infinity>(), 1e-13 * a.lpNorm<Eigen::Infinity>());
  }
  const double first = run_error(*test, separable, wave, 5);
  EXPECT_NEAR(run_error(*test, general, wave, 5), first, 1e-9 * first);
}

/// On a fixed mesh the trapezoidal rule is of second order in Δt: successive halvings change the error norm's limit by
/// a quarter of the previous change.
TEST(ManufacturedSolutionInTime, IsOfSecondOrder) {
  log::set_level(log::Level::warning);
  const Wave wave(2);
  const auto test = make_body({CellShape::quadrilateral, 1, 2}, 6);
  const SemidiscreteProblem problem = make_problem(*test, wave, false);
  std::vector<Vector> last;
  for (const int steps : {8, 16, 32, 64}) {
    const auto scheme = make_scheme("newmark", 0.8 / steps, {{"preset", "trapezoidal"}});
    InitialConditions initial;
    initial.displacement = interpolate(test->space, [&](const Vector& x) { return wave.displacement(x, 0.0); });
    initial.velocity = interpolate(test->space, [&](const Vector& x) { return wave.velocity(x, 0.0); });
    Simulation simulation(problem, *scheme, initial);
    for (int i = 0; i < steps; ++i) simulation.advance();
    last.push_back(simulation.state().displacement);
  }
  const double before = problem.mass.quadratic_form(last[2] - last[1]);
  const double after = problem.mass.quadratic_form(last[3] - last[2]);
  const double order = 0.5 * std::log2(before / after);
  std::printf("order in the time step: %.2f\n", order);
  EXPECT_NEAR(order, 2.0, 0.25);
}

}  // namespace ricochet::test_support::manufactured_solution_test
