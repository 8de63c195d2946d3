#include <gtest/gtest.h>

#include "ricochet/fem/connected_bodies.hpp"

namespace ricochet {
namespace {

/// Two cells of each body.
std::vector<std::string> names(int bodies, std::vector<Group> groups) {
  Mesh mesh;
  mesh.groups = std::move(groups);
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
  // One name of the whole is enough.
  EXPECT_EQ(names(2, {core, {"right", 7, 2, {2, 3}}, mixed}), (Names{"body 0", "body \"right\""}));
}

}  // namespace
}  // namespace ricochet
