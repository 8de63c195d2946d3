#include <gtest/gtest.h>

#include "ricochet/base/log.hpp"
#include "ricochet/run/session.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Warnings about the model that is made of a case.
namespace ricochet::test_support {
namespace {

/// A block of tetrahedra of degree 2: flat six-node triangles, whose vertices have zero area.
ThrownBody flat_block() {
  return {"block", 3, 2,
          mesh_geometry("block2",
                        "Box(1)={0,0,0.13,1,1,0.5}; Physical Volume(\"body\")={1};"
                        "Physical Surface(\"contact\")={5};",
                        1.0, 1)};
}

bool warns(const std::string& contact, const std::string& sentence, const ThrownBody& body = flat_block(),
           const std::string& mass = "consistent") {
  const std::string path = write_temporary(
      "warning.toml", thrown_case(body, mass, "scheme = \"newmark\"\npreset = \"trapezoidal\"\n", contact));
  Session session(path);
  session.build();
  for (const std::string& warning : session.warnings()) {
    if (warning.find(sentence) != std::string::npos) return true;
  }
  return false;
}

TEST(ModelWarnings, OfBoundsWhereThereIsNoArea) {
  log::set_level(log::Level::error);
  const std::string sentence = "whose share of the area is zero";
  EXPECT_TRUE(warns("multipliers = \"nodal\"\nfriction_bound = 2.0\n", sentence));
  EXPECT_FALSE(warns("multipliers = \"dual\"\nfriction_bound = 2.0\n", sentence));
  EXPECT_FALSE(warns("multipliers = \"nodal\"\nfriction = 0.3\n", sentence));
}

/// Either a bar one cell thick on a cube is all contact boundary, or only the far face of the cube is.
TEST(ModelWarnings, OfInertiaThatIsHeapedUp) {
  log::set_level(log::Level::error);
  const auto bar = [](const std::string& name, const std::string& contact) {
    return ThrownBody{
        name, 3, 1,
        mesh_geometry(name,
                      "Box(1)={0,0,0.23,3,0.1,0.1}; Box(2)={-0.3,-0.1,0.13,0.3,0.3,0.3};"
                      "BooleanUnion(3)={Volume{1};Delete;}{Volume{2};Delete;}; Physical Volume(\"body\")={3};"
                      "Physical Surface(\"contact\")=Surface In BoundingBox" +
                          contact + ";",
                      0.1, 1)};
  };
  const std::string sentence = "times the original inertia";
  for (const char* mass : {"equivalent", "equivalent-cellwise", "equivalent-compact"}) {
    EXPECT_TRUE(warns("", sentence, bar("bar", "{-0.01,-1,-1,7,1,1}"), mass)) << mass;
    EXPECT_FALSE(warns("", sentence, bar("cube", "{-0.31,-1,-1,-0.29,1,1}"), mass)) << mass;
  }
  EXPECT_FALSE(warns("", sentence, bar("bar", "{-0.01,-1,-1,7,1,1}"), "consistent"));
}

}  // namespace
}  // namespace ricochet::test_support
