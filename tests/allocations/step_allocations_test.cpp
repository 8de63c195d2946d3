#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "allocation_count.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/simulation/history/history.hpp"
#include "ricochet/simulation/history/momentum_account.hpp"
#include "ricochet/simulation/impact/impacts.hpp"
#include "ricochet/simulation/monitor/peak_stress.hpp"
#include "ricochet/simulation/monitor/penetration_watch.hpp"
#include "ricochet/simulation/monitor/sliding_watch.hpp"
#include "support/case_run.hpp"
#include "support/grid_matrix.hpp"
#include "support/thrown_body.hpp"

// A time step allocates no memory once its work space has the size that the contact needs.

namespace ricochet::test_support {
namespace {

TEST(AllocationCount, CountsWhatIsAllocated) {
  const long before = allocation_count();
  auto number = std::make_unique<int>(3);
  EXPECT_EQ(allocation_count(), before + 1);
  Vector vector = Vector::Zero(100);
  EXPECT_EQ(allocation_count(), before + 2);
  EXPECT_EQ(*number + vector[99], 3.0);
}

struct Variant {
  std::string name, time, mass, contact;
  std::vector<std::string> overrides;
  bool is_steady = true;  ///< the contact stays as it is for many steps
  bool moving = false;    ///< the obstacle drifts and, in 3D, rotates
};

void PrintTo(const Variant& variant, std::ostream* stream) { *stream << variant.name; }

std::vector<Variant> variants() {
  const std::string trapezoidal = "scheme = \"newmark\"\npreset = \"trapezoidal\"\n";
  const std::string ends = "scheme = \"reduced-kane\"\nreaction_weight = \"end\"\n";
  return {{"Newmark", trapezoidal, "equivalent", "", {}},
          {"NewmarkFriction", trapezoidal, "equivalent", "friction = 0.3\n", {}},
          {"NewmarkAllPoints", trapezoidal, "equivalent", "friction = 0.3\n", {"solver.contact_points=all"}},
          {"NewmarkIterative", trapezoidal, "equivalent", "friction = 0.3\n", {"solver.method=iterative"}},
          {"KlrConserving", "scheme = \"klr-conserving\"\n", "consistent", "friction = 0.3\n", {}, false},
          {"Midpoint", "scheme = \"midpoint\"\n", "lumped", "", {}, false},
          {"SemiExplicit", "scheme = \"semi-explicit\"\n", "equivalent-lumped", "friction = 0.3\n", {}},
          {"ReducedKane", ends, "equivalent", "friction = 0.3\n", {}},
          // The paths of the mean reaction appear and vanish with the active points.
          {"ReducedKaneMean", "scheme = \"reduced-kane\"\n", "equivalent", "friction = 0.3\n", {}, false},
          {"ReducedKaneIterative", ends, "equivalent", "friction = 0.3\n", {"solver.method=iterative"}},
          // Its contact at the middle of a step changes where that at the end does not.
          {"ReducedMidpoint", "scheme = \"reduced-midpoint\"\n", "equivalent", "", {}, false},
          {"Kane", "scheme = \"kane\"\n", "consistent", "friction = 0.3\n", {}, false},
          {"GeneralizedAlpha", "scheme = \"generalized-alpha\"\n", "equivalent", "friction = 0.3\n", {}, false},
          {"Bathe", "scheme = \"bathe\"\n", "equivalent", "friction = 0.3\n", {}, false},
          // It bounces: points become candidates again while nothing touches.
          {"LaursenLove",
           "scheme = \"laursen-love\"\n",
           "lumped",
           "friction = 0.3\n",
           {"solver.contact_points=all"},
           false},
          {"MoreauJean", "scheme = \"moreau-jean\"\n", "consistent", "friction = 0.3\n", {}, false},
          {"PaoliSchatzman", "scheme = \"paoli-schatzman\"\n", "consistent", "friction = 0.3\n", {}, false},
          {"PenaltyMidpoint", "scheme = \"penalty-midpoint\"\n", "lumped", "", {}, false},
          {"Nitsche", "scheme = \"nitsche\"\n", "lumped", "", {}, false},
          {"NonsmoothGeneralizedAlpha", "scheme = \"nonsmooth-generalized-alpha\"\n", "lumped", "", {}, false},
          {"MovingObstacleReducedKane", ends, "equivalent", "friction = 0.3\n", {}, true, true},
          {"MovingObstacle", trapezoidal, "equivalent", "friction = 0.3\n", {}, true, true},
          {"MovingObstacleKlrConserving",
           "scheme = \"klr-conserving\"\n",
           "consistent",
           "friction = 0.3\n",
           {},
           false,
           true},
          {"MovingObstacleMidpoint", "scheme = \"midpoint\"\n", "lumped", "friction = 0.3\n", {}, false, true},
          {"MovingObstacleSemiExplicit",
           "scheme = \"semi-explicit\"\n",
           "equivalent-lumped",
           "friction = 0.3\n",
           {},
           true,
           true}};
}

std::string motion_of_obstacle(int dimension) {
  return dimension == 2 ? "velocity = [0.2, 0.0]\n" : "velocity = [0.2, 0.1, 0.0]\nrotation_rate = 0.3\n";
}

class StepAllocations : public testing::TestWithParam<Variant> {};

/// Number of steps with allocations, out of those that were examined.
struct Tally {
  long steps = 0, allocating = 0;
  void add(long count) {
    ++steps;
    allocating += count > 0 ? 1 : 0;
  }
};

/// A run with everything that monitors every step.
class WatchedRun {
 public:
  WatchedRun(const std::string& text, const std::vector<std::string>& overrides) : run_(text, overrides) {}

  [[nodiscard]] const State& state() const { return run_.state(); }
  /// Returns the number of allocations; 0 if a message was logged, which needs strings.
  long advance() {
    const std::size_t told = warnings_.size();
    const long before = allocation_count();
    run_.simulation().advance();
    (void)recorder_.row(run_.state(), run_.simulation().account());
    impacts_.enter_step(run_.state(), run_.simulation().account().method_energy(run_.state()));
    peak_.enter(run_.state(), false);
    watch_.check(run_.state());
    sliding_.check(run_.state());
    momenta_.enter_step(run_.state());
    return warnings_.size() > told ? 0 : allocation_count() - before;
  }

 private:
  CaseRun run_;
  HistoryRecorder recorder_{run_.problem(), *run_.model().rotation, run_.model().sensors, run_.model().history_bodies};
  ConnectedBodies connected_ = find_connected_bodies(run_.model().space);
  ImpactRecorder impacts_{run_.problem(),     run_.scheme(), run_.state(), run_.model().contact_pairs,
                          connected_.of_node, {0.1}};
  PeakStress peak_{run_.model().body, 1e30};
  PenetrationWatch watch_{
      run_.model().body, run_.problem(), run_.model().contact_pairs, {{"floor", run_.model().obstacles.front().get()}}};
  SlidingWatch sliding_{run_.model().body, run_.problem(), run_.model().contact_pairs};
  MomentumAccount momenta_{run_.problem(), run_.scheme(), run_.state()};
  std::vector<std::string> warnings_;
  log::CollectWarnings collect_{warnings_};
};

/// No allocations while nothing touches. In contact, the work space grows with the candidates and with the active
/// points, which change; while the same points press, stick and slip as in the two preceding steps, steps that allocate
/// are the exception (new candidates).
TEST_P(StepAllocations, AreNoneUnlessTheContactGrows) {
  const auto bodies = thrown_bodies();
  for (const std::size_t body : {0u, 3u}) {
    for (const int threads : {1, 2}) {
      set_thread_count(threads);
      std::vector<std::string> overrides = GetParam().overrides;
      overrides.push_back("time.end=3.0");
      const std::string motion = GetParam().moving ? motion_of_obstacle(bodies[body].dimension) : "";
      WatchedRun run(thrown_case(bodies[body], GetParam().mass, GetParam().time, GetParam().contact, motion),
                     overrides);
      std::vector<ContactStatus> status;
      long same = 0;
      Tally apart, in_contact;
      for (int step = 0; step < 300; ++step) {
        const long count = run.advance();
        same = run.state().contact_status == status ? same + 1 : 0;
        status = run.state().contact_status;
        if (step < 3 || same < 2) continue;
        const bool touches = (run.state().forces.normal_reaction.array() > 0.0).any();
        (touches ? in_contact : apart).add(count);
      }
      const std::string where = bodies[body].name + ", " + std::to_string(threads) + " threads";
      EXPECT_GT(apart.steps, 50) << where;
      EXPECT_EQ(apart.allocating, 0) << where;
      if (!GetParam().is_steady) continue;
      EXPECT_GT(in_contact.steps, 50) << where;
      EXPECT_LE(double(in_contact.allocating), 0.2 * double(in_contact.steps)) << where;
    }
  }
  set_thread_count(1);
}

/// Iterations, cells in packs, viscoelastic branches, momenta about moving positions. (Near an obstacle the columns of
/// the Delassus operator rotate with the body and need new storage for new points.)
TEST(FiniteStrainAllocations, AreNoneInFlight) {
  struct Flight {
    std::string time, mass, law = "neo-hookean";
    std::vector<std::string> more = {};
  };
  const std::vector<Flight> flights = {{"scheme = \"reduced-kane\"\n", "equivalent"},
                                       {"scheme = \"reduced-kane\"\n",
                                        "equivalent",
                                        "saint-venant-kirchhoff",
                                        {"material.0.relaxation={ modulus = [0.5, 0.2], time = [0.1, 1.0] }"}},
                                       {"scheme = \"mean-reaction\"\n", "equivalent"},
                                       {"scheme = \"newmark\"\npreset = \"trapezoidal\"\n", "equivalent"},
                                       {"scheme = \"midpoint\"\n", "lumped"},
                                       {"scheme = \"semi-explicit\"\n", "equivalent-lumped"}};
  const auto bodies = thrown_bodies();
  for (const Flight& flight : flights) {
    for (const std::size_t body : {0u, 3u}) {
      for (const int threads : {1, 2}) {
        set_thread_count(threads);
        std::vector<std::string> overrides = flight.more;
        overrides.push_back("material.0.law=" + flight.law);
        overrides.push_back("time.end=3.0");
        overrides.push_back(bodies[body].dimension == 2 ? "obstacle.plane.point=[0, -50]"
                                                        : "obstacle.plane.point=[0, 0, -50]");
        WatchedRun run(thrown_case(bodies[body], flight.mass, flight.time), overrides);
        for (int step = 0; step < 5; ++step) run.advance();
        // The critical step is recomputed now and then (semi-explicit).
        Tally tally;
        for (int step = 0; step < 100; ++step) tally.add(run.advance());
        EXPECT_LE(tally.allocating, flight.mass == "equivalent-lumped" ? 5 : 0)
            << flight.time << flight.law << bodies[body].name << threads;
      }
    }
  }
  set_thread_count(1);
}

/// The report is rewritten during a run, under a lock: the same findings must need the same work in a finer mesh.
TEST(PenetrationReports, CostTheSameInAFinerMesh) {
  std::vector<long> counts;
  for (const double size : {0.3, 0.05}) {
    const std::string disc = "Disk(1)={0,1.02,0,1}; Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1};";
    const ThrownBody body{"disc", 2, 1, mesh_geometry("disc", disc, size, 1)};
    CaseRun run(thrown_case(body, "equivalent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n"));
    // The disc is at the middle of the wall, to which no contact refers.
    const std::unique_ptr<Obstacle> obstacle = make_plane(Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(1.0, 0.0));
    PenetrationWatch watch(run.model().body, run.problem(), run.model().contact_pairs, {{"wall", obstacle.get()}});
    watch.check(run.state());
    const long before = allocation_count();
    const PenetrationReport report = watch.report();
    counts.push_back(allocation_count() - before);
    ASSERT_EQ(report.found.size(), 1u);
    EXPECT_EQ(report.found[0].bodies, (std::vector<std::string>{"the body"}));
    EXPECT_EQ(report.found[0].groups, (std::vector<std::string>{"contact"}));
    EXPECT_NEAR(report.found[0].depth, 1.0, 0.02);
    EXPECT_NEAR(report.found[0].relative_depth, report.found[0].depth / 2.0, 0.02);  // the disc's diameter
  }
  EXPECT_EQ(counts[0], counts[1]);
}

/// On one thread and on several: all storage that may be kept exists after the first factorization.
TEST(FactorizationAllocations, AMatrixOfTheSamePatternIsFactorizedWithoutAny) {
  const SparseMatrix matrix = grid_matrix(3, 14, 3, 7);
  SparseCholesky factor(matrix);
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    for (int round = 0; round < 4; ++round) factor.refactorize(matrix);
    const long before = allocation_count();
    factor.refactorize(matrix);
    EXPECT_EQ(allocation_count() - before, 0) << threads;
  }
  set_thread_count(1);
}

INSTANTIATE_TEST_SUITE_P(Schemes, StepAllocations, testing::ValuesIn(variants()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace ricochet::test_support
