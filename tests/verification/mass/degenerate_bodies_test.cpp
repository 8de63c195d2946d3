#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "support/box_mesh.hpp"
#include "support/errors.hpp"
#include "support/mass_bodies.hpp"
#include "support/mass_moments.hpp"

// Any set of a mesh's nodes may be its contact nodes. For any remaining inertia, a constructed mass has the promised
// properties, or the warning states the deviation.

namespace ricochet::test_support::degenerate_bodies_test {

constexpr const char* types[] = {"equivalent",         "equivalent-nodewise", "equivalent-cellwise",
                                 "equivalent-compact", "equivalent-lumped",   "equivalent-nearest"};
constexpr const char* grid =
    "Rectangle(1)={0,0,0,2,1}; Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1}; "
    "Transfinite Curve{1,3}=9; Transfinite Curve{2,4}=5; Transfinite Surface{1}; Recombine Surface{1};";
constexpr const char* block =
    "Box(1)={0,0,0,1,1,2}; Physical Volume(\"body\")={1}; Physical Surface(\"contact\")={5}; Transfinite Curve{:}=5; "
    "Transfinite Surface{:}; Recombine Surface{:}; Transfinite Volume{1};";

/// Nodes without contact: a few anywhere, or all on one line or in one plane of the grid, or all in a part of the body.
std::vector<char> random_free_nodes(const Points& nodes, std::mt19937& random) {
  std::vector<char> free(static_cast<std::size_t>(nodes.cols()), 0);
  const auto any = [&](Index count) { return Index(random() % unsigned(count)); };
  const Vector through = nodes.col(any(nodes.cols()));
  const Index fixed = 1 + any(nodes.rows());  // number of fixed coordinates: a plane, a line or a point remains
  const Index kind = any(3);
  const Index first_axis = any(nodes.rows());
  for (Index i = 0; i < nodes.cols(); ++i) {
    bool is_free = kind == 1 ? nodes(0, i) >= through[0] : true;
    if (kind == 0) is_free = any(nodes.cols()) < 2 + 4 * fixed;
    if (kind == 2) {
      for (Index k = 0; k < fixed; ++k) {
        const Index axis = (first_axis + k) % nodes.rows();
        is_free = is_free && std::abs(nodes(axis, i) - through[axis]) < 1e-9;
      }
    }
    free[std::size_t(i)] = is_free ? 1 : 0;
  }
  return free;
}

/// Twice the energy of the velocity ω × (x − c), or of the rotation in the plane.
double energy_of_spin(const SparseMatrix& mass, const Points& nodes, const Vector& centre,
                      const Eigen::Vector3d& axis) {
  Matrix velocity(nodes.cols(), nodes.rows());
  for (Index i = 0; i < nodes.cols(); ++i) {
    Eigen::Vector3d relative = Eigen::Vector3d::Zero();
    relative.head(nodes.rows()) = nodes.col(i) - centre;
    velocity.row(i) = axis.cross(relative).head(nodes.rows()).transpose();
  }
  return (velocity.transpose() * (mass * velocity)).trace();
}

struct Count {
  int refused = 0, exact = 0, warned = 0;
};

void check_promises(const std::string& type, const AssembledBody& body, const MassInput& input, std::mt19937& random,
                    Count& count) {
  SparseMatrix mass;
  std::vector<std::string> warnings;
  const log::CollectWarnings collect(warnings);
  try {
    mass = build_mass(type, input);
  } catch (const Error& problem) {
    ++count.refused;
    EXPECT_EQ(problem.kind(), ErrorKind::invalid_input);
    EXPECT_TRUE(has(problem.what(), "refine the mesh"));
    return;
  }
  const Points& nodes = body.space.nodes;
  const Index d = nodes.rows();
  const Matrix wanted = mass_moments(body.consistent, nodes), found = mass_moments(mass, nodes);
  const double size = wanted.cwiseAbs().maxCoeff();
  EXPECT_LE((found - wanted).row(0).cwiseAbs().maxCoeff(), 1e-12 * size) << "mass and centre of gravity";
  EXPECT_TRUE(is_positive_definite(mass, input.contact_nodes));
  const bool warned = !warnings.empty();
  ++(warned ? count.warned : count.exact);
  EXPECT_TRUE(!warned || type == "equivalent-lumped");
  if (!warned) {
    EXPECT_LE((found - wanted).cwiseAbs().maxCoeff(), 1e-9 * size) << "moments of inertia";
  }
  const Vector centre = wanted.col(0).tail(d) / wanted(0, 0);
  for (int k = 0; k < 10; ++k) {
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    if (d == 3) axis = Eigen::Vector3d::NullaryExpr([&] { return double(random()) / 2147483648.0 - 1.0; });
    const double ratio =
        energy_of_spin(mass, nodes, centre, axis) / energy_of_spin(body.consistent, nodes, centre, axis);
    EXPECT_GE(ratio, 0.1 - 1e-9) << "spin has inertia about every axis";
    if (!warned) {
      EXPECT_NEAR(ratio, 1.0, 1e-9);
    }
  }
}

TEST(DegenerateBodies, AMassKeepsItsPromisesOrIsRefused) {
  log::set_level(log::Level::error);
  for (const char* geometry : {grid, block}) {
    const AssembledBody body({"grid", 1, 1.0, geometry});
    for (const char* type : types) {
      SCOPED_TRACE(type);
      std::mt19937 random(3);
      Count count;
      for (int trial = 0; trial < 150; ++trial) {
        SCOPED_TRACE(trial);
        const std::vector<char> free = random_free_nodes(body.space.nodes, random);
        MassInput input = body.input;
        input.contact_nodes.clear();
        for (Index i = 0; i < body.space.nodes.cols(); ++i) {
          if (free[std::size_t(i)] == 0) input.contact_nodes.push_back(i);
        }
        check_promises(type, body, input, random, count);
      }
      std::printf("%d dimensions, %-20s %3d exact, %3d with a warning, %3d refused\n", int(body.space.nodes.rows()),
                  type, count.exact, count.warned, count.refused);
      EXPECT_GT(count.refused, 20);
      EXPECT_GT(count.exact + count.warned, 2);
    }
  }
}

TEST(DegenerateBodies, FreeNodesOnALineHaveNoSpinAboutIt) {
  const AssembledBody body({"block", 1, 1.0, block});
  MassInput input = body.input;
  input.contact_nodes.clear();
  for (Index i = 0; i < body.space.nodes.cols(); ++i) {
    // Not on the axis of the block, through its centre of gravity.
    if ((body.space.nodes.col(i).head(2) - Eigen::Vector2d(0.5, 0.5)).norm() > 1e-9) input.contact_nodes.push_back(i);
  }
  for (const char* type : types) {
    SCOPED_TRACE(type);
    expect_error({"5 nodes off the contact boundary, at (0.5, 0.5, 0), ", ", all on one line"},
                 [&] { (void)build_mass(type, input); });
  }
}

TEST(DegenerateBodies, NoBodyGivesMassToAnother) {
  const AssembledBody two({"two discs", 1, 0.2,
                           "Disk(1)={0,0,0,1}; Disk(2)={5,0,0,0.5}; Physical Surface(\"body\")={1,2}; "
                           "Physical Curve(\"contact\")={1};"});
  for (const char* type : types) {
    const SparseMatrix mass = build_mass(type, two.input);
    Vector left(two.space.nodes.cols());
    for (Index i = 0; i < left.size(); ++i) left[i] = two.space.nodes(0, i) < 2.0 ? 1.0 : 0.0;
    const double wanted = left.dot(two.consistent * left);
    EXPECT_NEAR(left.dot(mass * left), wanted, 1e-12 * wanted) << type;
  }
}

/// All free nodes of two layers of cells are in one plane, up to rounding if the plate is rotated. Detecting this cell
/// by cell would take the 141 rings of the first cell, each with a factorization of everything reached.
TEST(DegenerateBodies, ALargePlateOfTwoLayersIsRefused) {
  const Matrix turned = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  const Eigen::Vector3d size(1.0, 1.0, 0.01), shift(3.0, -5.0, 7.0);
  for (const Matrix& map : {Matrix(size.asDiagonal()), Matrix(turned * size.asDiagonal())}) {
    const auto plate =
        make_meshed_body(make_box_mesh({CellShape::hexahedron, {100, 100, 2}, 1, 0.0, affine_map(map, shift)}), 1);
    const SparseMatrix consistent = assemble_scalar_mass(plate->body, node_graph(plate->space));
    const CellMasses cells(plate->body);
    const MassInput input{&consistent, &plate->space.nodes,
                          facet_nodes(plate->space, plate->mesh.group("boundary", 2).members), nullptr, &cells};
    expect_error({"9801 nodes off the contact boundary, at ", "..., all in one plane"},
                 [&] { (void)build_mass("equivalent-compact", input); });
  }
}

/// Cells that become 10⁴ times as long from one end to the other: for a node the nearest 40 nodes are too close
/// together for their distance, but a cell is large enough.
TEST(DegenerateBodies, WhereNodesAreTooCloseTogetherTheDefaultTakesCells) {
  const auto grade = [](const Vector& x) {
    return Vector(x.unaryExpr([](double t) { return (std::pow(1e4, t) - 1.0) / (1e4 - 1.0); }));
  };
  const auto graded = make_meshed_body(make_box_mesh({CellShape::hexahedron, {3, 3, 3}, 1, 0.0, grade}), 1);
  const SparseMatrix consistent = assemble_scalar_mass(graded->body, node_graph(graded->space));
  const CellMasses cells(graded->body);
  const MassInput input{&consistent, &graded->space.nodes,
                        facet_nodes(graded->space, graded->mesh.group("x1", 2).members), nullptr, &cells};
  EXPECT_THROW((void)build_mass("equivalent-nodewise", input), Error);
  const MassChoice choice = mass_to_build("equivalent", {}, input);
  EXPECT_EQ(choice.name, "equivalent-cellwise");
  EXPECT_TRUE(has(choice.reason, "but \"equivalent-nodewise\" cannot be built"));
}

}  // namespace ricochet::test_support::degenerate_bodies_test
