// Random cases of every kind under every scheme, and the change of their energy: a line of CSV per case and method.
//
//   ricochet_random_cases plane|sphere|turn|pair|slide FIRST COUNT [METHOD [FOLDER]]
//
// runs the cases with these numbers on one kind of obstacle, or of pairs of bodies; METHOD selects methods whose name
// contains it; FOLDER receives the files of the cases.
//
// run.py makes the tables of docs/energy.md from the output.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>

#include "random_case.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/run/session.hpp"

using namespace ricochet;

namespace {

struct Method {
  const char *name, *time, *mass;
  bool takes_friction = true;
};
const std::array<Method, 27> methods{
    {{"reduced-kane end, equivalent", "scheme = \"reduced-kane\"\nreaction_weight = \"end\"\n", "equivalent"},
     {"reduced-kane adaptive, equivalent", "scheme = \"reduced-kane\"\nreaction_weight = \"adaptive\"\n", "equivalent"},
     {"reduced-kane, equivalent", "scheme = \"reduced-kane\"\n", "equivalent"},
     {"reduced-kane, equivalent-cellwise", "scheme = \"reduced-kane\"\n", "equivalent-cellwise"},
     {"reduced-kane, equivalent-lumped", "scheme = \"reduced-kane\"\n", "equivalent-lumped"},
     {"mean-reaction, equivalent", "scheme = \"mean-reaction\"\n", "equivalent", false},
     {"reduced-midpoint, equivalent", "scheme = \"reduced-midpoint\"\n", "equivalent", false},
     {"contact-stabilized, consistent", "scheme = \"contact-stabilized\"\n", "consistent"},
     {"contact-stabilized, lumped", "scheme = \"contact-stabilized\"\n", "lumped"},
     {"newmark trapezoidal, equivalent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n", "equivalent"},
     {"newmark 0.3025 0.6, equivalent", "scheme = \"newmark\"\nbeta = 0.3025\ngamma = 0.6\n", "equivalent"},
     {"newmark trapezoidal, consistent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n", "consistent"},
     {"newmark 0.3025 0.6, consistent", "scheme = \"newmark\"\nbeta = 0.3025\ngamma = 0.6\n", "consistent"},
     {"klr-conserving, consistent", "scheme = \"klr-conserving\"\n", "consistent"},
     {"midpoint, consistent", "scheme = \"midpoint\"\n", "consistent"},
     {"kane, consistent", "scheme = \"kane\"\n", "consistent"},
     {"laursen-chawla, consistent", "scheme = \"laursen-chawla\"\n", "consistent"},
     {"laursen-love, consistent", "scheme = \"laursen-love\"\n", "consistent"},
     {"paoli-schatzman, consistent", "scheme = \"paoli-schatzman\"\n", "consistent"},
     {"moreau-jean, consistent", "scheme = \"moreau-jean\"\n", "consistent"},
     {"generalized-alpha, consistent", "scheme = \"generalized-alpha\"\n", "consistent"},
     {"generalized-alpha, equivalent", "scheme = \"generalized-alpha\"\n", "equivalent"},
     {"nonsmooth-generalized-alpha, consistent", "scheme = \"nonsmooth-generalized-alpha\"\n", "consistent", false},
     {"bathe, consistent", "scheme = \"bathe\"\n", "consistent"},
     {"bathe, equivalent", "scheme = \"bathe\"\n", "equivalent"},
     {"penalty-midpoint, consistent", "scheme = \"penalty-midpoint\"\n", "consistent", false},
     {"nitsche, consistent", "scheme = \"nitsche\"\n", "consistent", false}}};

struct CaseResult {
  std::string failure;
  double created = 0.0, lost = 0.0, penetration = 0.0, variation = 0.0, largest = 0.0;
  int held = 0;  ///< steps that are frozen with a gap or an overlap
};

RandomCase make_case(const std::string& kind, unsigned number, const std::filesystem::path& folder) {
  if (kind == "pair" || kind == "slide") return make_pair_case(number, kind == "slide", folder);
  return make_obstacle_case(
      number, kind == "plane" ? ObstacleKind::plane : (kind == "sphere" ? ObstacleKind::sphere : ObstacleKind::turning),
      folder);
}

/// Runs a case. Energy less the work of loads, supports and obstacles must not grow. All results are relative to the
/// largest energy.
CaseResult run_case_with(const RandomCase& random_case, const Method& method) {
  CaseResult result;
  const std::string text =
      random_case.text + fmt::format("[mass]\ntype = \"{}\"\n[time]\n{}step = {:.17g}\nend = {:.17g}\n", method.mass,
                                     method.time, random_case.step, random_case.step * random_case.steps);
  try {
    Session session(read_case_text(text, "random.toml", {}));
    session.start();
    double least = 0.0, first = 0.0, created = 0.0, size = 0.0, before = 0.0, last = 0.0;
    Vector gap;
    bool begins = true;
    const auto look = [&] {
      EnergyAccount account = session.simulation().account();
      const Energies now = account.energies(session.state());
      const Works& works = account.works();
      last = now.total() + now.algorithmic - works.load - works.support - works.obstacle;
      size = std::max({size, now.kinetic, now.elastic, std::abs(works.support), std::abs(works.obstacle),
                       std::abs(works.load), std::abs(works.friction)});
      if (begins) first = least = last;
      created = std::max(created, last - least);
      least = std::min(least, last);
      session.problem().gaps(session.state().displacement, session.time(), gap);
      if (!begins) result.penetration = std::max(result.penetration, -gap.minCoeff() / random_case.cell);
      const double force = session.state().forces.normal_reaction.sum();
      result.variation += begins ? 0.0 : std::abs(force - before);
      result.largest = std::max(result.largest, force);
      before = force;
      constexpr double felt = 1e-8;  // of a cell
      if (account.unsettled_gap() > felt * random_case.cell) ++result.held;
      begins = false;
    };
    look();
    while (session.step()) look();
    result.created = size > 0.0 ? created / size : 0.0;
    result.lost = size > 0.0 ? (first - last) / size : 0.0;
  } catch (const Error& error) {
    result.failure = error.what();
    std::ranges::replace(result.failure, '"', '\'');
    std::ranges::replace(result.failure, '\n', ' ');
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  const std::array<std::string, 5> kinds{"plane", "sphere", "turn", "pair", "slide"};
  if (argc < 4 || std::ranges::find(kinds, kind) == kinds.end()) {
    std::cerr << "usage: ricochet_random_cases plane|sphere|turn|pair|slide FIRST COUNT [METHOD [FOLDER]]\n";
    return 1;
  }
  log::set_level(log::Level::off);
  const auto first = unsigned(std::strtoul(argv[2], nullptr, 10));
  const auto count = unsigned(std::strtoul(argv[3], nullptr, 10));
  const std::string wanted = argc > 4 ? argv[4] : "";
  const bool keeps = argc > 5;
  const std::filesystem::path folder =
      keeps ? std::filesystem::path(argv[5])
            : std::filesystem::temp_directory_path() / fmt::format("ricochet_random_{}", getpid());
  std::filesystem::create_directories(folder);
  std::cout << "case,description,friction,crossings,method,created,lost,penetration,variation,largest,held,failure\n";
  for (unsigned number = first; number < first + count; ++number) {
    const RandomCase random_case = make_case(kind, number, folder);
    if (keeps) {
      std::ofstream(folder / fmt::format("case_{}.toml", number))
          << random_case.text << fmt::format("# time.step = {:.17g}, {} steps\n", random_case.step, random_case.steps);
    }
    for (const Method& method : methods) {
      if (!method.takes_friction && random_case.friction > 0.0) continue;
      if (std::string(method.name).find(wanted) == std::string::npos) continue;
      const CaseResult outcome = run_case_with(random_case, method);
      fmt::print("{},\"{}\",{:.3g},{:.3g},\"{}\",{:.3e},{:.3e},{:.3e},{:.4e},{:.4e},{},\"{}\"\n", number,
                 random_case.description, random_case.friction, random_case.crossings, method.name, outcome.created,
                 outcome.lost, outcome.penetration, outcome.variation, outcome.largest, outcome.held, outcome.failure);
    }
    if (keeps) continue;
    std::filesystem::remove(folder / fmt::format("mesh_{}.msh", number));
    std::filesystem::remove(folder / fmt::format("mesh_{}_upper.msh", number));
  }
  if (!keeps) std::filesystem::remove_all(folder);
  return 0;
}
