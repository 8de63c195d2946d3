#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "ricochet/base/point_sets.hpp"
#include "ricochet/contact/mortar/choose_side.hpp"
#include "ricochet/contact/mortar/facet_surface.hpp"
#include "ricochet/contact/mortar/normal_variation.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/fem/mesh_measures.hpp"
#include "ricochet/model/model_parts.hpp"
#include "ricochet/rigid/surface/rigid_surface.hpp"
#include "ricochet/simulation/monitor/facet_sizes.hpp"
#include "support/surface_files.hpp"
#include "support/two_bodies.hpp"

/// @file Measures of facets, cells, bodies and surfaces under rotations, reflections, renumbering and changes of units.
/// The bounding box of points is excluded: it depends on the axes of the frame.
namespace ricochet::test_support {
namespace {

/// A change of frame, numbering and units.
struct Change {
  Matrix map;  ///< orthogonal
  double length = 1.0, time = 1.0, mass = 1.0;
  bool renumbers = false;
};

Matrix rotation(int dimension, double angle) {
  const Eigen::Vector3d axis = dimension == 2 ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(1.0, 2.0, -0.5).normalized();
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix().topLeftCorner(dimension, dimension);
}

std::vector<std::pair<std::string, Change>> changes(int d) {
  Matrix mirror = Matrix::Identity(d, d);
  mirror(0, 0) = -1.0;
  const Matrix same = Matrix::Identity(d, d);
  return {{"rotated by 45 degrees", {rotation(d, std::atan(1.0))}},
          {"rotated by 1.1", {rotation(d, 1.1)}},
          {"reflected", {mirror}},
          {"renumbered", {same, 1.0, 1.0, 1.0, true}},
          {"in millimetres, microseconds and tonnes", {same, 1e3, 1e6, 1e-3}},
          {"all at once", {mirror * rotation(d, -0.4), 1e-2, 3.0, 7.0, true}}};
}

template <class Value>
std::vector<Value> permuted(const std::vector<Value>& values, const std::vector<Index>& order, int width) {
  std::vector<Value> result;
  for (const Index from : order)
    result.insert(result.end(), values.begin() + from * width, values.begin() + (from + 1) * width);
  return result;
}

std::vector<Index> random_order(Index count, std::mt19937& random) {
  std::vector<Index> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), Index{0});
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

/// Reorders cells or facets within their blocks, and adapts the members of groups.
void reorder(std::vector<CellBlock>& blocks, int dimension, std::vector<Group>& groups, std::mt19937& random) {
  Index first = 0;
  std::vector<Index> number;  // new number of each
  for (CellBlock& block : blocks) {
    const std::vector<Index> order = random_order(block.size(), random);
    block.nodes = permuted(block.nodes, order, block.nodes_per_cell);
    block.tags = permuted(block.tags, order, 1);
    number.resize(number.size() + order.size());
    for (std::size_t i = 0; i < order.size(); ++i) number[std::size_t(first + order[i])] = first + Index(i);
    first += block.size();
  }
  for (Group& group : groups) {
    if (group.dimension != dimension) continue;
    for (Index& member : group.members) member = number[std::size_t(member)];
    std::ranges::sort(group.members);
  }
}

Mesh changed(Mesh mesh, const Change& change) {
  mesh.nodes = change.length * change.map * mesh.nodes;
  if (!change.renumbers) return mesh;
  std::mt19937 random{5};
  const std::vector<Index> order = random_order(mesh.node_count(), random);
  Points nodes(mesh.nodes.rows(), mesh.nodes.cols());
  std::vector<Index> number(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    nodes.col(Index(i)) = mesh.nodes.col(order[i]);
    number[std::size_t(order[i])] = Index(i);
  }
  mesh.nodes = nodes;
  for (std::vector<CellBlock>* const blocks : {&mesh.cells, &mesh.facets}) {
    for (CellBlock& block : *blocks) {
      for (Index& node : block.nodes) node = number[std::size_t(node)];
    }
  }
  mesh.parts.clear();
  reorder(mesh.cells, mesh.dimension, mesh.groups, random);
  reorder(mesh.facets, mesh.dimension - 1, mesh.groups, random);
  return mesh;
}

/// Numbers in no particular order, with their powers of length and time.
struct Measure {
  std::vector<double> values;
  int length = 0, time = 0;
};
using Measures = std::map<std::string, Measure>;

void add_surface(const Body& body, const std::string& group, Measures& all) {
  const int d = body.mesh->dimension;
  const std::vector<Index> facets = body.mesh->group(group, d - 1).members;
  const FacetSurface surface(body, facets);
  Measure areas{{}, d - 1}, sizes{{}, 1}, heights{{}, 1}, diameters{{}, 1};
  for (const FacetSurface::Facet& facet : surface.facets()) {
    areas.values.push_back(facet.area);
    sizes.values.push_back(facet.size);
    heights.values.push_back(facet.cell_height);
    diameters.values.push_back(facet_diameter(*body.mesh, facet.number));
  }
  all["areas of facets of " + group] = areas;
  all["sizes of facets of " + group] = sizes;
  all["heights of facets of " + group] = heights;
  all["diameters of facets of " + group] = diameters;
  all["spacing of nodes of " + group] = {{node_spacing(*body.space, facets)}, 1};
  const FacetSizes around = facet_sizes(body, facets);
  all["smallest facets around nodes of " + group] = {around.smallest, 1};
  all["largest facets around nodes of " + group] = {around.largest, 1};
  const MeshMeasure measure = measure_group(*body.mesh, body.mesh->group(group, d - 1));
  all["size of " + group] = {{measure.size}, d - 1};
  all["mean normal of " + group] = {{measure.mean_normal.norm()}};
}

Measures measures_of(const Mesh& mesh, const Change& change) {
  const int d = mesh.dimension;
  const auto test = make_meshed_body(mesh, mesh.degree);
  Body body = test->body;
  for (Material& material : body.materials) {
    const double stress = change.mass / (change.length * change.time * change.time);
    material.density *= change.mass / std::pow(change.length, 3);
    material.law = make_linear_elasticity(stress * 30.0, stress * 20.0);
  }
  Measures all;
  all["diameter of all"] = {{enclosing_diameter(mesh.nodes)}, 1};
  const BodiesOfMesh bodies = describe_bodies(body);
  all["diameters of bodies"] = {bodies.sizes, 1};
  all["crossing times of bodies"] = {bodies.crossing_times, 0, 1};
  all["crossing times of cells"] = {cell_crossing_times(body), 0, 1};
  all["heights of cells"] = {cell_heights(mesh), 1};
  const std::string below = d == 2 ? "lower.y1" : "lower.z1", above = d == 2 ? "upper.y0" : "upper.z0";
  add_surface(body, below, all);
  add_surface(body, above, all);
  ContactPair pair;
  pair.facets = mesh.group(below, d - 1).members;
  pair.opposite_facets = mesh.group(above, d - 1).members;
  all["distance of facets from curved surfaces"] = {{distance_from_curved(body, pair)}, 1};
  for (const bool large_sliding : {false, true}) {
    pair.large_sliding = large_sliding;
    all[large_sliding ? "choice of side, sliding far" : "choice of side"] = {
        {choose_side(body, pair).opposite ? 1.0 : 0.0}};
  }
  const NormalVariation turns = normal_variation(body, pair.facets, pair.opposite_facets);
  all["turns where surfaces can touch"] = {{turns.own, turns.own_of_bends, turns.opposite, turns.opposite_of_bends}};
  EXPECT_GT(turns.own_of_bends, 0.0);
  return all;
}

void expect_same(const Measures& plain, const Measures& other, const Change& change, const std::string& what) {
  for (const auto& [name, measure] : plain) {
    std::vector<double> expected = measure.values, found = other.at(name).values;
    for (double& value : expected)
      value *= std::pow(change.length, measure.length) * std::pow(change.time, measure.time);
    std::ranges::sort(expected);
    std::ranges::sort(found);
    ASSERT_EQ(found.size(), expected.size()) << name;
    const double size = std::max(std::abs(expected.front()), std::abs(expected.back()));
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i], expected[i], 1e-11 * size) << name << ", " << what;
  }
}

class MeasureInvariance : public testing::TestWithParam<ElementKind> {};

/// Two blocks of distorted cells, the upper one with a round lower side, so that facets of hexahedra are not plane.
TEST_P(MeasureInvariance, OfBodiesAndTheirSurfaces) {
  const int d = GetParam().dimension();
  StackedBoxes stack;
  stack.lower_shape = stack.upper_shape = GetParam().shape;
  stack.lower_counts.assign(std::size_t(d), 2);
  stack.upper_counts.assign(std::size_t(d), 3);
  stack.geometry_degree = GetParam().geometry_degree;
  stack.upper_map = [](const Vector& x) -> Vector {
    Vector y = x;
    const Vector side = x.head(x.size() - 1).array() - 0.5;
    y[x.size() - 1] = 1.05 + x[x.size() - 1] + 0.6 * (1.0 - x[x.size() - 1]) * side.squaredNorm();
    return y;
  };
  const Mesh mesh = make_stack(stack);
  const Measures plain = measures_of(mesh, {Matrix::Identity(d, d)});
  for (const auto& [what, change] : changes(d))
    expect_same(plain, measures_of(changed(mesh, change), change), change, what);
}

INSTANTIATE_TEST_SUITE_P(Elements, MeasureInvariance,
                         testing::ValuesIn(std::vector<ElementKind>{{CellShape::triangle, 1, 1},
                                                                    {CellShape::triangle, 2, 2},
                                                                    {CellShape::quadrilateral, 1, 1},
                                                                    {CellShape::tetrahedron, 1, 1},
                                                                    {CellShape::tetrahedron, 2, 2},
                                                                    {CellShape::hexahedron, 1, 1}}),
                         [](const auto& of) { return of.param.label(); });

/// No measure of a warped quadrilateral depends on the diagonal that would divide it into triangles.
TEST(MeasureInvariance, OfAWarpedFacetWhereverItsNumberingBegins) {
  Mesh mesh = make_box_mesh({CellShape::hexahedron, {1, 1, 1}, 1, 0.0, {}});
  mesh.nodes(2, mesh.cells[0].cell(0)[7]) += 0.3;
  const double height = cell_heights(mesh).front();
  // The same cell with its axes x → y, y → 1 − x.
  const std::vector<Index> nodes(mesh.cells[0].nodes);
  for (const auto& [to, from] : {std::pair{0, 1}, {1, 3}, {2, 0}, {3, 2}, {4, 5}, {5, 7}, {6, 4}, {7, 6}})
    mesh.cells[0].nodes[std::size_t(to)] = nodes[std::size_t(from)];
  EXPECT_NEAR(cell_heights(mesh).front(), height, 1e-14);
}

/// A block with three different side lengths, in the frame of its sides and in others.
TEST(MeasureInvariance, OfSurfacesFromFiles) {
  const SurfaceFacets block = block_surface({-1.0, 0.0, 0.5}, {1.0, 0.3, 1.5}, 2);
  const auto measures = [](const SurfaceFacets& facets) {
    const RigidSurface surface(facets, "block");
    const Eigen::Vector3d sides = surface.block_sides();
    return std::vector<double>{surface.volume(), sides[0], sides[1], sides[2], surface.width_of_smooth()};
  };
  const std::vector<double> plain = measures(block);
  EXPECT_NEAR(plain[0], 0.6, 1e-14);
  EXPECT_NEAR(plain[1], 0.3, 1e-14);
  EXPECT_NEAR(plain[2], 1.0, 1e-14);
  EXPECT_NEAR(plain[3], 2.0, 1e-14);
  for (const auto& [what, change] : changes(3)) {
    SurfaceFacets other = block;
    for (auto& corners : other.corners) {
      for (Eigen::Vector3d& corner : corners) corner = change.length * change.map * corner;
    }
    const std::vector<double> found = measures(other);
    for (const std::size_t i : {1U, 2U, 3U}) EXPECT_NEAR(found[i], change.length * plain[i], 1e-11 * found[3]) << what;
  }
}

}  // namespace
}  // namespace ricochet::test_support
