#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/fem/stress.hpp"
#include "ricochet/io/fields/field_source.hpp"
#include "ricochet/simulation/history/history.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"
#include "support/two_bodies.hpp"

/// @file Homogeneous deformations at finite strain: simple shear in all cells, and blocks squeezed against a plane in
/// all multiplier spaces, on distorted meshes.
namespace ricochet::test_support::finite_patch_test {

struct Law {
  std::string name, keys;
  /// Cauchy stress of simple shear by γ (isochoric), from B = F Fᵀ.
  Eigen::Matrix3d (*shear)(double gamma);
};

Eigen::Matrix3d sheared(double gamma) {
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f(0, 1) = gamma;
  return f;
}
Eigen::Matrix3d left(double gamma) { return sheared(gamma) * sheared(gamma).transpose(); }

constexpr double lambda = 1.3, mu = 0.8, c10 = 0.3, c01 = 0.1;

const std::vector<Law>& laws() {
  static const std::vector<Law> all{
      {"neo-hookean", "lambda = 1.3\nmu = 0.8\n",
       [](double gamma) -> Eigen::Matrix3d { return mu * (left(gamma) - Eigen::Matrix3d::Identity()); }},
      {"mooney-rivlin", "c10 = 0.3\nc01 = 0.1\nbulk_modulus = 2.0\n",
       [](double gamma) -> Eigen::Matrix3d {
         const Eigen::Matrix3d b = left(gamma), all_of = 2.0 * (c10 * b - c01 * b.inverse());
         return all_of - all_of.trace() / 3.0 * Eigen::Matrix3d::Identity();
       }},
      {"saint-venant-kirchhoff", "lambda = 1.3\nmu = 0.8\n", [](double gamma) -> Eigen::Matrix3d {
         const Eigen::Matrix3d f = sheared(gamma), e = 0.5 * (f.transpose() * f - Eigen::Matrix3d::Identity());
         return f * (lambda * e.trace() * Eigen::Matrix3d::Identity() + 2.0 * mu * e) * f.transpose();
       }}};
  return all;
}

std::string mesh_of(const ElementKind& kind, double distortion) {
  BoxMesh box = box_of(kind.shape, std::vector<int>(std::size_t(kind.dimension()), 2));
  box.distortion = distortion;
  return write_mesh(fmt::format("{}-{}.msh", kind.label(), distortion), make_box_mesh(box));
}

std::string support(const std::string& group, int axis, double value = 0.0) {
  return fmt::format("[[support]]\ngroup = \"{}\"\ncomponents = [\"{}\"]\nvalue = \"{:.17g}\"\n", group, "xyz"[axis],
                     value);
}

std::string vector_of(const Vector& values, bool quoted = false) {
  std::string text = "[";
  for (Index k = 0; k < values.size(); ++k)
    text += fmt::format("{0}{1}{2:.17g}{1}", k == 0 ? "" : ", ", quoted ? "\"" : "", values[k]);
  return text + "]";
}

std::string static_case(const std::string& mesh, const ElementKind& kind, const std::string& law,
                        const std::string& loads, const std::string& mesh_keys = "") {
  return fmt::format("[mesh]\nfile = \"{}\"\ndegree = {}\n{}[[material]]\ngroup = \"body\"\ndensity = 1.0\n{}{}", mesh,
                     kind.displacement_degree, mesh_keys, law, loads) +
         "[initial]\ndisplacement = \"static\"\n[mass]\ntype = \"consistent\"\n[time]\nscheme = "
         "\"newmark\"\npreset = \"trapezoidal\"\nstep = 0.01\nend = 0.01\n";
}

std::vector<ElementKind> straight_kinds() {
  std::vector<ElementKind> result;
  for (const ElementKind& kind : all_element_kinds()) {
    if (kind.geometry_degree == 1) result.push_back(kind);
  }
  return result;
}

/// Largest deviation of a displacement from H x.
double field_error(const CaseRun& run, const Matrix& gradient) {
  const int d = run.problem().dimension;
  const Matrix u = run.state().displacement.reshaped(d, run.problem().nodes.cols());
  return (u - gradient.topLeftCorner(d, d) * run.problem().nodes).cwiseAbs().maxCoeff();
}

/// Expects these principal stretches in every cell, as written in the results.
void expect_stretches(const CaseRun& run, const std::array<double, 3>& wanted) {
  const std::vector<std::string> names{"principal_stretch_1", "principal_stretch_2", "principal_stretch_3"};
  const auto sources = make_field_sources({run.model().body, run.problem(), names});
  ASSERT_EQ(sources.size(), 1U);
  sources.front()->evaluate(run.state());
  const std::vector<Field> fields = sources.front()->fields();
  ASSERT_EQ(fields.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(fields[k].name, names[k]);
    ASSERT_EQ(fields[k].rows, run.model().mesh.cell_count());
    for (Index cell = 0; cell < fields[k].rows; ++cell)
      EXPECT_NEAR(static_cast<const double*>(fields[k].values)[cell], wanted[k], 1e-9);
  }
}

class Homogeneous : public testing::TestWithParam<ElementKind> {};

/// Bottom and top are held at their positions in simple shear, and its nominal stress P = σ F⁻ᵀ acts on the other
/// sides.
TEST_P(Homogeneous, SimpleShear) {
  constexpr double gamma = 0.6;
  const ElementKind& kind = GetParam();
  const int d = kind.dimension();
  const std::string mesh = mesh_of(kind, 0.15);
  for (const Law& law : laws()) {
    const Eigen::Matrix3d cauchy = law.shear(gamma);
    const Matrix nominal = (cauchy * sheared(gamma).inverse().transpose()).topLeftCorner(d, d);
    std::string loads;
    for (int axis = 0; axis < d; ++axis) {
      loads += support("y0", axis) + support("y1", axis, axis == 0 ? gamma : 0.0);
      if (axis == 1) continue;
      for (const bool far : {false, true})
        loads += fmt::format("[[traction]]\ngroup = \"{}{}\"\nvalue = {}\n", "xyz"[axis], far ? 1 : 0,
                             vector_of((far ? 1.0 : -1.0) * nominal.col(axis), true));
    }
    for (const std::string dilatation : {"pointwise", "mean"}) {
      const bool has_mean =
          law.name != "saint-venant-kirchhoff" && kind.label().find("displacement1") == std::string::npos;
      if (dilatation == "mean" && !has_mean) continue;
      const CaseRun run(static_case(
          mesh, kind, fmt::format("law = \"{}\"\ndilatation = \"{}\"\n{}", law.name, dilatation, law.keys), loads));
      EXPECT_LT(field_error(run, sheared(gamma) - Eigen::Matrix3d::Identity()), 1e-10) << law.name;
      const double largest = 0.5 * (gamma + std::sqrt(gamma * gamma + 4.0));
      expect_stretches(run, {largest, 1.0, 1.0 / largest});
      std::vector<double> stress, energy;
      CellStress(run.model().body).evaluate(run.state().displacement, stress, energy);
      for (std::size_t at = 0; at < stress.size();) {
        for (int i = 0; i < 3; ++i) {
          for (int j = i; j < 3; ++j) EXPECT_NEAR(stress[at++], cauchy(i, j), 1e-9) << law.name << i << j;
        }
      }
    }
  }
}

/// A neo-Hookean block of the given height whose free sides, two in space and one in plane strain, carry a pressure:
/// σ_i J = μ(λ_i² − 1) + ½λ(J² − 1).
struct Squeezed {
  double across, volume, nominal;  ///< stretch, J, and the force on top per undeformed area
  Squeezed(double height, int free, double pressure) {
    double low = 0.5, high = 3.0;
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (low + high), j = height * std::pow(middle, free);
      (stress(middle, j) > -pressure ? high : low) = middle;
    }
    across = low;
    volume = height * std::pow(across, free);
    nominal = -stress(height, volume) * std::pow(across, free);
  }
  static double stress(double stretch, double j) {
    return (mu * (stretch * stretch - 1.0) + 0.5 * lambda * (j * j - 1.0)) / j;
  }
};

/// Compares probes and fields of a body on a plane with the exact pressure at all contact nodes and with the areas.
void expect_contact(const CaseRun& run, double pressure, double nominal, double area, const std::string& what) {
  Observer observer(run.problem());
  const Observation observation = observer.observe(run.state());
  EXPECT_NEAR(observation.nominal_pressure.maxCoeff(), nominal, 1e-9) << what;
  EXPECT_NEAR(observation.nominal_pressure.minCoeff(), nominal, 1e-9) << what;
  EXPECT_NEAR(observation.pressure.maxCoeff(), pressure, 1e-9) << what;
  EXPECT_NEAR(observation.pressure.minCoeff(), pressure, 1e-9) << what;
  const std::unique_ptr<Sensor> sensor = make_contact_sensor("c", run.problem(), {SensedPair{0}});
  std::vector<double> row;
  sensor->observe(observation, row);
  const std::vector<std::string> names = names_of(sensor->columns());
  ASSERT_EQ(names.size(), row.size());
  EXPECT_EQ(names[row.size() - 2], "c.area");
  EXPECT_EQ(names[row.size() - 1], "c.nominal_area");
  // The space "p0" is unstable here: some multipliers are zero, and their facets are not pressed.
  const bool all_press = run.state().forces.normal_reaction.minCoeff() > 0.0;
  if (all_press || what.find(" p0 ") == std::string::npos) {
    EXPECT_NEAR(row[row.size() - 2], area, 1e-9) << what;
    EXPECT_NEAR(row[row.size() - 1], 1.0, 1e-12) << what;
  }
  const std::vector<std::string> fields{"contact_pressure", "nominal_contact_pressure"};
  for (const auto& source : make_field_sources({run.model().body, run.problem(), fields})) {
    source->evaluate(run.state());
    ASSERT_EQ(source->fields().size(), 2U);
    for (const Field& field : source->fields()) {
      const double* const values = static_cast<const double*>(field.values);
      EXPECT_NEAR(*std::max_element(values, values + field.rows), field.name == fields[0] ? pressure : nominal, 1e-9);
    }
  }
}

/// A block squeezed against a frictionless plane deforms homogeneously, and its pressure on the plane is uniform: by 30
/// % with a moving top; by 15 % with a moving top and a follower pressure on its sides, and with a dead load on top,
/// where the plane alone holds it. The true pressure is the Cauchy stress, on the deformed area of the unit square; the
/// nominal one is the force per undeformed area.
TEST_P(Homogeneous, SqueezedAgainstAPlane) {
  const ElementKind& kind = GetParam();
  const int d = kind.dimension(), up = d - 1;
  const std::string bottom = std::string(1, "xyz"[up]) + "0", top = std::string(1, "xyz"[up]) + "1";
  for (const double distortion : {0.0, 0.15}) {
    const std::string mesh = mesh_of(kind, distortion);
    for (const std::string multipliers : {"nodal", "p0", "p1", "dual"}) {
      for (const std::string by : {"top", "sides", "load"}) {
        // Constant multipliers leave a squeezed surface of degree 2 free to buckle within its facets.
        const bool is_squeezed_hard = by == "top" && multipliers != "p0";
        const double pressure = by == "sides" ? 0.3 : 0.0, height = is_squeezed_hard ? 0.7 : 0.85;
        const Squeezed exact(height, up, pressure);
        Eigen::Matrix3d gradient = (exact.across - 1.0) * Eigen::Matrix3d::Identity();
        gradient(up, up) = height - 1.0;
        std::string loads = support(top, up, height - 1.0);
        if (by == "load")
          loads = fmt::format("[[traction]]\ngroup = \"{}\"\nvalue = {}\n", top,
                              vector_of(-exact.nominal * Vector::Unit(d, up), true));
        for (int axis = 0; axis < up; ++axis) {
          const std::string side(1, "xyz"[axis]);
          loads += support(side + "0", axis);
          if (by == "sides")
            loads += fmt::format("[[pressure]]\ngroup = \"{}1\"\nvalue = \"{:.17g}\"\n", side, pressure);
        }
        loads += fmt::format(
            "[obstacle.floor]\ntype = \"plane\"\npoint = {}\nnormal = {}\n[[contact]]\ngroup = "
            "\"{}\"\nobstacle = \"floor\"\nmultipliers = \"{}\"\nunstable_multipliers = \"allow\"\n",
            vector_of(Vector::Zero(d)), vector_of(Vector::Unit(d, up)), bottom, multipliers);
        const std::string what = fmt::format("{} {} {} {}", kind.label(), distortion, multipliers, by);
        const CaseRun run(static_case(mesh, kind, "law = \"neo-hookean\"\nlambda = 1.3\nmu = 0.8\n", loads));
        EXPECT_LT(field_error(run, gradient), 1e-9) << what;
        const Vector& reaction = run.state().forces.normal_reaction;
        EXPECT_NEAR(reaction.sum(), exact.nominal, 1e-9) << what;
        EXPECT_GT(reaction.minCoeff(), -1e-12) << what;
        const double area = std::pow(exact.across, up);
        EXPECT_GT(std::abs(area - 1.0), 0.01) << what;
        expect_contact(run, -Squeezed::stress(height, exact.volume), exact.nominal, area, what);
      }
    }
  }
}

/// Principal stretches in the hoop direction and through the thickness of a sheet.
TEST(PrincipalStretches, OfRingsAndSheets) {
  const ElementKind kind{CellShape::quadrilateral, 1, 2};
  const std::string mesh = mesh_of(kind, 0.15), law = "law = \"neo-hookean\"\nlambda = 1.3\nmu = 0.8\n";
  const std::string along = support("y0", 1) + support("y1", 1, 0.5);
  // u_x = −0.2 x: J σ_rr is that of a pressure on the side.
  const double volume = 1.5 * 0.64, radial = Squeezed::stress(0.8, volume);
  const CaseRun ring(static_case(mesh, kind, law,
                                 along + fmt::format("[[pressure]]\ngroup = \"x1\"\nvalue = \"{:.17g}\"\n", -radial),
                                 "plane = \"axisymmetric\"\n"));
  expect_stretches(ring, {1.5, 0.8, 0.8});
  const CaseRun sheet(
      static_case(mesh, kind, law, along + support("x0", 0) + support("x1", 0, 0.2), "plane = \"stress\"\n"));
  double low = 0.1, high = 1.0;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (Squeezed::stress(middle, 1.8 * middle) > 0.0 ? high : low) = middle;
  }
  expect_stretches(sheet, {1.5, 1.2, low});
}

TEST(PrincipalStretches, AreRefusedWithTheLinearLaw) {
  const ElementKind kind{CellShape::quadrilateral, 1, 1};
  const auto text = [&](const std::string& field) {
    return static_case(mesh_of(kind, 0.15), kind, "young = 1.0\npoisson = 0.3\n", support("x0", 0) + support("x0", 1)) +
           "[output]\nfields = [\"" + field + "\"]\n";
  };
  const CaseRun all(text("all"));
  const auto sources = make_field_sources({all.model().body, all.problem(), expand_field_names({"all"})});
  for (const auto& source : sources) {
    for (const Field& field : source->fields()) EXPECT_FALSE(field.name.starts_with("principal_stretch"));
  }
  expect_error({"requires a law of finite strain"}, [&] { const CaseRun run(text("principal_stretch_2")); });
}

INSTANTIATE_TEST_SUITE_P(FinitePatch, Homogeneous, testing::ValuesIn(straight_kinds()),
                         [](const auto& tested) { return tested.param.label(); });

}  // namespace ricochet::test_support::finite_patch_test
