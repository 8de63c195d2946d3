#include <gtest/gtest.h>

#include <filesystem>

#include "ricochet/base/log.hpp"
#include "ricochet/run/session.hpp"
#include "support/case_run.hpp"
#include "support/paths.hpp"
#include "support/thrown_body.hpp"

/// @file Warnings of what a model makes of a case.
namespace ricochet {
namespace {

using test_support::ThrownBody;

/// A block of tetrahedra of degree 2: flat six-node triangles, whose vertices have no share of the area.
ThrownBody flat_block() {
  return {"block", 3, 2,
          test_support::mesh_geometry("block2",
                                      "Box(1)={0,0,0.03,1,1,0.5}; Physical Volume(\"body\")={1};"
                                      "Physical Surface(\"contact\")={5};",
                                      1.0, 1)};
}

bool warns(const std::string& contact, const std::string& sentence) {
  const std::string path = test_support::write_temporary(
      "warning.toml", test_support::thrown_case(flat_block(), "consistent",
                                                "scheme = \"newmark\"\npreset = \"trapezoidal\"\n", contact));
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

}  // namespace
}  // namespace ricochet
