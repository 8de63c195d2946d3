#include "ricochet/rigid/surface/rigid_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "ricochet/base/error.hpp"
#include "ricochet/base/temporary_folder.hpp"
#include "ricochet/mesh/search/closest_point.hpp"
#include "ricochet/rigid/obstacle_shape.hpp"
#include "ricochet/rigid/surface/facet_weight.hpp"
#include "support/errors.hpp"
#include "support/surface_files.hpp"

/// @file Surfaces from files: distances compared with closed forms and with a search of all facets; invalid files.
namespace ricochet::test_support {
namespace {

using Vector3 = Eigen::Vector3d;

class RigidSurfaces : public testing::Test {
 protected:
  [[nodiscard]] double number() { return 2.0 * double(random_()) / 4294967296.0 - 1.0; }
  [[nodiscard]] Vector3 point(double reach) { return reach * Vector3(number(), number(), number()); }
  [[nodiscard]] std::unique_ptr<ObstacleShape> shape(const SurfaceFacets& facets, Parameters parameters = {}) {
    write_text_stl(facets, folder_.file("body.stl"));
    parameters.set("file", folder_.file("body.stl"));
    return make_obstacle_shape("surface", parameters);
  }
  TemporaryFolder folder_{std::filesystem::temp_directory_path(), "surface"};
  std::mt19937 random_{11};
};

/// Signed distance to a block, coordinate by coordinate.
double distance_to_block(const Vector3& at, const Vector3& low, const Vector3& high) {
  const Vector3 q = (at - 0.5 * (low + high)).cwiseAbs() - 0.5 * (high - low);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

TEST_F(RigidSurfaces, HaveTheDistancesOfABlockInsideAndOutside) {
  const Vector3 low(-0.3, 0.1, -0.6), high(0.5, 0.4, 0.2);
  for (const int n : {1, 3}) {
    const auto outside = shape(block_surface(low, high, n)),
               inside = shape(block_surface(low, high, n), {{"side", std::string("inside")}});
    for (int k = 0; k < 2000; ++k) {
      const Vector3 at = point(1.0);
      const double exact = distance_to_block(at, low, high);
      ASSERT_NEAR(outside->gap(SpaceVector(at)), exact, 1e-14) << at.transpose();
      ASSERT_NEAR(inside->gap(SpaceVector(at)), -exact, 1e-14);
    }
  }
}

/// Two blocks that form an L, with a re-entrant edge and corners of both kinds.
TEST_F(RigidSurfaces, KnowInsideFromOutsideAtEdgesThatGoIn) {
  // Outline of the L as one polygon in the plane, extruded along the third axis by hand.
  const std::vector<Eigen::Vector2d> outline{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  SurfaceFacets facets;
  const auto at = [&](std::size_t i, double z) { return Vector3(outline[i][0], outline[i][1], z); };
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t k = (i + 1) % 6;
    facets.corners.push_back({at(i, 0), at(k, 0), at(k, 1)});
    facets.corners.push_back({at(i, 0), at(k, 1), at(i, 1)});
  }
  for (const auto& [a, b, c] : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    facets.corners.push_back({at(a, 1), at(b, 1), at(c, 1)});
    facets.corners.push_back({at(a, 0), at(c, 0), at(b, 0)});
  }
  const RigidSurface surface(facets, "L");
  EXPECT_TRUE(surface.is_closed());
  EXPECT_NEAR(surface.volume(), 3.0, 1e-14);
  const auto shown = shape(facets);
  for (int k = 0; k < 5000; ++k) {
    const Vector3 p = Vector3(1.0, 1.0, 0.5) + point(1.5);
    const bool inside = p[2] > 0 && p[2] < 1 && p[0] > 0 && p[1] > 0 && p[0] < 2 && p[1] < 2 && (p[0] < 1 || p[1] < 1);
    const double gap = shown->gap(SpaceVector(p));
    ASSERT_EQ(gap < 0.0, inside) << p.transpose() << ": " << gap;
    const double blocks =
        std::min(distance_to_block(p, {0, 0, 0}, {2, 1, 1}), distance_to_block(p, {0, 0, 0}, {1, 2, 1}));
    if (!inside) {
      ASSERT_NEAR(gap, blocks, 1e-14);
    }
  }
}

TEST_F(RigidSurfaces, FindTheNearestOfAllFacets) {
  const SurfaceFacets facets = sphere_surface({0.1, 0.2, 0.3}, 0.7, 3);
  const RigidSurface surface(facets, "sphere");
  EXPECT_EQ(surface.facets().size(), 1280U);
  EXPECT_EQ(surface.corners().size(), 642U);
  for (int k = 0; k < 300; ++k) {
    const Vector3 at = point(1.5);
    double least = 1e300;
    for (const auto& [a, b, c] : facets.corners)
      least = std::min(least, (closest_on_triangle(at, a, b, c).position - at).norm());
    EXPECT_EQ((surface.nearest(at).position - at).norm(), least);
  }
}

/// The distance converges to that of the sphere with the square of the triangle size, and so do the mean normals.
TEST_F(RigidSurfaces, TendToASphere) {
  double gap_before = 0.0, normal_before = 0.0;
  for (const int level : {2, 3, 4}) {
    const double size = 1.2 / std::pow(2.0, level);
    const auto sphere = shape(sphere_surface({0, 0, 0}, 1.0, level), {{"edge_radius", size}});
    double gap = 0.0, normal = 0.0;
    random_.seed(7);
    for (int k = 0; k < 400; ++k) {
      const Vector3 out = point(1.0).normalized(), at = 1.01 * out;
      gap = std::max(gap, std::abs(sphere->gap(SpaceVector(at)) - 0.01));
      normal = std::max(normal, (Vector3(sphere->normal(SpaceVector(Vector3(1.0 * out)))) - out).norm());
    }
    if (level > 2) {
      EXPECT_GT(gap_before / gap, 3.4);
      EXPECT_GT(normal_before / normal, 1.7);
    }
    gap_before = gap;
    normal_before = normal;
  }
  EXPECT_LT(gap_before, 1.2e-3);
  EXPECT_LT(normal_before, 2e-2);
}

/// Compares weights with integrals over the facet, computed by a fine sum.
TEST_F(RigidSurfaces, WeighFacetsExactly) {
  for (int k = 0; k < 20; ++k) {
    const std::array<Vector3, 3> corners{point(1.0), point(1.0), point(1.0)};
    const Vector3 at = point(0.7), normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    constexpr double radius = 0.8;
    constexpr int n = 600;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        for (const double third : {1.0 / 3.0, 2.0 / 3.0}) {
          if (third > 0.5 && i + j + 1 >= n) continue;
          const Vector3 y =
              corners[0] + (i + third) / n * (corners[1] - corners[0]) + (j + third) / n * (corners[2] - corners[0]);
          sum += std::max(radius * radius - (y - at).squaredNorm(), 0.0);
        }
      }
    }
    sum *= 0.5 * normal.norm() / (n * n);
    const FacetWeight weight = weight_of_triangle(corners, normal.normalized(), at, radius);
    EXPECT_NEAR(weight.value, sum, 2e-5);
    double line = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const Vector3 y = corners[0] + (i + 0.5) / 4000 * (corners[1] - corners[0]);
      line += std::max(radius * radius - (y - at).squaredNorm(), 0.0) * (corners[1] - corners[0]).norm() / 4000;
    }
    const FacetWeight on_line = weight_of_segment(corners[0], corners[1], at, radius);
    EXPECT_NEAR(on_line.value, line, 1e-5);
    for (Eigen::Index i = 0; i < 3; ++i) {
      constexpr double h = 1e-5;
      const Vector3 ahead = at + h * Vector3::Unit(i), behind = at - h * Vector3::Unit(i);
      const auto triangle = [&](const Vector3& x) {
        return weight_of_triangle(corners, normal.normalized(), x, radius).value;
      };
      const auto segment = [&](const Vector3& x) { return weight_of_segment(corners[0], corners[1], x, radius).value; };
      EXPECT_NEAR(weight.gradient[i], (triangle(ahead) - triangle(behind)) / (2.0 * h), 1e-7);
      EXPECT_NEAR(on_line.gradient[i], (segment(ahead) - segment(behind)) / (2.0 * h), 1e-6);
    }
  }
}

/// For any triangles: the mean height above a plane, whose derivative rotates around edges without a jump.
TEST_F(RigidSurfaces, HaveMeanHeightsWhoseDerivativesTurnAroundEdges) {
  const Vector3 low(-1, -1, -1), high(1, 1, 1);
  const RigidSurface coarse(block_surface(low, high), "coarse"), fine(block_surface(low, high, 7), "fine");
  constexpr double radius = 0.3;
  for (const RigidSurface* surface : {&coarse, &fine}) {
    const RigidSurface::Height above = surface->mean_height({0.2, 0.1, 1.05}, radius);
    EXPECT_NEAR(above.value, 0.05, 1e-15);
    EXPECT_LT((above.gradient - Vector3(0, 0, 1)).norm(), 1e-14);
    EXPECT_LT(
        (surface->mean_height({1.0, 0.1, 1.0}, radius).gradient.normalized() - Vector3(1, 0, 1).normalized()).norm(),
        1e-14);
    EXPECT_LT(
        (surface->mean_height({1.0, 1.0, 1.0}, radius).gradient.normalized() - Vector3(1, 1, 1).normalized()).norm(),
        1e-14);
  }
  Vector3 before = coarse.mean_height({0.6, 0.35, 1.0}, radius).gradient;
  double off = 0.0;
  for (int k = 1; k <= 400; ++k) {
    const Vector3 at(0.6 + 0.001 * k, 0.35, 1.0);
    const RigidSurface::Height on_coarse = coarse.mean_height(at, radius), on_fine = fine.mean_height(at, radius);
    ASSERT_LT((on_coarse.gradient - on_fine.gradient).norm(), 1e-12);
    ASSERT_NEAR(on_coarse.value, on_fine.value, 1e-14);
    ASSERT_LT((on_coarse.gradient - before).norm(), 0.02);
    before = on_coarse.gradient;
    off = std::max(off, std::abs(on_coarse.value));
  }
  EXPECT_LT(off, 0.13 * radius);
  EXPECT_GT(off, 0.1 * radius);
}

/// A plate without thickness: a point that is inside, less deep than the radius, passes the border.
TEST_F(RigidSurfaces, HaveContinuousGapsAcrossABorder) {
  const Vector3 a(0, 0, 0), b(1, 0, 0), c(1, 1, 0), d(0, 1, 0);
  constexpr double radius = 0.1;
  const auto plate = shape({{{a, b, c}, {a, c, d}}, true}, {{"edge_radius", radius}});
  for (const double height : {-0.05, 0.0, 0.03, 0.2}) {
    double before = plate->gap(SpaceVector(Vector3(0.4, 0.8, height)));
    EXPECT_NEAR(before, height, 1e-15);
    for (double y = 0.8; y < 1.4; y += 1e-4) {
      const SpaceVector at = Vector3(0.4, y, height);
      const double gap = plate->gap(at);
      ASSERT_LT(std::abs(gap - before), 1.01e-4) << y;
      before = gap;
      constexpr double step = 1e-6;
      if (std::abs(y - 1.0) < 2e-4) continue;
      const SpaceVector ahead = Vector3(0.4, y + step, height), behind = Vector3(0.4, y - step, height);
      ASSERT_NEAR(plate->gradient(at)[1], (plate->gap(ahead) - plate->gap(behind)) / (2.0 * step), 1e-6);
    }
    EXPECT_GT(before, 0.3);
  }
  double before = plate->gap(SpaceVector(Vector3(0.4, 1.07, 0.2)));
  for (double height = 0.2; height > -0.4; height -= 1e-4) {
    const double gap = plate->gap(SpaceVector(Vector3(0.4, 1.07, height)));
    ASSERT_LT(std::abs(gap - before), 1.01e-4) << height;
    before = gap;
  }
  EXPECT_NEAR(before, 0.07 - radius, 1e-12);
}

/// The derivative of the gap in all regions: near edges and corners, and beyond the radius.
TEST_F(RigidSurfaces, HaveNormalsAlongTheDerivativeOfTheGap) {
  const auto block = shape(block_surface({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}, 2), {{"edge_radius", 0.15}});
  const auto polygon = [&] {
    std::ofstream(folder_.file("l.txt")) << "0 0\n2 0\n2 1\n1 1\n1 2\n0 2\n0 0\n";
    return make_obstacle_shape("surface", {{"file", folder_.file("l.txt")}, {"edge_radius", 0.3}});
  }();
  int looked_at = 0;
  for (int k = 0; k < 4000; ++k) {
    const bool in_plane = k % 4 == 0;
    const ObstacleShape& surface = in_plane ? *polygon : *block;
    const SpaceVector at =
        in_plane ? SpaceVector(Eigen::Vector2d(1.0 + 1.2 * number(), 1.0 + 1.2 * number())) : SpaceVector(point(0.7));
    const double gap = surface.gap(at);
    if (gap < -0.05 || gap > 0.25) continue;
    SpaceVector slope(at.size());
    constexpr double h = 1e-6;
    for (Index i = 0; i < at.size(); ++i) {
      SpaceVector ahead = at, behind = at;
      ahead[i] += h;
      behind[i] -= h;
      slope[i] = (surface.gap(ahead) - surface.gap(behind)) / (2.0 * h);
    }
    EXPECT_LT((slope.normalized() - surface.normal(at)).norm(), 1e-4) << at.transpose() << ": " << gap;
    EXPECT_LT((slope - surface.gradient(at)).norm(), 1e-4) << at.transpose() << ": " << gap;
    ++looked_at;
  }
  EXPECT_GT(looked_at, 1000);
}

/// Steps of any length at rounded edges, where the gap changes by less than the length of the step. The direction of a
/// displacement that is mere rounding has no meaning: with it, the forces at a node that sticks there would change from
/// one iteration to the next.
TEST_F(RigidSurfaces, HaveNormalsOfStepsThatDoNotFollowRounding) {
  const auto block = shape(block_surface({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}, 2), {{"edge_radius", 0.15}});
  int rounded = 0;
  for (int k = 0; k < 3000; ++k) {
    const SpaceVector from = point(0.6);
    if (std::abs(block->gap(from)) > 0.02) continue;
    if (block->gradient(from).norm() < 0.99) ++rounded;
    for (int digits = 4; digits <= 15; ++digits) {
      const double length = std::pow(10.0, -digits);
      const SpaceVector way = length * point(1.0);
      const SpaceVector normal = block->normal_of_step(from, from + way);
      // The normal rotates by the displacement over the radius; 2e-8 is the rounding relative to displacements of 1e-7.
      EXPECT_LT((normal - block->normal(from)).norm(), 100.0 * length + 2e-8) << from.transpose() << ", " << length;
    }
    const SpaceVector to = from + SpaceVector(point(0.02));
    const double change = block->gap(to) - block->gap(from);
    EXPECT_GE(block->normal_of_step(from, to).dot(to - from) * change, -1e-16);
  }
  EXPECT_GT(rounded, 50);
}

TEST_F(RigidSurfaces, AreTheSameFromTextAndFromBytes) {
  SurfaceFacets facets = sphere_surface({0, 0, 0}, 0.5, 2);
  for (auto& triangle : facets.corners) {
    for (Vector3& corner : triangle) corner = corner.cast<float>().cast<double>();
  }
  write_text_stl(facets, folder_.file("a.stl"));
  write_binary_stl(facets, folder_.file("b.stl"));
  const SurfaceFacets text = read_stl(folder_.file("a.stl"), 2.0), bytes = read_stl(folder_.file("b.stl"), 2.0);
  ASSERT_EQ(text.corners.size(), facets.corners.size());
  ASSERT_EQ(bytes.corners.size(), facets.corners.size());
  for (std::size_t i = 0; i < facets.corners.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(text.corners[i][k], 2.0 * facets.corners[i][k]);
      EXPECT_EQ(bytes.corners[i][k], 2.0 * facets.corners[i][k]);
    }
  }
}

/// A square whose sides are the lines of a file, and an open line.
TEST_F(RigidSurfaces, AreInThePlaneToo) {
  const auto polygon = [&](const std::string& text, Parameters parameters = {}) {
    std::ofstream(folder_.file("body.txt")) << text;
    parameters.set("file", folder_.file("body.txt"));
    return make_obstacle_shape("surface", parameters);
  };
  // Both orientations.
  for (const std::string text : {"0 0\n1, 0\n1 1\n0 1 # last\n0 0\n", "0 0\n0 1\n1 1\n1 0\n0 0\n"}) {
    const auto square = polygon(text);
    EXPECT_NEAR(square->gap(Eigen::Vector2d(0.5, 0.7)), -0.3, 1e-15);
    EXPECT_NEAR(square->gap(Eigen::Vector2d(2.0, 2.0)), std::sqrt(2.0), 1e-15);
    EXPECT_NEAR(square->gap(Eigen::Vector2d(0.5, -0.25)), 0.25, 1e-15);
    EXPECT_LT((square->normal(Eigen::Vector2d(0.5, -0.25)) - Eigen::Vector2d(0, -1)).norm(), 1e-15);
  }
  // The obstacle lies above, on the right of a line that runs to the left; at its ends it has walls.
  const auto line = polygon("1 0\n-1 0\n");
  EXPECT_NEAR(line->gap(Eigen::Vector2d(0.3, -0.2)), 0.2, 1e-15);
  EXPECT_NEAR(line->gap(Eigen::Vector2d(0.3, 0.2)), -0.2, 1e-15);
  EXPECT_NEAR(line->gap(Eigen::Vector2d(4.0, 4.0)), 3.0, 1e-15);
  EXPECT_NEAR(line->gap(Eigen::Vector2d(4.0, -4.0)), 5.0, 1e-15);
  EXPECT_THROW((void)polygon("1 0\n-1 0\n", {{"side", std::string("inside")}}), Error);
  EXPECT_THROW((void)polygon("1 0\n-1 0 3\n"), Error);
  EXPECT_THROW((void)polygon("1 0\n-1 b\n"), Error);
  EXPECT_THROW((void)polygon("# nothing\n"), Error);
}

TEST_F(RigidSurfaces, RefuseWhatHasNoInside) {
  const auto problem = [&](const SurfaceFacets& facets, Parameters parameters = {}) {
    return message_of([&] { (void)shape(facets, std::move(parameters)); });
  };
  const SurfaceFacets block = block_surface({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(problem(block), "");
  SurfaceFacets open = block;
  open.corners.erase(open.corners.begin() + 4);
  EXPECT_EQ(problem(open), "");
  EXPECT_TRUE(has(problem(open, {{"side", std::string("inside")}}),
                  "it is not closed: 3 of its edges belong to only one triangle"));
  SurfaceFacets turned = block;
  std::swap(turned.corners[4][0], turned.corners[4][1]);
  EXPECT_TRUE(has(problem(turned), "are neighbours with opposite orientations"));
  EXPECT_TRUE(has(problem(turned), "triangle 5 at ("));
  SurfaceFacets twice = block;
  twice.corners.push_back(block.corners[2]);
  EXPECT_TRUE(has(problem(twice), "triangle 3 at ("));
  EXPECT_TRUE(has(problem(twice), "are identical"));
  SurfaceFacets joined = block;
  for (const auto& triangle : block_surface({1, 1, 0}, {2, 2, 1}).corners) joined.corners.push_back(triangle);
  EXPECT_TRUE(has(problem(joined), "4 triangles meet at the edge at (1, 1, 0.5)"));
  // A surface that is inverted as a whole is reoriented.
  SurfaceFacets inside_out = block;
  for (auto& triangle : inside_out.corners) std::swap(triangle[0], triangle[1]);
  EXPECT_TRUE(RigidSurface(inside_out, "block").was_reversed());
  EXPECT_NEAR(shape(inside_out)->gap(Vector3(0.5, 0.5, 1.25)), 0.25, 1e-15);
  EXPECT_NEAR(shape(inside_out)->gap(Vector3(1.5, 0.5, 1.5)), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(shape(inside_out)->gap(Vector3(0.9, 0.8, 0.9)), -0.1, 1e-15);
  // A triangle without area, with two coinciding corners.
  SurfaceFacets flat = block;
  flat.corners.push_back({block.corners[0][0], block.corners[0][0], block.corners[0][1]});
  EXPECT_EQ(RigidSurface(flat, "block").flat_count(), 1);
  EXPECT_NEAR(shape(flat)->gap(Vector3(0.5, 0.5, 1.25)), 0.25, 1e-15);
}

TEST_F(RigidSurfaces, SayWhereAFileIsWrong) {
  const std::string file = folder_.file("bad.stl");
  const auto problem = [&](const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return message_of([&] { (void)read_stl(file, 1.0); });
  };
  EXPECT_TRUE(has(problem("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 o 0\n"),
                  "bad.stl:5:10: \"o\" is not a finite number"));
  EXPECT_TRUE(has(problem("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"),
                  "expected \"vertex\" but found \"the end of the file\""));
  for (const std::string normal : {"0 0 1m", "x 0 1", "0 0 -"}) {
    EXPECT_TRUE(has(problem("solid a\nfacet normal " + normal + "\nouter loop\nvertex 0 0 0\n"),
                    "is not a component of a normal"))
        << normal;
  }
  // Some programs write such normals for triangles without area.
  const std::string triangle = "\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
  for (const std::string normal : {"nan nan nan", "-nan(ind) 0 NaN", "-1 +.5e3 0"})
    EXPECT_EQ(problem("solid a\nfacet normal " + normal + triangle), "") << normal;
  EXPECT_TRUE(has(problem("solid a\nendsolid\n"), "no triangles"));
  EXPECT_TRUE(has(problem(std::string(80, ' ') + std::string("\5\0\0\0", 4) + std::string(100, '\1')),
                  "the file ends before the 5 triangles"));
  EXPECT_TRUE(has(problem(""), "it is truncated, or not an STL file"));
  EXPECT_THROW((void)read_stl(folder_.file("absent.stl"), 1.0), Error);
  const auto problem_of_polygons = [&](const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return message_of([&] { (void)read_polygons(file, 1.0); });
  };
  EXPECT_EQ(problem_of_polygons("0 0\n1, 0 # a corner\n\n2;0\n3;1\n"), "");
  EXPECT_TRUE(has(problem_of_polygons("0 0\n1 0.0m\n"), "bad.stl:2:3: \"0.0m\" is not a finite number"));
  EXPECT_TRUE(has(problem_of_polygons("x y\n0 0\n1 0\n"), "bad.stl:1:1: \"x\""));
  EXPECT_TRUE(has(problem_of_polygons("0 0\n1 0 2\n"), "bad.stl:2: a line of a polygon must have two numbers"));
}

}  // namespace
}  // namespace ricochet::test_support
