/// Tests the contact solvers on random problems that are hard by nature (tests/support/hard_contact_problems.hpp):
///
///     ricochet_hard_contact_bench [SEEDS [SEEDS-OF-OTHERS]]
///
/// Prints a table in Markdown: for each kind of problem and each solver the percentage not solved at 1e-8 and at 1e-12,
/// and the median time at 1e-8 in milliseconds. The default solver gets SEEDS problems of each generator (500), the
/// others SEEDS-OF-OTHERS (30). The last line is the number of answers that a solver wrongly reports as solved: the
/// exit status is 1 unless it is zero.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "ricochet/base/timer.hpp"
#include "support/hard_contact_problems.hpp"

namespace {

using namespace ricochet;
using namespace ricochet::test_support;

using Generator = std::function<FrictionProblem(unsigned seed)>;

struct Kind {
  std::string name;
  std::vector<Generator> generators;
};

template <std::size_t size, class T>
T one_of(const std::array<T, size>& values, std::mt19937& random) {
  return values[random() % size];
}

Generator rigid(Index dimension, double friction) {
  return [=](unsigned seed) {
    std::mt19937 random(seed);
    return rigid_box(one_of(std::array<Index, 6>{4, 9, 16, 25, 50, 100}, random), dimension, friction, seed);
  };
}

Generator rigid_twice(Index dimension) {
  return [=](unsigned seed) {
    std::mt19937 random(seed);
    const Index points = one_of(std::array<Index, 4>{4, 9, 25, 50}, random);
    return twice(rigid_box(points, dimension, one_of(std::array{0.0, 0.3, 1.0}, random), seed));
  };
}

Generator elastic_twice(Index dimension) {
  return [=](unsigned seed) {
    std::mt19937 random(seed);
    const double friction = one_of(std::array{0.0, 0.3, 1.0}, random);
    const auto size = Index(random() % 50);
    if (dimension == 2) return twice(random_problem(10 + size, 2, friction, seed, 3.0));
    FrictionProblem problem = half_space_problem(3 + size % 6, friction);
    problem.q += 0.05 * uniform(problem.q.size(), random);
    return twice(problem);
  };
}

/// `push` 1: in, -1: out; `preload`: depth of an earlier push.
Generator wedge(Index dimension, double push, double softness, double preload) {
  return [=](unsigned seed) {
    std::mt19937 random(seed);
    const double friction = one_of(std::array{0.5, 1.0, 2.0, 3.0}, random);
    const double angle =
        one_of(std::array{10.0, 20.0, 30.0, 45.0, 60.0, 70.0, 80.0}, random) * std::numbers::pi / 180.0;
    const Index points = one_of(std::array<Index, 6>{2, 3, 4, 8, 16, 30}, random);
    return wedged_body(std::max(points, dimension), dimension, friction, angle, push, softness, preload, seed);
  };
}

Generator unequal(Index dimension, double power) {
  return [=](unsigned seed) {
    std::mt19937 random(seed);
    const double friction = one_of(std::array{0.0, 0.3, 1.0, 3.0}, random);
    const auto points = Index(5 + 5 * (random() % 12));
    return unequal_bodies(points, dimension, friction, 12.0, power, seed);
  };
}

/// Returns the problem with D W D and D q.
FrictionProblem scaled(FrictionProblem problem, const Vector& scales) {
  problem.w = scales.asDiagonal() * problem.w * scales.asDiagonal();
  problem.q = scales.cwiseProduct(problem.q);
  return problem;
}

Generator unequal_rigid(Index dimension) {
  return [=](unsigned seed) {
    std::mt19937 random(seed);
    const Index points = one_of(std::array<Index, 4>{4, 9, 25, 50}, random);
    const FrictionProblem problem = rigid_box(points, dimension, one_of(std::array{0.0, 0.3, 1.0}, random), seed);
    return scaled(problem, decades_of(problem.points(), dimension, 6.0, 1, random));
  };
}

Generator uneven_rows(Index dimension) {
  return [=](unsigned seed) {
    std::mt19937 random(seed);
    const double friction = one_of(std::array{0.0, 0.3, 1.0, 3.0}, random);
    const auto points = Index(5 + 5 * (random() % 8));
    const FrictionProblem problem = unequal_bodies(points, dimension, friction, 0.0, 1.0, seed);
    Vector scales(problem.q.size());
    for (double& scale : scales) scale = std::pow(10.0, 1.5 * uniform(random));
    return scaled(problem, scales);
  };
}

std::vector<Kind> kinds(Index d) {
  return {{"redundant points, F ≤ 1", {rigid(d, 0.0), rigid(d, 0.3), rigid(d, 1.0), rigid_twice(d), elastic_twice(d)}},
          {"rigid bodies, F = 3", {rigid(d, 3.0)}},
          {"wedge, rigid", {wedge(d, 1.0, 0.0, 0.0)}},
          {"wedge, softness 0.1", {wedge(d, 1.0, 0.1, 0.0), wedge(d, -1.0, 0.1, 1.0)}},
          {"wedge, softness 1e-3", {wedge(d, 1.0, 1e-3, 0.0), wedge(d, -1.0, 1e-3, 1.0), wedge(d, 1.0, 1e-3, -0.3)}},
          {"wedge, softness 1e-6", {wedge(d, 1.0, 1e-6, 0.0), wedge(d, -1.0, 1e-6, 1.0)}},
          {"12 orders of magnitude", {unequal(d, 1.0), unequal(d, 0.0), unequal(d, 2.0), unequal_rigid(d)}},
          {"3 orders within a point", {uneven_rows(d)}}};
}

constexpr std::array tolerances{1e-8, 1e-12};

struct Tally {
  long problems = 0;  ///< number of problems that the solver does not refuse
  std::array<long, tolerances.size()> unsolved{};
  std::vector<double> seconds;  ///< at the first tolerance
  long wrong = 0;               ///< number of answers reported as solved that are not

  void add(const Tally& other) {
    problems += other.problems;
    for (std::size_t k = 0; k < unsolved.size(); ++k) unsolved[k] += other.unsolved[k];
    seconds.insert(seconds.end(), other.seconds.begin(), other.seconds.end());
    wrong += other.wrong;
  }

  [[nodiscard]] std::string text() const {
    if (problems == 0) return "–";
    std::vector<double> sorted = seconds;
    std::ranges::sort(sorted);
    const double median = 1e3 * sorted[sorted.size() / 2];
    const double percent = 100.0 / double(problems);
    char result[80];
    std::snprintf(result, sizeof result, "%.2g / %.2g; %.2g", percent * double(unsolved[0]),
                  percent * double(unsolved[1]), median);
    return std::isfinite(median) ? result : std::string(result).substr(0, std::string(result).find(';')) + "; –";
  }
};

Tally solve(const std::string& name, const Generator& generate, unsigned seeds) {
  Tally tally;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const ContactProblem problem = generate(seed).contact();
    for (std::size_t k = 0; k < tolerances.size(); ++k) {
      const auto solver = make_contact_solver(name);
      ContactSolution solution;
      const ProcessorTimer timer;
      solver->analyse(problem);
      solver->solve(problem, {.tolerance = tolerances[k]}, solution);
      const double seconds = timer.seconds();
      if (solution.outcome == ContactOutcome::not_applicable) break;
      if (k == 0) ++tally.problems;
      if (k == 0) tally.seconds.push_back(solution.solved() ? seconds : std::numeric_limits<double>::infinity());
      if (!solution.solved()) {
        ++tally.unsolved[k];
        continue;
      }
      // The judge allows for the rounding at each point, and in addition for half of the solution's own floor.
      const Judgement judgement = judge(problem, solution.reaction);
      const bool good = judgement.beyond_rounding <= tolerances[k] * (1.0 + 1e-6) + 0.5 * solution.rounding_floor;
      if (good && judgement.outside_cone <= 1e-15) continue;
      ++tally.wrong;
      std::fprintf(stderr, "%s, seed %u, tolerance %g: reported as solved, residual %g\n", name.c_str(), seed,
                   tolerances[k], judgement.residual);
    }
  }
  return tally;
}

void print_row(const std::string& name, long problems, const std::vector<Tally>& tallies) {
  std::printf("| %s | %ld |", name.c_str(), problems);
  for (const Tally& tally : tallies) std::printf(" %s |", tally.text().c_str());
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** values) {
  const auto seeds = unsigned(count > 1 ? std::atoi(values[1]) : 500);
  const auto seeds_of_others = unsigned(count > 2 ? std::atoi(values[2]) : 30);
  std::vector<std::string> solvers;
  for (const auto& solver : contact_solver_registry().all()) {
    if (solver.name != "active-set") solvers.push_back(solver.name);  // for definite W without friction or in 2D only
  }
  std::string head = "| | problems |", rule = "|---|---|";
  for (const std::string& name : solvers) head += " " + name + " |", rule += "---|";
  std::printf("%s\n%s\n", head.c_str(), rule.c_str());
  long wrong = 0;
  for (const Index dimension : {2, 3}) {
    const std::string prefix = dimension == 2 ? "2D, " : "3D, ";
    std::vector<Tally> all(solvers.size());
    long problems = 0;
    for (const Kind& kind : kinds(dimension)) {
      std::vector<Tally> tallies(solvers.size());
      for (const Generator& generate : kind.generators) {
        for (std::size_t s = 0; s < solvers.size(); ++s)
          tallies[s].add(solve(solvers[s], generate, solvers[s] == "automatic" ? seeds : seeds_of_others));
      }
      const long of_kind = long(kind.generators.size()) * seeds;
      print_row(prefix + kind.name, of_kind, tallies);
      problems += of_kind;
      for (std::size_t s = 0; s < solvers.size(); ++s) {
        all[s].add(tallies[s]);
        wrong += tallies[s].wrong;
      }
    }
    print_row(prefix + "all", problems, all);
  }
  std::printf("\nReported as solved, but not solved: %ld.\n", wrong);
  return wrong == 0 ? 0 : 1;
}
