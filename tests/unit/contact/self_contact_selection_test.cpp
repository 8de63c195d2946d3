#include "ricochet/contact/sliding/self_contact_selection.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <array>

#include "support/case_run.hpp"
#include "support/two_bodies.hpp"

/// @file Choice of the points that carry the conditions of self-contact: here the faces of two boxes as one surface.
namespace ricochet::test_support {
namespace {

struct Faces {
  CellShape shape;
  int degree;
};

CaseRun boxes_of(const Faces& of) {
  const bool plane = dimension(of.shape) == 2;
  const Mesh mesh = make_stack({.lower_shape = of.shape,
                                .upper_shape = of.shape,
                                .lower_counts = plane ? std::vector{7, 2} : std::vector{4, 4, 2},
                                .upper_counts = plane ? std::vector{5, 2} : std::vector{3, 3, 2}});
  const std::string last = plane ? "y" : "z";
  const std::string file = write_mesh("self-contact.msh", mesh);
  return CaseRun(
      "[mesh]\nfile = \"" + file + "\"\ndegree = " + std::to_string(of.degree) +
      "\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\n[[contact]]\ngroup = \"upper." +
      last + "0\"\nagainst = \"lower." + last + "1\"\nsliding = \"large\"\n[time]\nstep = 0.01\nend = 0.01\n");
}

/// Both faces, with a point for each of their multipliers.
SlidingPair::Data both_faces(const CaseRun& run) {
  const Body& body = run.model().body;
  const ContactPair& pair = run.model().contact_pairs.front();
  std::vector<Index> facets = pair.facets;
  facets.insert(facets.end(), pair.opposite_facets.begin(), pair.opposite_facets.end());
  std::ranges::sort(facets);
  SlidingPair::Data data{body, "p1", facets, facets, {}};
  const ContactPatch patch{&body, {{0, facets}}};
  const auto space = make_multiplier_space("p1", patch);
  for (const Multiplier& multiplier : space->multipliers()) {
    data.points.push_back({.multiplier = multiplier,
                           .normal = RotatingNormal(Vector::Unit(body.mesh->dimension, body.mesh->dimension - 1))});
  }
  return data;
}

/// Ratio of the smallest to the largest singular value of the rows of these points; 1 if there are none.
double independence(const std::vector<SlidingView>& views, const std::vector<std::size_t>& points, Index nodes) {
  Matrix rows = Matrix::Zero(Index(points.size()), 3 * nodes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const auto& [node, value] : views[points[i]].row) rows.row(Index(i)).segment(3 * node, 3) = value;
  }
  const Vector values = Eigen::JacobiSVD<Matrix>(rows).singularValues();
  return values.minCoeff() / values.maxCoeff();
}

TEST(SelfContactSelection, HaveIndependentRowsAndLeaveOutThoseOfTheOtherSide) {
  for (const Faces& faces : {Faces{CellShape::triangle, 1}, Faces{CellShape::triangle, 2},
                             Faces{CellShape::tetrahedron, 1}, Faces{CellShape::hexahedron, 1}}) {
    const CaseRun run = boxes_of(faces);
    const SlidingPair pair(both_faces(run));
    ASSERT_TRUE(pair.is_self());
    const Index nodes = run.problem().nodes.cols(), d = run.problem().dimension;
    const std::vector<Index> upper = facet_nodes(run.model().space, run.model().contact_pairs.front().facets);
    const auto is_upper = [&](Index node) { return std::ranges::binary_search(upper, node); };
    SelfContactSelection chosen(pair, nodes, faces.degree);
    for (const double slide : {0.0, 0.05, 0.45, 0.9, 0.1}) {
      Vector displacement = Vector::Zero(run.problem().dof_count());
      for (const Index node : upper) {
        displacement[node * d] = slide;
        displacement[node * d + d - 1] = 0.01;
      }
      std::vector<SlidingView> views;
      pair.compute_views(displacement, SlidingPair::Content::row, {}, {}, views);
      std::vector<const SlidingView*> seen;
      std::vector<std::size_t> all, some;
      std::array<std::vector<std::size_t>, 2> faces_alone;  // as a pair of surfaces would choose them
      for (std::size_t i = 0; i < views.size(); ++i) {
        seen.push_back(views[i].faces ? &views[i] : nullptr);
        if (!views[i].faces) continue;
        all.push_back(i);
        faces_alone[is_upper(pair.points()[i].multiplier.node) ? 1 : 0].push_back(i);
      }
      chosen.choose(seen);
      for (const std::size_t i : all) {
        ASSERT_NE(chosen.choices()[i], SelfContactSelection::Choice::none);
        if (chosen.choices()[i] == SelfContactSelection::Choice::chosen) some.push_back(i);
      }
      ASSERT_FALSE(some.empty());
      EXPECT_LT(some.size(), all.size());
      EXPECT_GE(3 * some.size(), all.size());
      // Where a face overhangs, a pair's points see parts of their facets and nearly coincide with their neighbours.
      const double of_pair =
          std::min(independence(views, faces_alone[0], nodes), independence(views, faces_alone[1], nodes));
      EXPECT_GT(independence(views, some, nodes), std::min(0.05, 0.5 * of_pair)) << slide;
      EXPECT_LT(independence(views, all, nodes), 0.3 * independence(views, some, nodes)) << slide;
      // A second evaluation gives the same choice.
      const auto first = chosen.choices();
      chosen.choose(seen);
      EXPECT_TRUE(chosen.choices() == first);
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
