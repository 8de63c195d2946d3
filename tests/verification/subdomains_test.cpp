#include "ricochet/solver/subdomain/subdomains.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ricochet/solver/stage/stage_operator.hpp"
#include "ricochet/solver/subdomain/contact_clusters.hpp"
#include "support/case_run.hpp"

// Contact of many points: subdomains that are solved separately, in the iterative path.

namespace ricochet::test_support::contact_zones_test {

/// A plate that comes down on a face of some 800 nodes, rotated slightly so that it first touches at one edge, and
/// slides. A wave crosses about one cell in a step.
std::string plate(const std::string& multipliers = "", double size = 0.042) {
  return "[mesh]\nfile = \"" +
         mesh_geometry("contact-zones",
                       "Box(1)={0,0,0,1,1,0.12}; Physical Volume(\"plate\")={1}; Physical "
                       "Surface(\"bottom\")={5}; Physical Surface(\"side\")={1};",
                       size, 1) +
         "\"\n[[material]]\ngroup = \"plate\"\ndensity = 1000.0\nyoung = 1.0e7\npoisson = 0.3\n"
         "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.02, 0.03, 1.0]\n"
         "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\nfriction = 0.3\n" +
         multipliers +
         "[initial]\nvelocity = [1.0, 0.0, -20.0]\ndisplacement = [0.0, 0.0, 0.001]\n[mass]\ntype = \"equivalent\"\n"
         "[time]\nscheme = \"newmark\"\npreset = \"textbook-half\"\nstep = 3.0e-4\nend = 4.5e-3\n";
}

struct Zones {
  explicit Zones(const CaseRun& run, const std::vector<char>& solved, double longer = 1.0)
      : coefficients{run.session().scheme().operators(run.problem()).back()}, nearby(run.problem()) {
    coefficients.mass /= longer * longer;
    product = StageProduct(run.problem(), coefficients);
    zones = std::make_unique<Subdomains>(run.problem(), coefficients, solved, product, nearby, shared, nullptr);
  }
  OperatorCoefficients coefficients;
  StageProduct product;
  ContactNeighbourhood nearby;
  SharedContact shared;
  std::unique_ptr<Subdomains> zones;
};

std::vector<Index> all_points(const SemidiscreteProblem& problem) {
  std::vector<Index> points(static_cast<std::size_t>(problem.contact.size()));
  std::iota(points.begin(), points.end(), Index{0});
  return points;
}

/// Number of cells that a P wave crosses in a step: √((λ+2μ)/ρ) h over the cell size.
TEST(Subdomains, HaveLayersForWhatAWaveCrosses) {
  const CaseRun run(plate());
  const std::vector<char> solved(static_cast<std::size_t>(run.problem().dof_count()), 1);
  const double crossed = std::sqrt(1e7 * 0.7 / (1.3 * 0.4) / 1000.0) * 3.0e-4 / 0.042;
  std::vector<Index> nodes(static_cast<std::size_t>(run.problem().nodes.cols()));
  std::iota(nodes.begin(), nodes.end(), Index{0});
  for (const double longer : {1.0, 3.0, 30.0}) {
    Zones zones(run, solved, longer);
    // α is 4/h² here, while β = ½, γ = 1 gives 2/h²: it belongs to a step √2 times as long.
    const double alpha_h2 = zones.coefficients.mass * 9e-8 * longer * longer;
    const double expected = crossed * longer * std::sqrt(4.0 / alpha_h2);
    EXPECT_NEAR(cells_crossed(run.problem(), zones.coefficients, zones.product, nodes), expected, 0.25 * expected);
    zones.zones->make({0});
    EXPECT_GE(zones.zones->layers(), std::clamp(int(std::ceil(0.9 * expected)), 2, 12)) << longer;
    EXPECT_LE(zones.zones->layers(), std::clamp(int(std::ceil(1.5 * expected)), 2, 12)) << longer;
  }
}

TEST(Subdomains, AreSeveralWhereThatIsLessWork) {
  const CaseRun run(plate());
  const std::vector<char> solved(static_cast<std::size_t>(run.problem().dof_count()), 1);
  const std::vector<Index> points = all_points(run.problem());
  ASSERT_GT(points.size(), 600U);
  Zones near(run, solved);
  near.zones->make(points);
  EXPECT_GE(near.zones->count(), 3U);
  // If a wave crosses much of the plate, every subdomain would contain all points.
  Zones far(run, solved, 30.0);
  far.zones->make(points);
  EXPECT_EQ(far.zones->count(), 1U);
}

void expect_division(const SemidiscreteProblem& problem, const std::vector<std::vector<Index>>& clusters) {
  std::vector<Index> found;
  for (const auto& cluster : clusters) {
    EXPECT_TRUE(std::ranges::is_sorted(cluster));
    found.insert(found.end(), cluster.begin(), cluster.end());
  }
  std::ranges::sort(found);
  EXPECT_EQ(found, all_points(problem));
}

TEST(ContactClusters, DivideThePoints) {
  const CaseRun run(plate());
  for (const std::size_t most : {1U, 7U, 100U, 256U}) {
    const auto clusters = cluster_points(run.problem(), all_points(run.problem()), most);
    expect_division(run.problem(), clusters);
    for (const auto& cluster : clusters) EXPECT_LE(cluster.size(), most);
    EXPECT_LE(clusters.size(), 2 * run.problem().contact.size() / Index(most) + 1);
  }
}

/// Points that share nodes: the conditions of both hold only if one subdomain moves them.
TEST(ContactClusters, KeepPointsThatShareNodesTogether) {
  const CaseRun run(plate("multipliers = \"p1\"\n", 0.1));
  const auto clusters = cluster_points(run.problem(), all_points(run.problem()), 10);
  expect_division(run.problem(), clusters);
  EXPECT_EQ(clusters.size(), 1U);
  EXPECT_TRUE(cluster_points(run.problem(), {}, 10).empty());
}

struct Frame {
  Vector displacement, normal, tangential, gap;
};

std::vector<Frame> frames(const std::vector<std::string>& overrides) {
  CaseRun run(plate(), overrides);
  std::vector<Frame> result;
  run.run([&] {
    Vector gap;
    run.problem().gaps(run.state().displacement, run.state().time, gap);
    result.push_back(
        {run.state().displacement, run.state().forces.normal_reaction, run.state().forces.tangential_reaction, gap});
  });
  return result;
}

TEST(Subdomains, FindWhatOneFactorFinds) {
  const std::vector<Frame> direct = frames({"solver.method=direct"});
  const std::vector<Frame> zones = frames({"solver.method=iterative", "solver.tolerance=1e-12"});
  ASSERT_EQ(direct.size(), zones.size());
  const double length = direct.back().displacement.lpNorm<Eigen::Infinity>();
  double force = 0.0;
  Index most = 0;
  for (const Frame& frame : direct) {
    force = std::max(force, frame.normal.maxCoeff());
    most = std::max(most, Index((frame.normal.array() > 0.0).count()));
  }
  EXPECT_GT(most, 400) << "more points than of one zone";
  for (std::size_t k = 0; k < direct.size(); ++k) {
    EXPECT_LT((direct[k].displacement - zones[k].displacement).lpNorm<Eigen::Infinity>(), 1e-10 * length) << k;
    EXPECT_LT((direct[k].normal - zones[k].normal).lpNorm<Eigen::Infinity>(), 1e-10 * force) << k;
    EXPECT_LT((direct[k].tangential - zones[k].tangential).lpNorm<Eigen::Infinity>(), 1e-10 * force) << k;
    // Signorini's and Coulomb's laws hold to rounding, for any tolerance.
    EXPECT_GT(zones[k].gap.minCoeff(), -1e-14);
    EXPECT_GE(zones[k].normal.minCoeff(), 0.0);
    for (Index i = 0; i < zones[k].normal.size(); ++i) {
      const bool is_open = zones[k].normal[i] == 0.0;
      EXPECT_TRUE(is_open || std::abs(zones[k].gap[i]) < 1e-14) << k << ' ' << i;
      EXPECT_LE(zones[k].tangential.segment(2 * i, 2).norm(), 0.3 * zones[k].normal[i] * (1.0 + 1e-12));
    }
  }
}

}  // namespace ricochet::test_support::contact_zones_test
