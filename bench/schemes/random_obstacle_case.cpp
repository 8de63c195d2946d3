#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <utility>
#include <vector>

#include "random_case.hpp"

std::string vector_text(int d, const std::array<double, 3>& of) {
  return d == 2 ? fmt::format("[{:.9g}, {:.9g}]", of[0], of[1])
                : fmt::format("[{:.9g}, {:.9g}, {:.9g}]", of[0], of[1], of[2]);
}

namespace {

/// Returns a ball under the middle of a box, or a hollow that its lower corners touch first; 0.3 to 100 times as large.
std::string sphere_text(Random& random, int d, double size, double gap) {
  const bool hollow = random.chance(0.5);
  const double radius = size * (hollow ? random.power(0.2, 2.0) : random.power(-0.5, 2.0));
  std::array<double, 3> centre{0.5 * size, 0.5 * size, 0.5 * size};
  const double half_diagonal = 0.5 * size * std::sqrt(d - 1.0);
  centre[std::size_t(d - 1)] =
      hollow ? std::sqrt(radius * radius - half_diagonal * half_diagonal) - gap : -radius - gap;
  return fmt::format("type = \"sphere\"\ncentre = {}\nradius = {:.9g}\nside = \"{}\"\n", vector_text(d, centre), radius,
                     hollow ? "inside" : "outside");
}

/// Returns a rotation by at most half a radian over the run, about a point within the size of the body, or about the
/// obstacle's own axis for a circle or, in space, a plane.
std::string rotation_text(Random& random, int d, bool sphere, double size, double rate) {
  rate *= random.between(-1.0, 1.0);
  if (random.chance(0.4) && sphere == (d == 2)) return fmt::format("rotation_rate = {:.9g}\n", rate);
  std::array<double, 3> about{};
  for (double& coordinate : about) coordinate = size * random.between(-0.5, 1.5);
  const std::string at = fmt::format("about = {}\n", vector_text(d, about));
  if (d == 2) return fmt::format("rotation = \"{:.9g}*t\"\n", rate) + at;
  return fmt::format("rotation = [\"{:.9g}*t\", \"{:.9g}*t\", \"{:.9g}*t\"]\n", 0.3 * rate * random.between(-1.0, 1.0),
                     0.3 * rate * random.between(-1.0, 1.0), rate) +
         at;
}

}  // namespace

RandomCase make_obstacle_case(unsigned seed, ObstacleKind kind, const std::filesystem::path& folder) {
  Random random(seed);
  const bool turning = kind == ObstacleKind::turning;
  const bool sphere = turning ? random.chance(0.5) : kind == ObstacleKind::sphere;
  RandomCase result;
  const int d = random.chance(0.65) ? 2 : 3;
  const bool simplices = random.chance(0.5);
  const int degree = random.chance(d == 2 ? 0.4 : 0.2) ? 2 : 1;
  std::array<int, 3> counts{};
  for (int k = 0; k < 3; ++k) counts[std::size_t(k)] = d == 2 ? random.integer(3, 9) : random.integer(3, 4);
  const double size = random.power(-2.0, 0.0);
  const double aspect = random.chance(0.25) ? random.between(2.0, 5.0) : random.between(0.5, 1.5);
  std::array<double, 3> lengths{size, size * aspect, size};
  if (d == 3) std::swap(lengths[1], lengths[2]);
  const auto up = std::size_t(d - 1);
  result.cell = 1e300;
  for (std::size_t k = 0; k < std::size_t(d); ++k) result.cell = std::min(result.cell, lengths[k] / counts[k]);
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
  for (std::size_t k = 0; k < std::size_t(d); ++k) velocity[k] = speed * random.between(-1.0, 1.0);
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
    for (std::size_t k = 0; k < std::size_t(d); ++k)
      drift[k] = speed * random.between(-1.0, 1.0) * (k == up ? 0.2 : 1.0);
    if (turning) {
      text += "motion = [";
      for (std::size_t k = 0; k < std::size_t(d); ++k)
        text += fmt::format("{}\"{:.9g}*t\"", k == 0 ? "" : ", ", drift[k]);
      text += "]\n";
    } else {
      text += "velocity = " + vector_text(d, drift) + "\n";
    }
  }
  if (turning) text += rotation_text(random, d, sphere, size, std::min(speed / size, 0.5 / time));
  constexpr std::array<const char*, 4> spaces{"p0", "p1", "dual", "nodal"};
  const std::string law = fmt::format("friction = {:.9g}\nmultipliers = \"{}\"\nunstable_multipliers = \"allow\"\n",
                                      result.friction, spaces[std::size_t(random.integer(0, 3))]);
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
  result.description =
      fmt::format("{}D degree {} {} F {:.2f} nu {:.2f} crossings {:.3g}{}{}{}{}{}", d, degree,
                  simplices ? "simplices" : "boxes", result.friction, poisson, result.crossings,
                  supported ? " supported" : "", moving ? " moving" : "", two ? " two-planes" : "",
                  damped ? " damped" : "", turning ? (sphere ? " turning sphere" : " turning plane") : "");
  return result;
}
