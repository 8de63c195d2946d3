#include <gtest/gtest.h>

#include <cmath>

#include "distributed/cut_body.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/contact/construction/make_contact_boundary.hpp"
#include "ricochet/problem/internal_force.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/simulation/simulation.hpp"

// Bodies in pieces move like undivided ones: schemes and accounts depend on no property of ranks.

namespace ricochet::test_support {
namespace {

using distributed_test::CutBody;
using distributed_test::Variant;

/// A body held at x = 0 by a moving support, under its weight and a varying load.
SemidiscreteProblem moving_problem(const Body& body, const Ranks& ranks) {
  const int d = body.mesh->dimension;
  const NodeGraph graph = node_graph(*body.space);
  const SparseMatrix mass = expand_to_components(assemble_scalar_mass(body, graph), d);
  SemidiscreteProblem problem;
  problem.ranks = &ranks;
  problem.dimension = d;
  problem.nodes = body.space->nodes;
  problem.internal_force = std::make_shared<LinearElasticity>(assemble_stiffness(body, graph), problem.nodes);
  Vector weight = Vector::Zero(body.space->dof_count()), wind = weight;
  for (Index node = 0; node < body.space->node_count(); ++node) {
    weight[node * d + 1] = -2.0;
    wind[node * d] = problem.nodes(0, node) * std::cos(problem.nodes(1, node));
    if (problem.nodes(0, node) != 0.0) continue;
    for (int k = 0; k < d; ++k) problem.supports.add(node * d + k, Expression(k == 0 ? "0.01*sin(3*t)^2" : "0"));
  }
  problem.supports.finish();
  problem.loads = Loads(body.space->dof_count());
  problem.loads.add_constant(mass * weight);
  problem.loads.add_separable(mass * wind, Expression("sin(5*t)"));
  problem.contact = make_contact_boundary(body, {}, [](Index, int) { return true; });
  finish_problem(problem, mass, false);
  return problem;
}

class Motion : public CutBody, public testing::TestWithParam<std::tuple<Variant, std::string>> {
 protected:
  Motion() : CutBody(std::get<0>(GetParam())) {}
};

TEST_P(Motion, IsThatOfOneRank) {
  log::set_level(log::Level::error);
  const SemidiscreteProblem whole = moving_problem(whole_->body, one_rank()), part = moving_problem(own_, ranks_);
  const auto make = [] {
    const std::string& name = std::get<1>(GetParam());
    return make_scheme(name, 0.02, name == "newmark" ? Parameters{{"preset", "trapezoidal"}} : Parameters{});
  };
  const auto scheme = make(), own_scheme = make();
  InitialConditions initial, own_initial;
  initial.displacement = interpolate(whole_->space, [](const Vector& x) -> Vector { return 0.01 * x[0] * x; });
  initial.velocity = 3.0 * initial.displacement;
  own_initial.displacement = part_of(initial.displacement);
  own_initial.velocity = part_of(initial.velocity);
  StepSolverOptions options;
  options.method = SolverMethod::iterative;
  options.tolerance = 1e-13;
  Simulation simulation(whole, *scheme, initial, options), own(part, *own_scheme, own_initial, options);
  double largest_energy = 0.0;
  for (int step = 0; step < 40; ++step) {
    simulation.advance();
    own.advance();
    const Vector &u = simulation.state().displacement, &v = simulation.state().velocity;
    EXPECT_LT((own.state().displacement - part_of(u)).lpNorm<Eigen::Infinity>(), 1e-10 * u.lpNorm<Eigen::Infinity>());
    EXPECT_LT((own.state().velocity - part_of(v)).lpNorm<Eigen::Infinity>(), 1e-10 * v.lpNorm<Eigen::Infinity>());
    // Motions have the same bits on all ranks that share a node.
    Vector owners = own.state().displacement;
    exchange_.copy_from_owners(owners);
    EXPECT_EQ(owners, own.state().displacement);
    // Each rank has a part of energies and works.
    const Energies expected = simulation.account().energies(simulation.state()),
                   energies = own.account().energies(own.state());
    largest_energy = std::max({largest_energy, expected.kinetic, expected.elastic});
    EXPECT_NEAR(ranks_.sum(energies.kinetic), expected.kinetic, 1e-10 * largest_energy);
    EXPECT_NEAR(ranks_.sum(energies.elastic), expected.elastic, 1e-10 * largest_energy);
    EXPECT_NEAR(ranks_.sum(energies.load_potential), expected.load_potential, 1e-10 * largest_energy);
    EXPECT_NEAR(ranks_.sum(own.account().works().support), simulation.account().works().support,
                1e-10 * largest_energy);
    EXPECT_NEAR(ranks_.sum(own.account().residual(energies)), 0.0, 1e-11 * largest_energy);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Motion,
                         testing::Combine(testing::ValuesIn(distributed_test::variants()),
                                          testing::Values("newmark", "midpoint", "klr-conserving", "reduced-kane")),
                         [](const auto& info) {
                           std::string name = std::get<0>(info.param).name() + "_" + std::get<1>(info.param);
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace ricochet::test_support
