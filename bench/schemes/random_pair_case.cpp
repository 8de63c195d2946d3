#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "random_case.hpp"

namespace {

struct Box {
  std::array<int, 3> counts{};
  std::array<double, 3> lengths{};
  double cell = 1e300;
};

Box make_box(Random& random, int d, double size) {
  Box box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.counts[k] = d == 2 ? random.integer(3, 9) : random.integer(3, 4);
    box.lengths[k] = size * random.between(0.5, 1.5);
    if (k < std::size_t(d)) box.cell = std::min(box.cell, box.lengths[k] / box.counts[k]);
  }
  return box;
}

/// Returns the position, along x and the last axis, of the lowest corner of a box that is rotated about the origin in
/// the plane of these axes.
std::array<double, 2> lowest_corner(const Box& box, int d, double degrees) {
  const double angle = degrees * M_PI / 180.0, sign = d == 2 ? 1.0 : -1.0;
  std::array<double, 2> lowest{0.0, 1e300};
  for (const double x : {0.0, box.lengths[0]}) {
    for (const double y : {0.0, box.lengths[std::size_t(d - 1)]}) {
      const std::array<double, 2> turned{x * std::cos(angle) - sign * y * std::sin(angle),
                                         sign * x * std::sin(angle) + y * std::cos(angle)};
      if (turned[1] < lowest[1]) lowest = turned;
    }
  }
  return lowest;
}

}  // namespace

RandomCase make_pair_case(unsigned seed, bool sliding, const std::filesystem::path& folder) {
  Random random(seed);
  RandomCase result;
  const int d = random.chance(0.65) ? 2 : 3;
  const auto up = std::size_t(d - 1);
  const bool lower_simplices = random.chance(0.5), upper_simplices = random.chance(0.5);
  const int degree = random.chance(d == 2 ? 0.4 : 0.2) ? 2 : 1;
  const double size = random.power(-2.0, 0.0);
  Box lower = make_box(random, d, size), upper = make_box(random, d, size * random.power(-0.5, 0.5));
  const std::string lower_mesh = (folder / fmt::format("mesh_{}.msh", seed)).string(),
                    upper_mesh = (folder / fmt::format("mesh_{}_upper.msh", seed)).string();
  std::ofstream(lower_mesh) << box_mesh(random, d, lower_simplices, lower.counts, lower.lengths);
  std::ofstream(upper_mesh) << box_mesh(random, d, upper_simplices, upper.counts, upper.lengths);
  result.cell = std::min(lower.cell, upper.cell);

  const double density = random.power(0.0, 6.0), young = random.power(3.0, 9.0);
  const double ratio = random.power(-3.0, 3.0) * (random.chance(0.3) ? random.power(-3.0, 3.0) : 1.0);
  const double heaviness = random.power(-1.0, 1.0);
  const double wave = std::sqrt(young / density), crossing = result.cell / wave;
  result.crossings = random.power(-1.0, 3.0);
  result.step = result.crossings * crossing;
  result.steps = random.integer(60, 120);
  result.end = result.step * (result.steps - 0.5);
  result.friction = random.chance(0.3) ? 0.0 : random.between(0.0, 0.9);

  const double speed = wave * random.power(-5.0, -2.0), time = result.end;
  const bool on_floor = random.chance(0.4), damped = random.chance(0.25);
  const double gravity = on_floor ? speed / time * random.between(0.0, 20.0) : 0.0;
  std::array<double, 3> move{0.0, 0.0, 0.0}, velocity{0.0, 0.0, 0.0}, other{0.0, 0.0, 0.0}, pull{0.0, 0.0, 0.0},
      normal{0.0, 0.0, 0.0};
  velocity[up] = -speed * random.between(0.1, 1.0);
  if (!on_floor) {
    for (std::size_t k = 0; k < std::size_t(d); ++k) other[k] = 0.5 * speed * random.between(0.0, 1.0);
  }
  // They meet within the first half of the run. Tilted bodies meet at a corner, which is above the other body.
  const double gap = random.chance(0.3) ? 0.0 : (other[up] - velocity[up]) * time * random.between(0.02, 0.5);
  const double tilt = gap > 0.0 ? random.between(-20.0, 20.0) : 0.0;
  const std::array<double, 2> lowest = lowest_corner(upper, d, tilt);
  for (std::size_t k = 0; k < up; ++k) {
    // From overhanging one end to overhanging the other.
    const double place = random.between(0.0, 1.0), overhang = 0.5 * upper.lengths[k];
    move[k] = tilt != 0.0 && k == 0 ? place * lower.lengths[0] - lowest[0] : place * lower.lengths[k] - overhang;
    velocity[k] = speed * random.between(-1.0, 1.0);
    // Half a length of the lower body, or several.
    const double fast = std::min(lower.lengths[k] / time * random.between(0.2, 2.0), 0.05 * wave);
    if (sliding) velocity[k] += (random.chance(0.5) ? 1.0 : -1.0) * fast;
  }
  move[up] = lower.lengths[up] + gap - lowest[1];
  pull[up] = -gravity;
  normal[up] = 1.0;

  const auto part = [&](const char* name, const std::string& mesh, const std::array<double, 3>& by,
                        const std::array<double, 3>& with, double angle) {
    return fmt::format("[part.{}]\nfile = \"{}\"\nturn = {{ angle = {:.9g}{} }}\nmove = {}\nvelocity = {}\n", name,
                       mesh, angle, d == 3 ? ", axis = [0, 1, 0]" : "", vector_text(d, by), vector_text(d, with));
  };
  const bool finite = sliding && !damped && random.chance(0.5);
  const auto material = [&](const char* name, double of_young, double of_density) {
    std::string text =
        fmt::format("[[material]]\ngroup = \"{}.all\"\ndensity = {:.9g}\nyoung = {:.9g}\npoisson = {:.9g}\n", name,
                    of_density, of_young, random.between(0.0, 0.49));
    if (finite) text += "law = \"neo-hookean\"\n";
    if (damped) text += fmt::format("damping = {{ stiffness = {:.9g} }}\n", crossing * random.power(-1.0, 3.0));
    return text;
  };
  std::string& text = result.text;
  text = fmt::format("[mesh]\ndegree = {}\n", degree) + part("lower", lower_mesh, {}, other, 0.0) +
         part("upper", upper_mesh, move, velocity, tilt) + material("lower", young, density) +
         material("upper", young * ratio, density * heaviness);
  // The stable spaces, which are the only ones that a case accepts by default.
  constexpr std::array<const char*, 3> spaces{"p1", "dual", "nodal"};
  constexpr std::array<const char*, 3> sides{"automatic", "group", "against"};
  const bool may_be_constant = degree == 2 && (d == 2 || !(lower_simplices || upper_simplices));
  const std::string space =
      may_be_constant && random.chance(0.25) ? "p0" : spaces[sliding ? 0 : std::size_t(random.integer(0, 2))];
  const std::string pairing = sliding ? "sliding = \"large\"\n" : "";
  const std::string law = fmt::format("friction = {:.9g}\nmultipliers = \"{}\"\n", result.friction, space);
  // Tilted, so that facets face each other where the bodies will meet.
  text += fmt::format("[[contact]]\ngroup = \"upper.bottom\"\nagainst = \"lower.top\"\nmultipliers_on = \"{}\"\n",
                      sides[std::size_t(random.integer(0, 2))]) +
          pairing + law;
  if (on_floor) {
    text += "[obstacle.floor]\ntype = \"plane\"\npoint = " + vector_text(d, {0.0, 0.0, 0.0}) +
            "\nnormal = " + vector_text(d, normal) + "\n[[contact]]\ngroup = \"lower.bottom\"\nobstacle = \"floor\"\n" +
            law;
  }
  text += "[load]\ngravity = " + vector_text(d, pull) + "\n";
  result.description =
      fmt::format("{}D degree {} {} on {} F {:.2f} stiffness {:.2g} crossings {:.3g}{}{}{}{}", d, degree,
                  upper_simplices ? "simplices" : "boxes", lower_simplices ? "simplices" : "boxes", result.friction,
                  ratio, result.crossings, on_floor ? " on-floor" : "", finite ? " finite" : "",
                  tilt != 0.0 ? " tilted" : "", damped ? " damped" : "");
  return result;
}
