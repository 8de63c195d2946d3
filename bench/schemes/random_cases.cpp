// Random cases of every kind under every scheme, and what became of their energy: a line of CSV per case and method.
//
//   ricochet_random_cases plane|sphere FIRST COUNT [METHOD [FOLDER]]
//
// runs the cases of these numbers on one kind of obstacle; METHOD: only methods whose name contains it; FOLDER receives
// the cases' files.
//
// run.py makes the tables of docs/energy.md from it.

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

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  double power(double low, double high) { return std::pow(10.0, between(low, high)); }
  int integer(int low, int high) { return low + static_cast<int>(between(0.0, 1.0) * (high - low + 1)); }
  bool chance(double part) { return between(0.0, 1.0) < part; }

 private:
  std::mt19937 engine_;  // the same numbers everywhere, unlike the library's distributions
};

/// A box of cells, a little distorted, as a mesh of Gmsh's format 2.2. Facets of the lower side are group "bottom", of
/// all sides "skin", of the upper side "top".
std::string box_mesh(Random& random, int d, bool simplices, const std::array<int, 3>& counts,
                     const std::array<double, 3>& lengths) {
  const int nx = counts[0] + 1, ny = counts[1] + 1, nz = d == 3 ? counts[2] + 1 : 1;
  const auto number = [&](int i, int j, int k) { return 1 + i + nx * (j + ny * k); };
  std::string nodes, cells;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const auto place = [&](int at, int count, double length) {
          const bool inside = at > 0 && at < count;
          return length * (at + (inside ? random.between(-0.15, 0.15) : 0.0)) / count;
        };
        nodes += fmt::format("{} {:.17g} {:.17g} {:.17g}\n", number(i, j, k), place(i, counts[0], lengths[0]),
                             place(j, counts[1], lengths[1]), d == 3 ? place(k, counts[2], lengths[2]) : 0.0);
      }
    }
  }
  int count = 0;
  const auto add = [&](int type, int group, const std::vector<int>& of) {
    cells += fmt::format("{} {} 2 {} {}", ++count, type, group, group);
    for (const int node : of) cells += fmt::format(" {}", node);
    cells += "\n";
  };
  const auto facet = [&](int group, const std::vector<int>& of) {
    if (d == 2) return add(1, group, of);
    if (!simplices) return add(3, group, of);
    add(2, group, {of[0], of[1], of[2]});
    add(2, group, {of[0], of[2], of[3]});
  };
  if (d == 2) {
    for (int i = 0; i < counts[0]; ++i) {
      facet(2, {number(i, 0, 0), number(i + 1, 0, 0)});
      facet(3, {number(i, counts[1], 0), number(i + 1, counts[1], 0)});
    }
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        const int a = number(i, j, 0), b = number(i + 1, j, 0), c = number(i + 1, j + 1, 0), e = number(i, j + 1, 0);
        if (simplices) {
          add(2, 1, {a, b, c});
          add(2, 1, {a, c, e});
        } else {
          add(3, 1, {a, b, c, e});
        }
      }
    }
  } else {
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        for (const int k : {0, counts[2]})
          facet(k == 0 ? 2 : 3, {number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k), number(i, j + 1, k)});
      }
    }
    for (int k = 0; k < counts[2]; ++k) {
      for (int j = 0; j < counts[1]; ++j) {
        for (int i = 0; i < counts[0]; ++i) {
          const std::array<int, 8> v{
              number(i, j, k),     number(i + 1, j, k),     number(i + 1, j + 1, k),     number(i, j + 1, k),
              number(i, j, k + 1), number(i + 1, j, k + 1), number(i + 1, j + 1, k + 1), number(i, j + 1, k + 1)};
          if (!simplices) {
            add(5, 1, {v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]});
            continue;
          }
          // Six tetrahedra around the diagonal 0–6; facets of all cubes are cut alike.
          for (const auto& [p, q] : {std::pair{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}}) {
            add(4, 1, {v[0], v[static_cast<std::size_t>(p)], v[static_cast<std::size_t>(q)], v[6]});
          }
        }
      }
    }
  }
  return fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n{} 1 \"body\"\n{} 2 \"bottom\"\n{} 3 "
      "\"top\"\n$EndPhysicalNames\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n",
      d, d - 1, d - 1, nx * ny * nz, nodes, count, cells);
}

struct RandomCase {
  std::string text, description;  ///< without [time] and [mass]
  double step, end, friction, cell, crossings;
  int steps;
};

std::string vector_text(int d, const std::array<double, 3>& of) {
  return d == 2 ? fmt::format("[{:.9g}, {:.9g}]", of[0], of[1])
                : fmt::format("[{:.9g}, {:.9g}, {:.9g}]", of[0], of[1], of[2]);
}

/// A ball under the middle of a box, or a hollow that its lower corners touch first; 0.3 to 100 times as large.
std::string sphere_text(Random& random, int d, double size, double gap) {
  const bool hollow = random.chance(0.5);
  const double radius = size * (hollow ? random.power(0.2, 2.0) : random.power(-0.5, 2.0));
  std::array<double, 3> centre{0.5 * size, 0.5 * size, 0.5 * size};
  const double half_diagonal = 0.5 * size * std::sqrt(d - 1.0);
  centre[static_cast<std::size_t>(d - 1)] =
      hollow ? std::sqrt(radius * radius - half_diagonal * half_diagonal) - gap : -radius - gap;
  return fmt::format("type = \"sphere\"\ncentre = {}\nradius = {:.9g}\nside = \"{}\"\n", vector_text(d, centre), radius,
                     hollow ? "inside" : "outside");
}

RandomCase make_case(unsigned seed, bool sphere, const std::filesystem::path& folder) {
  Random random(seed);
  RandomCase result;
  const int d = random.chance(0.65) ? 2 : 3;
  const bool simplices = random.chance(0.5);
  const int degree = random.chance(d == 2 ? 0.4 : 0.2) ? 2 : 1;
  std::array<int, 3> counts{};
  for (int k = 0; k < 3; ++k)
    counts[static_cast<std::size_t>(k)] = d == 2 ? random.integer(3, 9) : random.integer(3, 4);
  const double size = random.power(-2.0, 0.0);
  const double aspect = random.chance(0.25) ? random.between(2.0, 5.0) : random.between(0.5, 1.5);
  std::array<double, 3> lengths{size, size * aspect, size};
  if (d == 3) std::swap(lengths[1], lengths[2]);
  const auto up = static_cast<std::size_t>(d - 1);
  result.cell = 1e300;
  for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k)
    result.cell = std::min(result.cell, lengths[k] / counts[k]);
  const std::string mesh = (folder / fmt::format("mesh_{}.msh", seed)).string();
  std::ofstream(mesh) << box_mesh(random, d, simplices, counts, lengths);

  const double density = random.power(0.0, 6.0), young = random.power(3.0, 9.0), poisson = random.between(0.0, 0.49);
  const double modulus = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
  const double wave = std::sqrt(modulus / density), crossing = result.cell / wave;
  result.crossings = random.power(-1.0, 3.0);
  result.step = result.crossings * crossing;
  result.steps = random.integer(60, 120);
  result.end = result.step * (result.steps - 0.5);
  result.friction = random.chance(0.3) ? 0.0 : random.between(0.0, 1.0);

  const double speed = wave * random.power(-5.0, -2.0), time = result.end;
  const double gap = random.chance(0.3) ? 0.0 : speed * time * random.between(0.02, 0.3);
  const double gravity = speed / time * random.between(0.0, 20.0);
  const bool supported = random.chance(0.2), moving = random.chance(0.4), two = random.chance(0.15);
  const bool damped = random.chance(0.25), resting = gap == 0.0 && !supported && random.chance(0.5);
  std::array<double, 3> normal{0.0, 0.0, 0.0}, point{0.0, 0.0, 0.0}, velocity{0.0, 0.0, 0.0}, pull{0.0, 0.0, 0.0};
  normal[up] = 1.0;
  normal[0] = supported ? 0.0 : random.between(-0.05, 0.05);
  point[up] = -gap - std::abs(normal[0]) * size;
  for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k) velocity[k] = speed * random.between(-1.0, 1.0);
  velocity[up] = -std::abs(velocity[up]);
  pull[up] = -gravity;
  pull[0] = gravity * random.between(-0.5, 0.5);

  std::string& text = result.text;
  text = fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = {}\n[[material]]\ngroup = \"body\"\ndensity = {:.9g}\nyoung = "
      "{:.9g}\npoisson = {:.9g}\n",
      mesh, degree, density, young, poisson);
  if (damped) text += fmt::format("damping = {{ stiffness = {:.9g} }}\n", crossing * random.power(-1.0, 3.0));
  text += "[obstacle.floor]\n";
  text += sphere ? sphere_text(random, d, size, gap)
                 : fmt::format("type = \"plane\"\npoint = {}\nnormal = {}\n", vector_text(d, point),
                               vector_text(d, normal));
  if (moving) {
    std::array<double, 3> drift{0.0, 0.0, 0.0};
    for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k)
      drift[k] = speed * random.between(-1.0, 1.0) * (k == up ? 0.2 : 1.0);
    text += "velocity = " + vector_text(d, drift) + "\n";
  }
  constexpr std::array<const char*, 4> spaces{"p0", "p1", "dual", "nodal"};
  const std::string law = fmt::format("friction = {:.9g}\nmultipliers = \"{}\"\nunstable_multipliers = \"allow\"\n",
                                      result.friction, spaces[static_cast<std::size_t>(random.integer(0, 3))]);
  text += "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n" + law;
  if (two) {
    std::array<double, 3> wall_normal{0.0, 0.0, 0.0}, wall_point = point;
    wall_normal[0] = 1.0;
    wall_normal[up] = random.between(0.5, 2.0);
    wall_point[0] = -0.3 * gap - 0.01 * size;
    text += fmt::format("[obstacle.wall]\ntype = \"plane\"\npoint = {}\nnormal = {}\n", vector_text(d, wall_point),
                        vector_text(d, wall_normal)) +
            "[[contact]]\ngroup = \"bottom\"\nobstacle = \"wall\"\n" + law;
  }
  if (supported) {
    text += fmt::format("[[support]]\ngroup = \"top\"\ncomponents = [\"x\", \"y\"]\nvalue = \"{:.9g}*sin({:.9g}*t)\"\n",
                        0.1 * size * random.between(-0.1, 0.1), random.between(1.0, 20.0) / time);
  }
  text += "[load]\ngravity = " + vector_text(d, pull) + "\n[initial]\n";
  text += "velocity = " + (resting ? vector_text(d, {0.0, 0.0, 0.0}) : vector_text(d, velocity)) + "\n";
  result.description = fmt::format("{}D degree {} {} F {:.2f} nu {:.2f} crossings {:.3g}{}{}{}{}", d, degree,
                                   simplices ? "simplices" : "boxes", result.friction, poisson, result.crossings,
                                   supported ? " supported" : "", moving ? " moving" : "", two ? " two-planes" : "",
                                   damped ? " damped" : "");
  return result;
}

struct Outcome {
  std::string failure;
  double created = 0.0, lost = 0.0, penetration = 0.0, variation = 0.0, largest = 0.0;
};

/// Energy less what loads, supports and obstacles have put in: it must not grow. All relative to the largest energy.
Outcome run_case_with(const RandomCase& random_case, const Method& method) {
  Outcome result;
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
      begins = false;
    };
    look();
    while (session.step()) look();
    result.created = size > 0.0 ? created / size : 0.0;
    result.lost = size > 0.0 ? (first - last) / size : 0.0;
  } catch (const Error& error) {
    result.failure = error.what();
    std::replace(result.failure.begin(), result.failure.end(), '"', '\'');
    std::replace(result.failure.begin(), result.failure.end(), '\n', ' ');
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  if (argc < 4 || (kind != "plane" && kind != "sphere")) {
    std::cerr << "usage: ricochet_random_cases plane|sphere FIRST COUNT [METHOD [FOLDER]]\n";
    return 1;
  }
  log::set_level(log::Level::off);
  const auto first = static_cast<unsigned>(std::strtoul(argv[2], nullptr, 10));
  const auto count = static_cast<unsigned>(std::strtoul(argv[3], nullptr, 10));
  const std::string wanted = argc > 4 ? argv[4] : "";
  const bool keeps = argc > 5;
  const std::filesystem::path folder =
      keeps ? std::filesystem::path(argv[5])
            : std::filesystem::temp_directory_path() / fmt::format("ricochet_random_{}", getpid());
  std::filesystem::create_directories(folder);
  std::cout << "case,description,friction,crossings,method,created,lost,penetration,variation,largest,failure\n";
  for (unsigned number = first; number < first + count; ++number) {
    const RandomCase random_case = make_case(number, kind == "sphere", folder);
    if (keeps) std::ofstream(folder / fmt::format("case_{}.toml", number)) << random_case.text;
    for (const Method& method : methods) {
      if (!method.takes_friction && random_case.friction > 0.0) continue;
      if (std::string(method.name).find(wanted) == std::string::npos) continue;
      const Outcome outcome = run_case_with(random_case, method);
      fmt::print("{},\"{}\",{:.3g},{:.3g},\"{}\",{:.3e},{:.3e},{:.3e},{:.4e},{:.4e},\"{}\"\n", number,
                 random_case.description, random_case.friction, random_case.crossings, method.name, outcome.created,
                 outcome.lost, outcome.penetration, outcome.variation, outcome.largest, outcome.failure);
    }
    if (!keeps) std::filesystem::remove(folder / fmt::format("mesh_{}.msh", number));
  }
  if (!keeps) std::filesystem::remove_all(folder);
  return 0;
}
