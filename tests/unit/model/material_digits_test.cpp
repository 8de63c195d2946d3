#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ricochet/base/log.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"

/// @file Material data that cancel the digits of other data are refused, with their position in the file.
namespace ricochet::test_support::material_digits_test {

/// A case whose line 3 is the first of the material.
std::string block(const std::string& material, const std::string& support = "") {
  const std::string mesh = mesh_geometry(
      "material-digits",
      "Rectangle(1) = {0, 0, 0, 1, 1};\nPhysical Surface(\"body\") = {1};\nPhysical Curve(\"bottom\") = {1};\n", 0.5,
      1);
  return fmt::format(
      "[mesh]\nfile = \"{}\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\n{}\n{}"
      "[initial]\nvelocity = [0.0, -1.0]\n[time]\nstep = 0.01\nend = 0.02\n",
      mesh, material, support);
}

std::string refusal(const std::string& material) {
  const log::Silence silence;
  return message_of([&] { const CaseRun run(block(material)); });
}

TEST(MaterialDigits, WhatLeavesNoneIsRefused) {
  struct Absurd {
    std::string material, place, reason;
  };
  const std::string rubber = "law = \"neo-hookean\"\nyoung = 100.0\npoisson = 0.3\n";
  const std::vector<Absurd> all{
      {rubber + "relaxation = {modulus = [1.0, 1e30], time = [1.0, 2.0]}", ":9:", "\"modulus\" sum to 1e+30"},
      {"law = \"mooney-rivlin\"\nc10 = 10.0\nc01 = 0.0\nbulk_modulus = 1e30", ":9:16: ", "bulk modulus 1e+30"},
      {"law = \"mooney-rivlin\"\nc10 = 1.0\nc01 = -0.9999999999999999\nbulk_modulus = 100.0",
       ":9:16: ", "shear modulus 2.22e-16"},
      {"young = 100.0\npoisson = 0.4999999999999999", ":7:11: ", "hardly a digit of the other"},
      {"young = 1e30\npoisson = 0.3", ":6:9: ", "no digit remains of the inertia"},
      {"lambda = 1.0\nmu = 1e30", ":7:6: ", "no digit remains of the inertia"},
  };
  for (const Absurd& absurd : all) {
    const std::string message = refusal(absurd.material);
    EXPECT_TRUE(has(message, absurd.place));
    EXPECT_TRUE(has(message, absurd.reason));
    EXPECT_FALSE(has(message, "Cholesky"));
  }
}

TEST(MaterialDigits, WhatLeavesSomeRuns) {
  EXPECT_EQ(
      refusal("law = \"neo-hookean\"\nyoung = 100.0\npoisson = 0.3\nrelaxation = {modulus = [1e6], time = [1.0]}"), "");
  EXPECT_EQ(refusal("young = 100.0\npoisson = 0.499999"), "");
  EXPECT_EQ(refusal("young = 1e10\npoisson = 0.3"), "");
  // Supports can hold a body of any stiffness.
  const CaseRun held(
      block("young = 1e30\npoisson = 0.3", "[[support]]\ngroup = \"bottom\"\ncomponents = [\"x\", \"y\"]\n"));
  EXPECT_EQ(held.state().step, 0);
}

}  // namespace ricochet::test_support::material_digits_test
