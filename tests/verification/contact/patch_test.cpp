#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

#include "ricochet/contact/construction/make_contact_boundary.hpp"
#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/simulation/statics/static_equilibrium.hpp"
#include "support/box_mesh.hpp"
#include "support/paths.hpp"

/// @file Contact patch test: a block pressed on a tilted plane by a uniform pressure on the opposite side. The exact
/// solution is a uniform stress, so the contact pressure is uniform. The test prints the table of docs/multipliers.md
/// and checks the numbers on that page.
namespace ricochet::test_support::patch_test {

constexpr double pressure = 0.02;
constexpr double closing = 0.01;  ///< gap to the plane at the start

/// Shape of the cells of the block; its sides are flat.
enum class Cells { straight, curved };

/// Moves nodes within the sides of the unit box: with second-order geometry the edges of cells become curved, also on
/// the contact side.
Vector curve(const Vector& x) {
  Vector result = x;
  for (Index k = 0; k < x.size(); ++k) {
    result[k] += (0.05 - 0.01 * double(k)) * std::sin(M_PI * x[k]) *
                 std::sin(2.0 * M_PI * x[(k + 1) % x.size()] + 0.6) *
                 (x.size() == 3 ? 1.0 - 0.5 * x[(k + 2) % 3] : 1.0);
  }
  return result;
}

/// Rotation of the block and the plane.
Matrix turn(int dimension) {
  if (dimension == 2) return Eigen::Rotation2Dd(0.4).toRotationMatrix();
  return Eigen::AngleAxisd(0.5, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
}

class PressedBlock {
 public:
  PressedBlock(const ElementKind& kind, Cells cells, const std::string& multipliers, bool held_side = false)
      : d_(kind.dimension()), held_side_(held_side) {
    const Matrix rotation = turn(d_);
    const Vector shift = Vector::LinSpaced(d_, 0.3, -0.7);
    const PointMap map = [=](const Vector& x) -> Vector {
      return rotation * (cells == Cells::curved ? curve(x) : x) + shift;
    };
    const std::vector<int> counts = d_ == 2 ? std::vector<int>{4, 3} : std::vector<int>{3, 3, 2};
    test_ = make_meshed_body(make_checked_box_mesh({kind.shape, counts, kind.geometry_degree, 0.15, map}),
                             kind.displacement_degree);
    const Vector normal = rotation.col(d_ - 1);
    obstacle_ = make_plane(shift - closing * normal, normal);
    exact_ = interpolate(test_->space, [&](const Vector& x) -> Vector {
      return rotation * strain() * rotation.transpose() * (x - shift) - closing * normal;
    });
    set_up_problem(rotation, shift, normal, multipliers);
  }

  /// Finds the equilibrium, for which the solver determines the active points.
  void find_equilibrium() {
    const Vector zero = Vector::Zero(test_->space.dof_count());
    const StaticEquilibrium found = static_equilibrium(problem_, zero, zero);
    displacement_ = found.displacement;
    reaction_ = found.normal_reaction;
  }
  /// Solves K U = L + Gᵀr, G U + g₀ = 0 with the supports, for any signs of r.
  void press_all_points() {
    const Index dofs = test_->space.dof_count();
    const Index points = problem_.contact.size();
    const Index held = problem_.supports.size();
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](Index row, Index column, double value) { entries.emplace_back(int(row), int(column), value); };
    const SparseMatrix& stiffness = problem_.internal_force->tangent();
    for (Index column = 0; column < dofs; ++column) {
      for (SparseMatrix::InnerIterator entry(stiffness, column); entry; ++entry)
        add(entry.row(), column, entry.value());
    }
    for (Index i = 0; i < points; ++i) {
      for (SparseRowMatrix::InnerIterator entry(problem_.contact.rows->gap_operator, i); entry; ++entry) {
        add(dofs + i, entry.col(), entry.value());
        add(entry.col(), dofs + i, -entry.value());
      }
    }
    Vector right(dofs + points + held), supported;
    problem_.supports.values(0.0, supported);
    right << problem_.loads.constant(), -problem_.contact.initial_gap, supported;
    for (Index k = 0; k < held; ++k) {
      const Index dof = problem_.supports.dofs()[std::size_t(k)];
      add(dofs + points + k, dof, 1.0);
      add(dof, dofs + points + k, -1.0);
    }
    SparseMatrix system(right.size(), right.size());
    system.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseLU<SparseMatrix> factor(system);
    ASSERT_EQ(factor.info(), Eigen::Success);
    const Vector solution = factor.solve(right);
    displacement_ = solution.head(dofs);
    reaction_ = solution.segment(dofs, points);
  }

  /// Largest deviation of the pressure at nodes that are free to move along the normal, relative to the exact one.
  [[nodiscard]] double node_deviation() const {
    const Vector found = problem_.contact.pressure_recovery * reaction_;
    double largest = 0.0;
    for (Index i = 0; i < found.size(); ++i) {
      const Index first = problem_.contact.nodes[std::size_t(i)] * d_;
      bool held = true;
      for (int k = 0; k < d_; ++k) held = held && problem_.supports.contains(first + k);
      if (!held) largest = std::max(largest, std::abs(found[i] / pressure - 1.0));
    }
    return largest;
  }
  /// Largest deviation of the reactions from those of the uniform pressure, relative to the largest of these.
  [[nodiscard]] double reaction_deviation() const {
    const Vector expected = pressure * problem_.contact.weights;
    return (reaction_ - expected).lpNorm<Eigen::Infinity>() / expected.lpNorm<Eigen::Infinity>();
  }
  /// Largest deviation of the displacement, relative to the largest that the pressure causes.
  [[nodiscard]] double displacement_deviation() const {
    return (displacement_ - exact_).lpNorm<Eigen::Infinity>() / (pressure / test_material().young());
  }
  /// Largest of these deviations.
  [[nodiscard]] double deviation() const {
    return std::max({node_deviation(), reaction_deviation(), displacement_deviation()});
  }
  [[nodiscard]] double smallest_weight() const { return problem_.contact.weights.minCoeff(); }
  /// Deviation of the resultant reaction from the resultant of the pressure.
  [[nodiscard]] double resultant_deviation() const {
    return std::abs(reaction_.sum() / (pressure * problem_.contact.weights.sum()) - 1.0);
  }

 private:
  /// Strain under a pressure along the last axis, with free sides.
  [[nodiscard]] Matrix strain() const {
    const Material material = test_material();
    Matrix stress = Matrix::Zero(d_, d_);
    stress(d_ - 1, d_ - 1) = -pressure;
    const double share = material.lambda() / (d_ * material.lambda() + 2.0 * material.mu());
    return (stress - share * stress.trace() * Matrix::Identity(d_, d_)) / (2.0 * material.mu());
  }

  void set_up_problem(const Matrix& rotation, const Vector& shift, const Vector& normal,
                      const std::string& multipliers) {
    const Body& body = test_->body;
    const NodeGraph graph = node_graph(test_->space);
    problem_.dimension = d_;
    problem_.nodes = test_->space.nodes;
    problem_.internal_force = std::make_shared<LinearElasticity>(assemble_stiffness(body, graph), problem_.nodes);
    problem_.loads = Loads(test_->space.dof_count());
    Vector load = Vector::Zero(test_->space.dof_count());
    add_facet_load(
        body, test_->mesh.group(d_ == 2 ? "y1" : "z1", d_ - 1).members,
        [&](const Vector&, Vector& density) { density = -pressure * normal; }, load);
    problem_.loads.add_constant(load);
    // Motions that contact leaves free: translations along the plane and the rotation about its normal.
    const Index corner = nearest_node(test_->space, shift).node;
    for (int k = 0; k < d_ - 1; ++k) hold(corner, k);
    if (d_ == 3) hold(nearest_node(test_->space, shift + rotation.col(0)).node, 1);
    // Or a whole side at which the contact boundary ends, displaced as in the exact solution.
    if (held_side_) {
      for (const Index node : facet_nodes(test_->space, test_->mesh.group("x1", d_ - 1).members)) {
        for (int k = 0; k < d_; ++k) hold(node, k);
      }
    }
    problem_.supports.finish();
    const std::string side = d_ == 2 ? "y0" : "z0";
    problem_.contact = make_contact_boundary(
        body, {{side, test_->mesh.group(side, d_ - 1).members, "plane", obstacle_.get(), {}, multipliers}},
        [this](Index node, int k) { return !problem_.supports.contains(node * d_ + k); });
    problem_.obstacles = {obstacle_.get()};
    finish_problem(problem_, expand_to_components(assemble_scalar_mass(body, graph), d_), false);
  }

  void hold(Index node, int component) {
    const Index dof = node * d_ + component;
    problem_.supports.add(dof, Expression(exact_[dof]));
  }

  int d_;
  bool held_side_;
  std::unique_ptr<MeshedBody> test_;
  std::unique_ptr<Obstacle> obstacle_;
  SemidiscreteProblem problem_;
  Vector exact_;
  Vector displacement_, reaction_;
};

/// Whether a uniform pressure has tensile nodal forces, which contact cannot transmit: curved six-node triangles.
bool pulls(const ElementKind& kind, const std::string& multipliers) {
  return multipliers == "nodal" && kind.shape == CellShape::tetrahedron && kind.geometry_degree == 2 &&
         kind.displacement_degree == 2;
}

/// Table of the documentation page: row → its cells.
std::map<std::string, std::vector<std::string>> documented() {
  std::map<std::string, std::vector<std::string>> result;
  std::ifstream page(source_path("docs/multipliers.md"));
  std::string line;
  while (std::getline(page, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) {
      cells.push_back(cell.size() > 2 ? cell.substr(1, cell.size() - 2) : "");
    }
    if (cells.size() == 6) result[cells[1]] = {cells.begin() + 2, cells.end()};
  }
  return result;
}

std::string row_name(const ElementKind& kind) {
  return name(kind.shape) + ", geometry " + std::to_string(kind.geometry_degree) + ", displacement " +
         std::to_string(kind.displacement_degree);
}

class ContactPatchTest : public testing::TestWithParam<ElementKind> {
 protected:
  static std::vector<std::string> stable_spaces() {
    std::vector<std::string> result;
    for (const std::string& multipliers : multiplier_space_names()) {
      if (instability(multipliers, facet_shape(GetParam().shape, 0), GetParam().displacement_degree).empty()) {
        result.push_back(multipliers);
      }
    }
    return result;
  }
};

/// Without sign conditions every multiplier space reproduces the uniform pressure to rounding, if the displacement
/// space contains the affine displacement.
TEST_P(ContactPatchTest, UniformPressureIsThatOfThePressedBoundary) {
  const ElementKind& kind = GetParam();
  for (const Cells cells : {Cells::straight, Cells::curved}) {
    if (cells == Cells::curved && !kind.contains_affine()) continue;
    for (const std::string& multipliers : stable_spaces()) {
      for (const bool held_side : {false, true}) {
        SCOPED_TRACE(multipliers + (cells == Cells::straight ? ", straight" : ", curved") +
                     (held_side ? ", held" : ""));
        PressedBlock block(kind, cells, multipliers, held_side);
        block.press_all_points();
        EXPECT_LE(block.deviation(), 1e-11);
      }
    }
  }
}

/// Sign conditions preserve this, except for tensile nodal forces. The page tabulates the deviations.
TEST_P(ContactPatchTest, UniformPressureIsTransmittedOrDeviatesAsThePageSays) {
  const ElementKind& kind = GetParam();
  const auto table = documented();
  const auto entry = table.find(row_name(kind));
  EXPECT_NE(entry, table.end()) << "docs/multipliers.md has no row \"" << row_name(kind) << "\"";
  std::string row = "| " + row_name(kind) + " |";
  const std::vector<std::string> names = multiplier_space_names();
  const std::vector<std::string> stable = stable_spaces();
  for (std::size_t s = 0; s < names.size(); ++s) {
    SCOPED_TRACE(names[s]);
    const std::string stated = entry == table.end() ? "" : entry->second.at(s);
    if (std::ranges::find(stable, names[s]) == stable.end()) {
      EXPECT_EQ(stated, "unstable");
      row += " unstable |";
      continue;
    }
    PressedBlock block(kind, Cells::curved, names[s]);
    block.find_equilibrium();
    EXPECT_LE(block.resultant_deviation(), 1e-8);
    if (kind.contains_affine() && !pulls(kind, names[s])) {
      EXPECT_LE(block.deviation(), 1e-8);
      EXPECT_EQ(stated, "exact");
      row += " exact |";
      continue;
    }
    EXPECT_EQ(block.smallest_weight() < -1e-10, pulls(kind, names[s]));
    char text[32];
    std::snprintf(text, sizeof text, " %.2f %% |", 100.0 * block.node_deviation());
    row += text;
    EXPECT_NEAR(std::atof(stated.c_str()), 100.0 * block.node_deviation(), 0.01 + 2.0 * block.node_deviation());
  }
  std::printf("%s\n", row.c_str());
}

INSTANTIATE_TEST_SUITE_P(Elements, ContactPatchTest, testing::ValuesIn(all_element_kinds()),
                         [](const auto& info) { return info.param.label(); });

}  // namespace ricochet::test_support::patch_test
