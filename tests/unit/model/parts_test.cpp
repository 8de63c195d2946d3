#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "ricochet/base/log.hpp"
#include "ricochet/model/model.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"
#include "support/msh_text.hpp"
#include "support/paths.hpp"

/// @file Cases of several mesh files, and bodies that move at the start.
namespace ricochet::test_support {
namespace {

constexpr double width = 3.0, height = 2.0;

/// A rectangle [0, 3] × [0, 2] of eight triangles about a node that is not its centre.
std::string rectangle() {
  MshText mesh({"low", "high"});
  for (const double y : {0.0, 1.1, height}) {
    for (const double x : {0.0, 1.7, width}) mesh.add_node(x, y);
  }
  for (const int first : {1, 2, 4, 5}) {
    mesh.add_triangle(first, first + 1, first + 4);
    mesh.add_triangle(first, first + 4, first + 3);
  }
  mesh.add_edge(1, 1, 2);
  mesh.add_edge(1, 2, 3);
  mesh.add_edge(2, 7, 8);
  mesh.add_edge(2, 8, 9);
  return mesh.text();
}

std::string material(const std::string& group, double density) {
  return fmt::format("[[material]]\ngroup = {}\ndensity = {}\nlambda = 100.0\nmu = 50.0\n", group, density);
}

std::string time_section(const std::string& mass = "consistent") {
  return "[mass]\ntype = \"" + mass + "\"\n[time]\nscheme = \"midpoint\"\nstep = 0.001\nend = 0.001\n";
}

/// Momentum of the nodes of a body and its moment about a point, from M v.
struct Momenta {
  double mass = 0.0;
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
};

Momenta momenta(const CaseRun& run, const Eigen::Vector3d& about, double from_x = -1e9, double to_x = 1e9) {
  const SemidiscreteProblem& problem = run.problem();
  const int d = problem.dimension;
  Vector impulse, ones, weight;
  problem.mass.multiply(run.state().velocity, impulse);
  ones.setZero(problem.dof_count());
  for (Index i = 0; i < ones.size(); i += d) ones[i] = 1.0;
  problem.mass.multiply(ones, weight);
  Momenta result;
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    if (problem.nodes(0, node) < from_x || problem.nodes(0, node) > to_x) continue;
    Eigen::Vector3d arm = -about, part = Eigen::Vector3d::Zero();
    arm.head(d) += problem.nodes.col(node);
    part.head(d) = impulse.segment(node * d, d);
    if (d == 2) arm[2] = 0.0;
    result.mass += weight[node * d];
    result.linear += part;
    result.angular += arm.cross(part);
  }
  return result;
}

void expect_near(const Eigen::Vector3d& found, const Eigen::Vector3d& wanted, double scale) {
  EXPECT_LE((found - wanted).norm(), 1e-12 * scale) << found.transpose() << ", not " << wanted.transpose();
}

std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {},
                    ErrorKind kind = ErrorKind::invalid_input) {
  log::set_level(log::Level::error);
  const std::string path = write_temporary("refused.toml", text);
  std::string message = message_of([&] { Session(path, overrides).build(); }, kind);
  for (std::size_t at = message.find(path); at != std::string::npos; at = message.find(path))
    message.replace(at, path.size(), "CASE");
  return message;
}

TEST(Parts, HaveTheMomentaOfRigidBodies) {
  const std::string mesh = write_temporary("rectangle.msh", rectangle());
  const double density = 2.5, scale = 2.0, mass = density * scale * scale * width * height;
  const double inertia = mass * scale * scale * (width * width + height * height) / 12.0;
  for (const std::string degree : {"1", "2"}) {
    const CaseRun run("[mesh]\ndegree = " + degree + "\n[part.first]\nfile = \"" + mesh +
                      "\"\nscale = 2.0\nturn = { angle = 25.0 }\nmove = [-50.0, 7.0]\nvelocity = [0.5, -1.5]\n"
                      "spin = 3.0\n[part.second]\nfile = \"" +
                      mesh + "\"\n" + material("\"all\"", density) + time_section());
    // The centre of the rectangle, rotated and moved.
    const Vector centre = Eigen::Rotation2Dd(25.0 * std::numbers::pi / 180.0) * Eigen::Vector2d(width, height) +
                          Eigen::Vector2d(-50.0, 7.0);
    const Momenta first = momenta(run, {centre[0], centre[1], 0.0}, -1e9, -1.0);
    EXPECT_NEAR(first.mass, mass, 1e-12 * mass);
    expect_near(first.linear, mass * Eigen::Vector3d(0.5, -1.5, 0.0), mass);
    expect_near(first.angular, inertia * Eigen::Vector3d(0.0, 0.0, 3.0), inertia);
    const Momenta second = momenta(run, Eigen::Vector3d::Zero(), -1.0);
    EXPECT_NEAR(second.mass, density * width * height, 1e-12 * mass);
    EXPECT_EQ(second.linear.norm(), 0.0);
    EXPECT_EQ(second.angular.norm(), 0.0);
  }
}

TEST(Parts, OfSolidsSpinAboutEveryAxis) {
  const std::string box = mesh_geometry(
      "spinning_box", "Box(1)={0,0,0,1,2,3}; Physical Volume(\"body\")={1}; Physical Surface(\"low\")={5};", 0.7, 1);
  const double density = 4.0, mass = density * 6.0;
  const Eigen::Vector3d spin(1.0, -2.0, 0.5), velocity(3.0, 0.0, -1.0),
      inertia(mass * 13.0 / 12.0, mass * 10.0 / 12.0, mass * 5.0 / 12.0);
  const std::string text = "[part.box]\nfile = \"" + box +
                           "\"\nmove = [10.0, 20.0, 30.0]\nvelocity = [3.0, 0.0, -1.0]\nspin = [1.0, -2.0, 0.5]\n" +
                           material("\"box.body\"", density);
  // Masses that redistribute inertia preserve its total.
  for (const std::string made : {"consistent", "equivalent"}) {
    std::string contact;
    if (made == "equivalent")
      contact =
          "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n[[contact]]\ngroup = "
          "\"box.low\"\nobstacle = \"floor\"\n";
    std::string time = time_section(made);
    if (made == "equivalent") time.replace(time.find("midpoint"), 8, "reduced-kane");
    const CaseRun run(text + contact + time);
    const Momenta all = momenta(run, {10.5, 21.0, 31.5});
    expect_near(all.linear, mass * velocity, mass * velocity.norm());
    expect_near(all.angular, inertia.cwiseProduct(spin), inertia.maxCoeff() * spin.norm());
  }
}

/// Two rectangles side by side in one mesh, joined or not, the right one of another group.
std::string two_rectangles(bool joined) {
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"left\"\n2 2 \"right\"\n"
      "$EndPhysicalNames\n$Nodes\n";
  text += joined ? "6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 3 0 0\n6 3 1 0\n$EndNodes\n$Elements\n2\n"
                   "1 3 2 1 1 1 2 3 4\n2 3 2 2 2 2 5 6 3\n$EndElements\n"
                 : "8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 5 0 0\n6 7 0 0\n7 7 1 0\n8 5 1 0\n$EndNodes\n$Elements\n"
                   "2\n1 3 2 1 1 1 2 3 4\n2 3 2 2 2 5 6 7 8\n$EndElements\n";
  return text;
}

TEST(Motions, TurnAboutTheCentreOfMassOfTheActualDensities) {
  const std::string mesh = write_temporary("joined.msh", two_rectangles(true));
  const std::string text = "[mesh]\nfile = \"" + mesh + "\"\n" + material("\"left\"", 8.0) + material("\"right\"", 1.0);
  const CaseRun run(text + "[[motion]]\ngroup = [\"left\", \"right\"]\nspin = 2.0\n" + time_section());
  // Masses 8 about (½, ½) and 2 about (2, ½).
  const double mass = 10.0, centre = (8.0 * 0.5 + 2.0 * 2.0) / mass;
  const double inertia =
      8.0 * (2.0 / 12.0 + std::pow(centre - 0.5, 2)) + 2.0 * (5.0 / 12.0 + std::pow(2.0 - centre, 2));
  const Momenta all = momenta(run, {centre, 0.5, 0.0});
  EXPECT_NEAR(all.mass, mass, 1e-12 * mass);
  expect_near(all.linear, Eigen::Vector3d::Zero(), mass);
  expect_near(all.angular, {0.0, 0.0, 2.0 * inertia}, inertia);
}

TEST(Motions, TurnAboutAPointAndAddToTheVelocityOfAll) {
  const std::string mesh = write_temporary("apart.msh", two_rectangles(false));
  const std::string text = "[mesh]\nfile = \"" + mesh + "\"\n" + material("\"all\"", 1.0);
  const CaseRun run(text +
                    "[initial]\nvelocity = [\"y\", 0.25]\n[[motion]]\ngroup = \"right\"\nvelocity = [1.0, 0.0]\nspin = "
                    "2.0\nabout = [5.0, 3.0]\n" +
                    time_section());
  for (Index node = 0; node < run.problem().nodes.cols(); ++node) {
    const Vector at = run.problem().nodes.col(node);
    Vector wanted = Eigen::Vector2d(at[1], 0.25);
    if (at[0] > 4.0) wanted += Eigen::Vector2d(1.0 - 2.0 * (at[1] - 3.0), 2.0 * (at[0] - 5.0));
    EXPECT_EQ(run.state().velocity.segment(2 * node, 2), wanted) << at.transpose();
  }
}

TEST(Motions, OfOneNodeAreRefused) {
  const std::string mesh = write_temporary("joined.msh", two_rectangles(true));
  const std::string text = "[mesh]\nfile = \"" + mesh + "\"\n" + material("\"all\"", 1.0) + time_section();
  const std::string left = "[[motion]]\ngroup = \"left\"\nspin = 2.0\n",
                    right = "[[motion]]\ngroup = \"right\"\nspin = 2.0\n";
  EXPECT_EQ(refusal(text + left), "");
  EXPECT_EQ(refusal(text + left + right),
            "CASE:18:9: group \"right\" shares nodes with group \"left\", which has a motion at CASE:15:9: use groups "
            "that have no node in common");
  EXPECT_EQ(refusal(text + right + "[[motion]]\ngroup = \"all\"\nvelocity = [1.0, 0.0]\n"),
            "CASE:18:9: group \"all\" shares cells with group \"right\", which has a motion at CASE:15:9: use groups "
            "that have no node in common");
  const std::string apart = write_temporary("apart.msh", two_rectangles(false));
  EXPECT_EQ(refusal(text + left + right, {"mesh.file=" + apart}), "");
  const std::string of_part = "[part.a]\nfile = \"" + apart + "\"\nspin = 1.0\n" + material("\"all\"", 1.0) +
                              "[[motion]]\ngroup = \"a.left\"\nspin = 2.0\n" + time_section();
  EXPECT_EQ(refusal(of_part),
            "CASE:10:9: group \"a.left\" shares cells with part \"a\", which has a motion at CASE:1:1: use groups "
            "that have no node in common");
}

/// The file has a group "all" with one of two cells; a motion of the part moves both.
TEST(Motions, OfAPartMoveAllOfIt) {
  std::string named = two_rectangles(false);
  named.replace(named.find("\"left\""), 6, "\"all\"");
  const std::string mesh = write_temporary("named.msh", named);
  const CaseRun run("[part.a]\nfile = \"" + mesh + "\"\nvelocity = [1.0, 0.0]\n" + material("\"a.all\"", 2.0) +
                    material("\"a.right\"", 3.0) + time_section());
  const Momenta all = momenta(run, Eigen::Vector3d::Zero());
  EXPECT_NEAR(all.linear[0], 2.0 + 6.0, 1e-12 * 8.0);
}

TEST(Motions, HaveTheDimensionOfTheMesh) {
  const std::string mesh = write_temporary("apart.msh", two_rectangles(false));
  const std::string text = "[mesh]\nfile = \"" + mesh + "\"\n" + material("\"all\"", 1.0) + time_section();
  EXPECT_EQ(
      refusal(text + "[[motion]]\ngroup = \"left\"\nspin = [0.0, 0.0, 1.0]\n"),
      "CASE:16:8: \"spin\" has 3 entries, but the mesh has dimension 2, where it must be one number: write spin = 3.0");
  EXPECT_TRUE(has(refusal(text + "[[motion]]\ngroup = \"left\"\nvelocity = [0.0, 0.0, 1.0]\n"),
                  "CASE:16:12: motion.0.velocity has 3 entries, but the mesh has dimension 2"));
  const std::string solid = data_path("meshes/tetrahedron_o1_msh41_ascii.msh");
  EXPECT_TRUE(has(refusal(text + "[[motion]]\ngroup = \"all\"\nspin = 1.0\n", {"mesh.file=" + solid}),
                  "CASE:16:8: \"spin\" is a number, but the mesh has dimension 3"));
  EXPECT_TRUE(has(refusal(text + "[[motion]]\ngroup = \"lef\"\nspin = 1.0\n"), "CASE:15:9: "));
}

TEST(Parts, AreRefusedAtTheirPlaces) {
  const auto data = [](const std::string& name) { return data_path("meshes/" + name); };
  const std::string square = data("quadrilateral_o1_msh41_ascii.msh");
  const auto text = [&](const std::string& second) {
    return "[part.a]\nfile = \"" + square + "\"\n[part.b]\nfile = \"" + second + "\"\n" + material("\"all\"", 1.0) +
           time_section();
  };
  EXPECT_EQ(refusal(text(square)), "");
  EXPECT_TRUE(refusal(text(data("quadrilateral_o2_msh41_ascii.msh")))
                  .starts_with("CASE:4:8: part \"b\" is a mesh of degree 2"));
  EXPECT_TRUE(refusal(text(data("tetrahedron_o1_msh41_ascii.msh")))
                  .starts_with("CASE:4:8: part \"b\" is a mesh of dimension 3"));
  EXPECT_TRUE(
      refusal(text(data("third_order.msh"))).starts_with("CASE:4:8: part \"b\": " + data("third_order.msh") + ": "));
  EXPECT_TRUE(refusal(text("/nowhere/b.msh"), {}, ErrorKind::file_access)
                  .starts_with("CASE:4:8: there is no file /nowhere/b.msh"));
  const std::string both = refusal(text("/nowhere/b.msh"), {"part.a.file=/nowhere/a.msh"}, ErrorKind::file_access);
  EXPECT_TRUE(both.starts_with("--set part.a.file=/nowhere/a.msh: there is no file /nowhere/a.msh")) << both;
  EXPECT_TRUE(has(both, "\nCASE:4:8: there is no file /nowhere/b.msh"));
  EXPECT_TRUE(has(refusal(text(square), {"part.b.move=[0, 0, 1]"}), "part.b.move has 3 entries"));
  EXPECT_TRUE(has(refusal(text(square), {"part.b.turn={angle = 1, axis = [0, 1]}"}), "remove the axis"));
}

}  // namespace
}  // namespace ricochet::test_support
