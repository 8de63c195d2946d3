#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ricochet/simulation/history/history.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"
#include "support/two_bodies.hpp"

/// @file The reaction of a support on a face that shares nodes with a contact, compared with statics.
namespace ricochet::test_support::support_probe_test {

constexpr double weight = 3.0;

std::string sheared_mesh(CellShape shape, int count) {
  const int d = dimension(shape);
  BoxMesh box = box_of(shape, std::vector<int>(std::size_t(d), count));
  // The bottom lies on the slope 3 : 4; the side x0 stays upright.
  box.map = [d](const Vector& x) {
    Vector result = x;
    result[d - 1] -= 0.75 * x[0];
    return result;
  };
  return write_mesh(fmt::format("sheared-{}-{}.msh", name(shape), count), make_box_mesh(box));
}

/// A body of unit volume on a slope without friction, held by its upright side alone: N n + R e_x + W = 0 with n =
/// (0.6, …, 0.8) gives R = −0.75 W. Its lowest nodes are both held and pressed.
std::string on_a_slope(CellShape shape, int count, const std::string& law, const std::string& mass,
                       const std::string& time) {
  const int d = dimension(shape);
  const bool flat = d == 2;
  std::string text = fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = 1\n[[material]]\ngroup = \"body\"\ndensity = 1.0\n{}[obstacle.slope]\ntype = "
      "\"plane\"\npoint = {}\nnormal = {}\n[[contact]]\ngroup = \"{}\"\nobstacle = \"slope\"\n[load]\ngravity = {}\n",
      sheared_mesh(shape, count), law, flat ? "[0.0, 0.0]" : "[0.0, 0.0, 0.0]", flat ? "[0.6, 0.8]" : "[0.6, 0.0, 0.8]",
      flat ? "y0" : "z0", flat ? "[0.0, -3.0]" : "[0.0, 0.0, -3.0]");
  text += "[[support]]\ngroup = \"x0\"\ncomponents = [\"x\"]\n";
  if (!flat) text += "[[support]]\ngroup = \"y0\"\ncomponents = [\"y\"]\n";
  return text + fmt::format(
                    "[mass]\ntype = \"{}\"\n[initial]\ndisplacement = \"static\"\n[time]\n{}step = 1e-3\nend = "
                    "5e-3\n",
                    mass, time);
}

/// Row of the probe of a boundary, by columns.
class Probe {
 public:
  Probe(const CaseRun& run, const std::string& group)
      : run_(run),
        observer_(run.problem()),
        sensor_(make_boundary_sensor(
            "side", run.problem(),
            facet_nodes(run.model().space, run.model().mesh.group(group, run.problem().dimension - 1).members),
            Vector::Zero(run.problem().dimension))),
        names_(names_of(sensor_->columns())) {}

  double operator()(const std::string& column) {
    std::vector<double> row;
    sensor_->observe(observer_.observe(run_.state()), row);
    EXPECT_EQ(row.size(), names_.size());
    return row[column_index(names_, "side." + column)];
  }

 private:
  const CaseRun& run_;
  Observer observer_;
  std::unique_ptr<Sensor> sensor_;
  std::vector<std::string> names_;
};

const std::string linear = "young = 1.0e4\npoisson = 0.3\n";

/// The reaction is the same on every mesh, although the contact forces at the nodes of the side depend on the mesh.
TEST(SupportProbe, OfABodyOnASlope) {
  for (const CellShape shape : all_cell_shapes()) {
    for (const int count : {2, 5}) {
      if (dimension(shape) == 3 && count == 5) continue;
      const CaseRun run(
          on_a_slope(shape, count, linear, "consistent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n"));
      Probe probe(run, "x0");
      EXPECT_NEAR(probe("support_x"), -0.75 * weight, 1e-9) << name(shape) << count;
      EXPECT_GT(std::abs(probe("force_x") + 0.75 * weight), 0.01) << name(shape) << count;  // contact at the corner
    }
  }
}

/// At rest, whatever the stages, instants and means of the scheme are. If contact forces follow from gaps, a body whose
/// static start has closed them moves.
TEST(SupportProbe, IsTheSameUnderAllSchemes) {
  for (const std::string& scheme : scheme_names()) {
    if (scheme == "penalty-midpoint" || scheme == "nitsche") continue;
    CaseRun run(on_a_slope(CellShape::triangle, 3, linear, masses_of(scheme).back(), time_of(scheme)));
    Probe probe(run, "x0");
    run.run([&] { EXPECT_NEAR(probe("support_x"), -0.75 * weight, 1e-7) << scheme << run.state().step; });
  }
}

/// On the deformed geometry the slope's normal is the same, and so is the reaction.
TEST(SupportProbe, AtFiniteStrain) {
  const CaseRun run(on_a_slope(CellShape::triangle, 3, "law = \"neo-hookean\"\nyoung = 30.0\npoisson = 0.3\n",
                               "consistent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n"));
  EXPECT_GT(run.state().displacement.cwiseAbs().maxCoeff(), 0.02);
  Probe probe(run, "x0");
  EXPECT_NEAR(probe("support_x"), -0.75 * weight, 1e-8);
}

/// A plug in a cone, held at its top, whose outer nodes are also in contact: the forces along the axis balance, over
/// the whole ring.
TEST(SupportProbe, OfAxisymmetricBodies) {
  BoxMesh box = box_of(CellShape::quadrilateral, {3, 3});
  box.map = [](const Vector& x) -> Vector { return Eigen::Vector2d(1.0 + x[0] * (1.0 + 0.5 * x[1]), x[1]); };
  const std::string mesh = write_mesh("plug.msh", make_box_mesh(box));
  const CaseRun run(fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = 1\nplane = \"axisymmetric\"\n[[material]]\ngroup = \"body\"\ndensity = "
      "1.0\n{}[obstacle.cone]\ntype = \"plane\"\npoint = [2.0, 0.0]\nnormal = [-1.0, 0.5]\n[[contact]]\ngroup = "
      "\"x1\"\nobstacle = \"cone\"\n[load]\ngravity = [0.0, -3.0]\n[[support]]\ngroup = \"y1\"\ncomponents = "
      "[\"y\"]\nvalue = -1e-3\n[mass]\ntype = \"consistent\"\n[initial]\ndisplacement = \"static\"\n[time]\nscheme = "
      "\"newmark\"\npreset = \"trapezoidal\"\nstep = 1e-3\nend = 1e-3\n",
      mesh, linear));
  Probe probe(run, "y1");
  const Vector& reaction = run.state().forces.normal_reaction;
  const double pushed = 0.5 / std::hypot(1.0, 0.5) * reaction.sum();
  // 2π ∫ x dA over the trapezoid between x = 1 and 2 + ½y.
  const double volume = std::numbers::pi * (std::pow(2.5, 3) - 8.0) / 1.5 - std::numbers::pi;
  EXPECT_GT(pushed, 1.0);
  EXPECT_NEAR(probe("support_y") + pushed, weight * volume, 1e-9 * pushed);
  EXPECT_GT(std::abs(probe("force_y") - probe("support_y")), 0.01 * pushed);
  EXPECT_EQ(probe("support_moment_z"), 0.0);
}

}  // namespace ricochet::test_support::support_probe_test
