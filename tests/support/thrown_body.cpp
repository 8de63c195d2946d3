#include "support/thrown_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "ricochet/case/names.hpp"
#include "support/case_run.hpp"
#include "support/paths.hpp"
#include "support/two_bodies.hpp"

namespace ricochet::test_support {

std::vector<ThrownBody> thrown_bodies() {
  const std::string disc = "Disk(1)={0,1.02,0,1}; Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1};";
  const std::string ball = "Sphere(1)={0,0,1.02,1}; Physical Volume(\"body\")={1}; Physical Surface(\"contact\")={1};";
  return {{"disc of triangles", 2, 1, mesh_geometry("disc", disc, 0.3, 1)},
          {"disc of quadrilaterals", 2, 1, mesh_geometry("quads", disc + " Recombine Surface{1};", 0.3, 1)},
          {"curved disc of degree 2", 2, 2, mesh_geometry("disc2", disc, 0.5, 2)},
          {"ball of tetrahedra", 3, 1, mesh_geometry("ball", ball, 0.45, 1)},
          {"curved ball of degree 2", 3, 2, mesh_geometry("ball2", ball, 0.7, 2)},
          thrown_pair(2),
          thrown_pair(3)};
}

ThrownBody thrown_pair(int dimension) {
  const int up = dimension - 1;
  const bool flat = dimension == 2;
  StackedBoxes stack{flat ? CellShape::triangle : CellShape::hexahedron,
                     flat ? CellShape::quadrilateral : CellShape::tetrahedron};
  stack.lower_counts = flat ? std::vector{5, 4} : std::vector{3, 3, 4};
  stack.upper_counts = flat ? std::vector{7, 4} : std::vector{3, 4, 4};
  stack.lower_map = [up](const Vector& x) {
    Vector y = x;
    y[up] = 0.8 * x[up] - x[up] * (0.2 * std::pow(x[0] - 0.6, 2) + 0.05 * x[0]);
    return y;
  };
  stack.upper_map = [up](const Vector& x) {
    Vector y = x;
    y[0] += 0.13;
    y[up] = 0.82 + 0.7 * x[up] + (1.0 - x[up]) * 0.15 * std::pow(x[0] - 0.4, 2);
    return y;
  };
  Mesh mesh = make_stack(stack);
  for (Group& group : mesh.groups) {
    if (group.name == (flat ? "upper.y0" : "upper.z0")) group.name = "contact";
    if (group.name == (flat ? "lower.y1" : "lower.z1")) group.name = "opposite";
  }
  return {flat ? "two blocks" : "two bricks", dimension, 1, write_mesh(fmt::format("pair{}.msh", dimension), mesh),
          "opposite"};
}

ThrownBody one_sided_block() {
  return {
      "block", 2, 1,
      mesh_geometry("block",
                    "Rectangle(1)={0,0.03,0,1,0.7}; Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1};",
                    0.2, 1)};
}

namespace {

/// Returns the step: the critical step of lumped masses is that of the smallest cells.
std::string step_of(const std::string& time) {
  const bool is_explicit = time.find("\"cd-lagrange\"") != std::string::npos ||
                           time.find("\"taylor-flanagan\"") != std::string::npos ||
                           time.find("\"explicit\"") != std::string::npos;
  return is_explicit ? "step = 0.0015\n" : "step = 0.01\n";
}

}  // namespace

std::string thrown_case(const ThrownBody& body, const std::string& mass, const std::string& time,
                        const std::string& contact, const std::string& obstacle) {
  const bool flat = body.dimension == 2;
  const std::string pair = "against = \"" + body.against + "\"\n[[motion]]\ngroup = \"lower.body\"\nvelocity = " +
                           (flat ? "[0.1, 0.8]\nspin = 0.2\n" : "[0.1, -0.1, 0.8]\nspin = [0.1, 0.2, 0.1]\n");
  return "[mesh]\nfile = \"" + body.mesh + "\"\ndegree = " + std::to_string(body.degree) +
         "\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nlambda = 30.0\nmu = 20.0\n"
         "[obstacle.plane]\ntype = \"plane\"\n" +
         (flat ? "point = [0.0, 0.0]\nnormal = [0.1, 1.0]\n"
               : "point = [0.0, 0.0, 0.0]\nnormal = [0.1, -0.05, 1.0]\n") +
         obstacle + "[[contact]]\ngroup = \"contact\"\n" +
         (body.against.empty() ? "obstacle = \"plane\"\n" + contact : contact + pair) + "[load]\n" +
         (flat ? "gravity = [0.3, -1.0]\n[initial]\nvelocity = [\"0.1-0.2*y\", \"-0.5+0.2*x\"]\n"
               : "gravity = [0.3, 0.1, -1.0]\n[initial]\nvelocity = [\"0.1-0.2*z\", \"0.1\", \"-0.5+0.2*x\"]\n") +
         "[mass]\ntype = \"" + mass + "\"\n[time]\n" + time + step_of(time) + "end = 1.5\n";
}

std::string dragged_case(const ThrownBody& body, const std::string& mass, const std::string& time,
                         const std::string& contact) {
  const bool flat = body.dimension == 2;
  std::string text =
      thrown_case(body, mass, time, contact, flat ? "velocity = [0.2, 0.0]\n" : "velocity = [0.2, 0.1, 0.0]\n");
  if (time.find("\"nonsmooth-generalized-alpha\"") == std::string::npos)
    text.replace(text.find("mu = 20.0\n"), 10, "mu = 20.0\ndamping = { mass = 0.05 }\n");
  return text + "[[traction]]\ngroup = \"contact\"\nvalue = " +
         (flat ? "[\"0.1*sin(9*t)\", \"x\"]\n" : "[\"0.1*sin(9*t)\", \"0\", \"y\"]\n");
}

std::string time_of(const std::string& scheme) {
  return "scheme = \"" + scheme + "\"\n" + (scheme == "newmark" ? "beta = 0.3025\ngamma = 0.6\n" : "");
}

std::vector<std::string> masses_of(const std::string& scheme) {
  static const std::map<std::string, std::vector<std::string>> known = {
      {"semi-explicit", {"equivalent-lumped"}},
      {"cd-lagrange", {"lumped"}},
      {"taylor-flanagan", {"lumped"}},
  };
  if (const auto found = known.find(scheme); found != known.end()) return found->second;
  static const std::set<std::string> with_inertia = {"midpoint",
                                                     "klr-conserving",
                                                     "contact-stabilized",
                                                     "kane",
                                                     "laursen-chawla",
                                                     "moreau-jean",
                                                     "paoli-schatzman",
                                                     "laursen-love",
                                                     "penalty-midpoint",
                                                     "nonsmooth-generalized-alpha",
                                                     "nitsche"};
  if (with_inertia.contains(scheme)) return {"consistent", "lumped"};
  std::vector<std::string> result = mass_names();
  if (scheme.starts_with("reduced-") || scheme == "mean-reaction")
    std::erase_if(result, [](const std::string& mass) { return !mass.starts_with("equivalent"); });
  return result;
}

bool takes_friction(const std::string& scheme) {
  return scheme != "mean-reaction" && scheme != "reduced-midpoint" && scheme != "penalty-midpoint" &&
         scheme != "nitsche" && scheme != "nonsmooth-generalized-alpha";
}

bool takes_damping(const std::string& scheme) { return scheme != "nonsmooth-generalized-alpha"; }

bool takes_stiffness_damping(const std::string& scheme) {
  return takes_damping(scheme) && scheme != "mean-reaction" && scheme != "reduced-midpoint" &&
         scheme != "semi-explicit";
}

bool Discretization::is_possible() const {
  const std::vector<std::string> masses = masses_of(scheme);
  return std::ranges::find(masses, mass) != masses.end();
}

std::string Discretization::time() const { return time_of(scheme); }

std::string Discretization::contact() const {
  return std::string(takes_friction(scheme) ? "friction = 0.3\n" : "") + "multipliers = \"" + multipliers +
         "\"\nunstable_multipliers = \"allow\"\n";
}

std::vector<Discretization> all_discretizations() {
  std::vector<Discretization> result;
  for (const std::string& scheme : scheme_names()) {
    for (const std::string& mass : mass_names()) {
      for (const std::string& multipliers : multiplier_space_names()) result.push_back({scheme, mass, multipliers});
    }
  }
  return result;
}

std::vector<SupportedCase> moving_support_cases() {
  std::vector<SupportedCase> result;
  for (const auto& [scheme, mass] :
       {std::pair{"newmark\"\npreset = \"trapezoidal", "equivalent"}, std::pair{"midpoint", "consistent"},
        std::pair{"klr-conserving", "consistent"}, std::pair{"semi-explicit", "equivalent-lumped"},
        std::pair{"contact-stabilized", "consistent"}, std::pair{"reduced-kane", "equivalent"},
        std::pair{"reduced-kane\"\nreaction_weight = \"adaptive", "equivalent"},
        std::pair{"mean-reaction", "equivalent"}, std::pair{"reduced-midpoint", "equivalent"}}) {
    const std::string name = scheme;
    const char* const friction = takes_friction(name) ? "friction = 0.4\n" : "";
    result.push_back({scheme, "[mesh]\nfile = \"" + data_path("meshes/quadrilateral_o1_msh41_ascii.msh") +
                                  "\"\n"
                                  "[[material]]\ngroup = \"body\"\ndensity = 1.0\nlambda = 100.0\nmu = 50.0\n"
                                  "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.05]\nnormal = [0.0, 1.0]\n"
                                  "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n" +
                                  friction +
                                  "[[support]]\ngroup = \"sides\"\ncomponents = [\"x\", \"y\"]\nvalue = "
                                  "\"-0.1*sin(7*t)\"\n[mass]\ntype = \"" +
                                  std::string(mass) + "\"\n[time]\nscheme = \"" + scheme +
                                  "\"\nstep = 0.004\nend = 0.8\n"});
  }
  return result;
}

}  // namespace ricochet::test_support
