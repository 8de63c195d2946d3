#include <gtest/gtest.h>

#include "ricochet/fem/connected_bodies.hpp"

namespace ricochet {
namespace {

/// Names of bodies of two cells each.
std::vector<std::string> names(int bodies, std::vector<Group> groups, std::vector<MeshPart> parts = {}) {
  Mesh mesh;
  mesh.groups = std::move(groups);
  mesh.parts = std::move(parts);
  ConnectedBodies connected;
  connected.count = bodies;
  for (int body = 0; body < bodies; ++body) connected.of_cell.insert(connected.of_cell.end(), 2, body);
  return names_of_bodies(mesh, connected);
}

TEST(NamesOfBodies, AreGroupsThatNoOtherBodyHasAPartIn) {
  using Names = std::vector<std::string>;
  const Group all{"all", 1, 2, {0, 1, 2, 3}}, left{"left", 2, 2, {0, 1}}, core{"core", 3, 2, {2}},
      shell{"shell", 4, 2, {3}}, edge{"edge", 5, 1, {0}}, mixed{"mixed", 6, 2, {1, 2}};
  EXPECT_EQ(names(1, {left}), Names{"the body"});
  EXPECT_EQ(names(2, {all}), (Names{"body 0", "body 1"}));
  EXPECT_EQ(names(2, {all, left, edge}), (Names{"body \"left\"", "body 1"}));
  EXPECT_EQ(names(2, {left, core, shell}), (Names{"body \"left\"", "body \"core\" and \"shell\""}));
  // One name for the whole body is enough.
  EXPECT_EQ(names(2, {core, {"right", 7, 2, {2, 3}}, mixed}), (Names{"body 0", "body \"right\""}));
}

TEST(NamesOfBodies, AreThePartsThatHaveOneBody) {
  using Names = std::vector<std::string>;
  const Group all{"ball.all", 1, 2, {0, 1}}, core{"ring.core", 2, 2, {2}}, both{"all", 3, 2, {0, 1, 2, 3}};
  const MeshPart ball{"ball", 0, 0, {0, 1}}, ring{"ring", 0, 0, {2, 3}}, pair{"pair", 0, 0, {2, 3, 4, 5}};
  EXPECT_EQ(names(2, {all, core, both}, {ball, ring}), (Names{"body \"ball\"", "body \"ring\""}));
  // Two bodies in one file are named after its groups.
  EXPECT_EQ(names(3, {all, {"pair.one", 4, 2, {2, 3}}}, {ball, pair}),
            (Names{"body \"ball\"", "body \"pair.one\"", "body 2"}));
}

}  // namespace
}  // namespace ricochet
