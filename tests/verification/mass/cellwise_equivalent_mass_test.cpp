#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <random>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "support/box_mesh.hpp"
#include "support/mass_bodies.hpp"
#include "support/mass_moments.hpp"

// Mass redistributed cell by cell: its invariances, its possible receiving nodes, and its effect on frequencies.

namespace ricochet::test_support::cellwise_equivalent_mass_test {

constexpr const char* cellwise = "equivalent-cellwise";

/// A copy of a body with other positions, another density, renumbered nodes and reordered cells.
struct Variant : AssembledBody {
  std::vector<Index> number;  ///< new number of each node

  explicit Variant(const AssembledBody& from)
      : AssembledBody(from.mesh, from.space, from.body), number(std::size_t(space.nodes.cols())) {
    std::iota(number.begin(), number.end(), Index{0});
  }

  void move(const Matrix& map, const Vector& shift) {
    mesh.nodes = ((map * mesh.nodes).colwise() + shift).eval();
    space.nodes = ((map * space.nodes).colwise() + shift).eval();
  }
  void shuffle(std::mt19937& random) {
    std::shuffle(number.begin(), number.end(), random);
    const Points before = space.nodes;
    for (std::size_t i = 0; i < number.size(); ++i) space.nodes.col(number[i]) = before.col(Index(i));
    for (std::size_t b = 0; b < space.cells.size(); ++b) {
      for (Index& node : space.cells[b].nodes) node = number[std::size_t(node)];
      std::vector<Index> order(static_cast<std::size_t>(space.cells[b].size()));
      std::iota(order.begin(), order.end(), Index{0});
      std::shuffle(order.begin(), order.end(), random);
      for (CellBlock* block : {&space.cells[b], &mesh.cells[b]}) {
        const CellBlock old = *block;
        for (std::size_t k = 0; k < order.size(); ++k) {
          std::copy_n(old.cell(order[k]), old.nodes_per_cell, block->nodes.begin() + Index(k) * old.nodes_per_cell);
        }
      }
    }
  }
  SparseMatrix build(const AssembledBody& from, const char* type) {
    std::vector<Index> contact_nodes;
    for (const Index node : from.input.contact_nodes) contact_nodes.push_back(number[std::size_t(node)]);
    std::ranges::sort(contact_nodes);
    assemble(std::move(contact_nodes));
    return build_mass(type, input);
  }
};

constexpr const char* some_bodies[] = {
    "strip, 2 thick, quads",    "disc, h 0.25, degree 2",    "ball, h 0.25", "ball, h 0.4, degree 2", "plate, 2 thick",
    "brick, hexahedra, around", "brick, hexahedra, degree 2"};

TEST(CellwiseEquivalentMass, NumbersOfNodesAndCellsDoNotMatter) {
  std::mt19937 random(7);
  for (const char* name : some_bodies) {
    const AssembledBody body(body_of_kind(name));
    const SparseMatrix plain = build_mass(cellwise, body.input);
    Variant other(body);
    other.shuffle(random);
    const SparseMatrix found = other.build(body, cellwise);
    ASSERT_EQ(found.nonZeros(), plain.nonZeros()) << name;
    double worst = 0.0;
    for (Index j = 0; j < plain.cols(); ++j) {
      for (SparseMatrix::InnerIterator entry(plain, j); entry; ++entry) {
        const double there = found.coeff(other.number[std::size_t(entry.row())], other.number[std::size_t(j)]);
        worst = std::max(worst, std::abs(there - entry.value()));
      }
    }
    // In grids, donors that are equal up to rounding have equal shares: ties do not affect the result.
    EXPECT_LE(worst, 1e-12 * plain.coeffs().cwiseAbs().maxCoeff()) << name;
  }
}

TEST(CellwiseEquivalentMass, UnitsThatArePowersOfTwoChangeNoBit) {
  for (const char* name : some_bodies) {
    const AssembledBody body(body_of_kind(name));
    const SparseMatrix plain = build_mass(cellwise, body.input);
    const Index d = body.space.nodes.rows();
    Variant other(body);
    other.move(std::ldexp(1.0, -30) * Matrix::Identity(d, d), Vector::Zero(d));
    other.body.materials[0].density *= std::ldexp(1.0, 40);
    const SparseMatrix found = other.build(body, cellwise);
    ASSERT_EQ(found.nonZeros(), plain.nonZeros());
    const double factor = std::ldexp(1.0, int(40 - 30 * d));
    EXPECT_EQ((found - factor * plain).norm(), 0.0) << name;
  }
}

Matrix affine_map(Index dimension, double ratio, std::mt19937& random) {
  const auto rotation = [&] {
    const auto any = [&] { return double(random()) / 2147483648.0 - 1.0; };
    return Matrix(Eigen::HouseholderQR<Matrix>(Matrix::NullaryExpr(dimension, dimension, any)).householderQ());
  };
  Vector stretch = Vector::Ones(dimension);
  stretch[1] = ratio;
  Matrix result = rotation() * stretch.asDiagonal() * rotation();
  if (result.determinant() < 0.0) result.col(0) *= -1.0;
  return result;
}

/// An affine map of a mesh makes its cells arbitrarily flat and multiplies its mass by one factor.
TEST(CellwiseEquivalentMass, OfFlatCellsIsThatOfRoundOnes) {
  std::mt19937 random(11);
  for (const char* type : {cellwise, "equivalent-nodewise"}) {
    for (const char* name : some_bodies) {
      const AssembledBody body(body_of_kind(name));
      const Index d = body.space.nodes.rows();
      const SparseMatrix plain = build_mass(type, body.input);
      for (const double ratio : {1.0, 1e3, 1e4, 1e5, 1e6}) {
        const Matrix map = affine_map(d, ratio, random);
        Variant mapped(body);
        mapped.move(map, Vector::Constant(d, 3.0 * ratio));
        const SparseMatrix found = mapped.build(body, type);
        ASSERT_EQ(found.nonZeros(), plain.nonZeros()) << name << ": the same nodes are taken";
        // The rounding of the mapped positions is about 1e-15 times the ratio of the thickness of a cell, and
        // extrapolating weights are hundreds of times as sensitive. At 1e6:1 no digits remain to compare.
        if (ratio <= 1e5) {
          const SparseMatrix change = found / map.determinant() - plain;
          EXPECT_LE(change.coeffs().cwiseAbs().maxCoeff(),
                    (1e-12 * ratio + 1e-11) * plain.coeffs().cwiseAbs().maxCoeff())
              << type << ' ' << name << ' ' << ratio;
        }
        EXPECT_TRUE(is_positive_definite(found, mapped.input.contact_nodes)) << name;
        const Matrix wanted = mass_moments(mapped.consistent, mapped.space.nodes);
        EXPECT_LE((mass_moments(found, mapped.space.nodes) - wanted).cwiseAbs().maxCoeff(),
                  1e-12 * wanted.cwiseAbs().maxCoeff())
            << type << ' ' << name << ' ' << ratio;
      }
    }
  }
}

/// The `kept` cells of a grid of triangles with a slit along x = ½, y < ¾, whose sides have separate nodes.
struct Slit {
  std::unique_ptr<MeshedBody> body;
  std::map<Index, Index> left;  ///< node of the grid → node here, for nodes of cells with x < ½
  SparseMatrix consistent;
  SparseMatrix mass;

  enum class Cells { all, left_half };
  Slit(bool is_cut, Cells kept) {
    const Mesh grid = make_box_mesh({CellShape::triangle, {12, 24}, 1, 0.0, {}});
    Mesh mesh = grid;
    mesh.facets.clear();
    mesh.groups.clear();
    mesh.cells[0].nodes.clear();
    mesh.cells[0].tags.clear();
    std::map<std::pair<Index, bool>, Index> number;
    std::vector<Index> at;
    for (Index cell = 0; cell < grid.cells[0].size(); ++cell) {
      const Index* const nodes = grid.cells[0].cell(cell);
      double middle = 0.0;
      for (int k = 0; k < 3; ++k) middle += grid.nodes(0, nodes[k]) / 3.0;
      if (middle > 0.5 && kept == Cells::left_half) continue;
      for (int k = 0; k < 3; ++k) {
        const bool on_slit = std::abs(grid.nodes(0, nodes[k]) - 0.5) < 1e-9 && grid.nodes(1, nodes[k]) < 0.74;
        const auto [place, is_new] =
            number.emplace(std::pair(nodes[k], is_cut && on_slit && middle > 0.5), Index(number.size()));
        if (is_new) at.push_back(nodes[k]);
        if (middle < 0.5) left[nodes[k]] = place->second;
        mesh.cells[0].nodes.push_back(place->second);
      }
      mesh.cells[0].tags.push_back(cell + 1);
    }
    mesh.nodes = grid.nodes(Eigen::all, at);
    mesh.node_tags.resize(at.size());
    std::iota(mesh.node_tags.begin(), mesh.node_tags.end(), 1);
    body = make_meshed_body(mesh, 1);
    // The displacement space has its own numbering.
    for (auto& [from, to] : left) to = space_node(to);
    consistent = assemble_scalar_mass(body->body, node_graph(body->space));
    const CellMasses cells(body->body);
    MassInput input{&consistent, &body->space.nodes, {}, nullptr, &cells};
    // Nodes beside the slit, nearer to its other side than to free nodes of their own side.
    for (const auto& [from, to] : left) {
      if (grid.nodes(0, from) > 0.24 && grid.nodes(1, from) < 0.5) input.contact_nodes.push_back(to);
    }
    std::ranges::sort(input.contact_nodes);
    mass = build_mass(cellwise, input);
  }
  [[nodiscard]] Index space_node(Index mesh_node) const {
    const std::vector<Index>& of_mesh = body->mesh.cells[0].nodes;
    const auto place = std::ranges::find(of_mesh, mesh_node) - of_mesh.begin();
    return body->space.cells[0].nodes[std::size_t(place)];
  }
};

TEST(CellwiseEquivalentMass, NothingIsHandedAcrossASlit) {
  const Slit cut(true, Slit::Cells::all), arm(false, Slit::Cells::left_half), whole(false, Slit::Cells::all);
  const double largest = arm.mass.coeffs().cwiseAbs().maxCoeff();
  double of_cut = 0.0, of_whole = 0.0;
  for (const auto& [from, to] : arm.left) {
    if (arm.body->space.nodes(1, to) > 0.3) continue;  // farther up the other half may matter
    const double here = arm.mass.coeff(to, to);
    of_cut = std::max(of_cut, std::abs(cut.mass.coeff(cut.left.at(from), cut.left.at(from)) - here));
    of_whole = std::max(of_whole, std::abs(whole.mass.coeff(whole.left.at(from), whole.left.at(from)) - here));
  }
  EXPECT_LE(of_cut, 1e-13 * largest);
  EXPECT_GE(of_whole, 1e-2 * largest) << "else this shows nothing";
}

/// Damping ∫aρ φ_i φ_j is redistributed like the inertia.
TEST(CellwiseEquivalentMass, OfDamping) {
  for (const char* name : some_bodies) {
    AssembledBody body(body_of_kind(name));
    Material second = body.body.materials[0];
    body.body.materials.push_back(second);
    for (std::size_t cell = 0; cell < body.body.cell_material.size(); ++cell)
      body.body.cell_material[cell] = cell % 3 == 0 ? 1 : 0;
    const SparseMatrix mass = build_mass(cellwise, body.input);
    for (const std::vector<double>& rates : {std::vector{0.7, 0.7}, std::vector{0.0, 0.3}, std::vector{0.0, 0.0}}) {
      const SparseMatrix damping = assemble_scalar_mass(body.body, node_graph(body.space), rates);
      const CellMasses cells(body.body, rates);
      const SparseMatrix found =
          build_mass(cellwise, {&damping, &body.space.nodes, body.input.contact_nodes, &body.consistent, &cells});
      const Matrix wanted = mass_moments(damping, body.space.nodes);
      EXPECT_LE((mass_moments(found, body.space.nodes) - wanted).cwiseAbs().maxCoeff(),
                1e-12 * wanted.cwiseAbs().maxCoeff())
          << name;
      EXPECT_EQ((found - SparseMatrix(found.transpose())).norm(), 0.0) << name;
      if (rates[0] == rates[1]) {
        EXPECT_LE((found - rates[0] * mass).norm(), 1e-14 * mass.norm()) << name << ": one rate";
      }
      // Semi-definite: no motion gains energy.
      std::mt19937 random(3);
      for (int k = 0; k < 20; ++k) {
        const Vector v = Vector::NullaryExpr(found.cols(), [&] { return double(random()) / 2147483648.0 - 1.0; });
        EXPECT_GE(v.dot(found * v), -1e-14 * v.squaredNorm() * found.norm()) << name;
      }
    }
  }
}

/// ωR/c_s of the lowest torsional mode of a free ball, by inverse iteration without rigid motions.
double torsion(const AssembledBody& body, const SparseMatrix& scalar_mass) {
  const SparseMatrix stiffness = assemble_stiffness(body.body, node_graph(body.space));
  const SparseMatrix mass = expand_to_components(scalar_mass, 3);
  const Points& x = body.space.nodes;
  Matrix rigid = Matrix::Zero(mass.cols(), 6);
  Vector u(mass.cols());
  for (Index i = 0; i < x.cols(); ++i) {
    const Eigen::Vector3d r = x.col(i);
    rigid.block<3, 3>(3 * i, 0).setIdentity();
    for (int k = 0; k < 3; ++k) rigid.block<3, 1>(3 * i, 3 + k) = Eigen::Vector3d::Unit(k).cross(r);
    u.segment<3>(3 * i) = r.cross(Eigen::Vector3d(r.y(), r.x(), 0.0));  // r × ∇(xy)
  }
  const Matrix gram = rigid.transpose() * (mass * rigid);
  SparseCholesky factor(SparseMatrix(stiffness + 0.5 * mass));
  Vector next;
  for (int step = 0; step < 12; ++step) {
    u -= rigid * gram.ldlt().solve(rigid.transpose() * (mass * u));
    factor.solve(mass * u, next);
    u = next / next.norm();
  }
  u -= rigid * gram.ldlt().solve(rigid.transpose() * (mass * u));
  const double shear_speed = std::sqrt(1.0 / 3.0);  // μ = 1, ρ = 3, R = 1
  return std::sqrt(u.dot(stiffness * u) / u.dot(mass * u)) / shear_speed;
}

TEST(CellwiseEquivalentMass, FrequenciesAreAsNearToTheExactOnesAsWithTheConsistentMass) {
  // η j₂'(η) = j₂(η) with the spherical Bessel function j₂: no traction on r = R.
  const auto traction = [](double z) {
    const auto j2 = [](double t) { return (3.0 / (t * t) - 1.0) * std::sin(t) / t - 3.0 * std::cos(t) / (t * t); };
    const double step = 1e-5;
    return z * (j2(z + step) - j2(z - step)) / (2.0 * step) - j2(z);
  };
  double low = 2.4, high = 2.6;
  for (int k = 0; k < 60; ++k) (traction(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  EXPECT_NEAR(low, 2.5011, 1e-4);
  double coarse_shift = 0.0;
  for (const double size : {0.2, 0.1}) {
    BodyDescription description = body_of_kind("ball, h 0.4");
    description.size = size;
    const AssembledBody body(description);
    const double discretization = torsion(body, body.consistent) / low - 1.0;
    const double found = torsion(body, build_mass(cellwise, body.input)) / low - 1.0;
    std::printf(
        "ball, %td nodes: torsional frequency off by %+.2f %% with the consistent mass, %+.2f %% cell by cell\n",
        body.space.nodes.cols(), 100.0 * discretization, 100.0 * found);
    // Second order, from above: displacement elements are too stiff.
    EXPECT_GT(discretization, 0.0);
    const double shift = discretization - found;
    EXPECT_GT(shift, 0.0) << "what is handed over moves further out";
    if (size == 0.1) {
      EXPECT_LE(std::abs(found), 1.1 * discretization);
      EXPECT_LE(shift, 0.25 * coarse_shift) << "it falls faster than the error of discretization";
    }
    coarse_shift = shift;
  }
}

}  // namespace ricochet::test_support::cellwise_equivalent_mass_test
