#include "support/inf_sup.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>

#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "support/box_mesh.hpp"
#include "support/paths.hpp"

/// @file Inf–sup stability of pairs of displacement and multiplier spaces: the numerical constant on families of
/// meshes. The test prints the table of docs/multipliers.md, and checks the numbers on that page.
namespace ricochet::test_support::inf_sup_test {

const std::vector<std::string>& spaces() {
  static const std::vector<std::string> all = multiplier_space_names();
  return all;
}

/// Meshes of one kind under refinement.
struct Family {
  CellShape shape = CellShape::triangle;
  int degree = 1;  ///< of the displacement
  std::string boundary;

  [[nodiscard]] int dimension() const { return ricochet::dimension(shape); }
  /// Numbers of cells along the contact boundary (for a ring: along its thickness).
  [[nodiscard]] std::vector<int> refinements() const {
    if (boundary == "circle") return {2, 4, 8, 16};
    if (dimension() == 2) return {4, 8, 16, 32};
    return degree == 1 ? std::vector<int>{2, 4, 8} : std::vector<int>{2, 4, 6};
  }
  [[nodiscard]] std::string label() const {
    return plural_name(shape) + ", degree " + std::to_string(degree) + ", " + boundary;
  }
};

std::vector<Family> families() {
  std::vector<Family> result;
  for (const CellShape shape : all_cell_shapes()) {
    for (const int degree : {1, 2}) {
      for (const char* boundary : {"flat", "held edge", dimension(shape) == 2 ? "circle" : "bent"}) {
        result.push_back({shape, degree, boundary});
      }
    }
  }
  return result;
}

/// Joins the nodes of two sides that a map brings together on the axis y = 0, x > 0.
void join_coincident_nodes(Mesh& mesh) {
  std::vector<Index> number(static_cast<std::size_t>(mesh.node_count()));
  std::vector<Index> kept;
  for (Index node = 0; node < mesh.node_count(); ++node) {
    const auto same = [&](Index other) { return (mesh.nodes.col(node) - mesh.nodes.col(other)).norm() < 1e-9; };
    const bool on_seam = std::abs(mesh.nodes(1, node)) < 1e-9 && mesh.nodes(0, node) > 0.0;
    const auto found = on_seam ? std::ranges::find_if(kept, same) : kept.end();
    number[std::size_t(node)] = found - kept.begin();
    if (found == kept.end()) kept.push_back(node);
  }
  Points nodes(mesh.dimension, Index(kept.size()));
  std::vector<std::int64_t> tags;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    nodes.col(Index(i)) = mesh.nodes.col(kept[i]);
    tags.push_back(std::int64_t(i) + 1);
  }
  mesh.nodes = nodes;
  mesh.node_tags = tags;
  for (std::vector<CellBlock>* blocks : {&mesh.cells, &mesh.facets}) {
    for (CellBlock& block : *blocks) {
      for (Index& node : block.nodes) node = number[std::size_t(node)];
    }
  }
}

/// A ring of radii 1/2 and 1 whose outer circle is the contact boundary; cells of uneven lengths.
Mesh ring(CellShape shape, int n) {
  const PointMap map = [](const Vector& x) -> Vector {
    const double angle = -2.0 * M_PI * x[0] + 0.1 * std::sin(6.0 * M_PI * x[0]);
    const double radius = 0.5 + 0.5 * x[1];
    return Eigen::Vector2d(radius * std::cos(angle), radius * std::sin(angle));
  };
  Mesh mesh = make_box_mesh({shape, {10 * n, n}, 2, 0.0, map});
  join_coincident_nodes(mesh);
  return mesh;
}

double constant(const Family& family, const std::string& multipliers, int n) {
  const int d = family.dimension();
  if (family.boundary == "circle") {
    const auto test = make_meshed_body(ring(family.shape, n), family.degree);
    return inf_sup_constant(test->body, test->mesh.group("y1", 1).members, multipliers);
  }
  const bool bent = family.boundary == "bent";
  const BoxMesh box{family.shape, std::vector<int>(std::size_t(d), n), bent ? 2 : 1, 0.15,
                    bent ? bend_map() : PointMap{}};
  const auto test = make_meshed_body(make_box_mesh(box), family.degree);
  const Points& nodes = test->space.nodes;
  std::function<bool(Index)> is_held;
  if (family.boundary == "held edge") {
    is_held = [&nodes, d](Index node) {
      for (int k = 0; k < d - 1; ++k) {
        if (nodes(k, node) < 1e-9 || nodes(k, node) > 1.0 - 1e-9) return true;
      }
      return false;
    };
  }
  return inf_sup_constant(test->body, test->mesh.group(d == 2 ? "y0" : "z0", d - 1).members, multipliers, is_held);
}

/// Table of the page: for each family and space the constants on its meshes.
std::map<std::string, std::vector<std::vector<double>>> documented() {
  std::map<std::string, std::vector<std::vector<double>>> result;
  std::ifstream page(source_path("docs/multipliers.md"));
  std::string line;
  while (std::getline(page, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    if (cells.size() != 6) continue;
    std::vector<std::vector<double>> numbers;
    for (std::size_t k = 2; k < cells.size(); ++k) {
      std::istringstream list(cells[k]);
      numbers.emplace_back();
      for (double value = 0.0; list >> value;) numbers.back().push_back(value);
    }
    const std::string family = cells[1].substr(1, cells[1].size() - 2);
    if (!numbers.front().empty()) result[family] = numbers;
  }
  return result;
}

class InfSupTest : public testing::TestWithParam<Family> {};

TEST_P(InfSupTest, ConstantsTellStableFromUnstableAndAreThoseOfThePage) {
  const Family& family = GetParam();
  const std::vector<int> sizes = family.refinements();
  const CellShape facet = family.dimension() == 2                  ? CellShape::interval
                          : family.shape == CellShape::tetrahedron ? CellShape::triangle
                                                                   : CellShape::quadrilateral;
  const auto table = documented();
  const auto entry = table.find(family.label());
  EXPECT_NE(entry, table.end()) << "docs/multipliers.md has no row \"" << family.label() << "\"";
  std::string row = "| " + family.label() + " |";
  for (std::size_t s = 0; s < spaces().size(); ++s) {
    std::vector<double> found;
    for (const int n : sizes) {
      found.push_back(constant(family, spaces()[s], n));
      char text[32];
      std::snprintf(text, sizeof text, " %.4f", found.back());
      row += text;
    }
    row += " |";
    const std::size_t last = found.size() - 1;
    const double decay = std::log(found[last - 1] / found[last]) / std::log(double(sizes[last]) / sizes[last - 1]);
    if (instability(spaces()[s], facet, family.degree).empty()) {
      EXPECT_GT(found[last], 0.1) << spaces()[s];
      EXPECT_LT(decay, 0.25) << spaces()[s];
    } else if (found[last] > 1e-4) {
      EXPECT_GT(decay, 0.75) << spaces()[s];
    }
    if (entry == table.end()) continue;
    ASSERT_EQ(entry->second.at(s).size(), found.size()) << spaces()[s];
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k], entry->second[s][k], 0.02 * found[k] + 5e-5) << spaces()[s] << ", mesh " << k;
    }
  }
  std::printf("%s\n", row.c_str());
}

INSTANTIATE_TEST_SUITE_P(Families, InfSupTest, testing::ValuesIn(families()), [](const auto& info) {
  std::string label = info.param.label();
  std::erase_if(label, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return label;
});

/// Other length units, and another position of the body, give the same constant.
TEST(InfSup, HasNoUnit) {
  const auto at = [](double scale) {
    const PointMap map = affine_map(scale * Matrix::Identity(2, 2), Vector::Constant(2, scale));
    const auto test = make_meshed_body(make_box_mesh({CellShape::triangle, {4, 4}, 1, 0.15, map}), 2);
    return inf_sup_constant(test->body, test->mesh.group("y0", 1).members, "p1");
  };
  EXPECT_EQ(at(1.0), at(1024.0));
}

/// Symptom of an unstable pair: a pressure that does no work on any displacement.
TEST(InfSup, AlternatingFacetPressuresDoNoWorkOnAClosedBoundary) {
  const auto test = make_meshed_body(ring(CellShape::triangle, 2), 1);
  EXPECT_LT(inf_sup_constant(test->body, test->mesh.group("y1", 1).members, "p0"), 0.1);
  EXPECT_FALSE(instability("p0", CellShape::interval, 1).empty());
  EXPECT_TRUE(instability("p0", CellShape::interval, 2).empty());
}

}  // namespace ricochet::test_support::inf_sup_test
