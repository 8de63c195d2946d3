#pragma once

#include <string>

/// @file A uniformly sheared layer, represented by one column of it.
namespace ricochet::test_support {

/// Writes a column [0, width] × [0, 1] of one row of `cells` rectangles as a .msh file; returns its path. Groups:
/// "body", "base" (y = 0), "top" and "sides": the long sides except for the lowest cell, so that a support of the sides
/// leaves the nodes of the base free.
std::string column_mesh(double width, int cells);

/// Returns the part of a case that makes the column a shear column over a rough base at y = 0: density and shear
/// modulus 1, Poisson's ratio 0, sides that cannot move along y (they carry the complementary shear stress), pressed on
/// the base by `pressure`, which is applied at the base itself. `contact` is an additional line of [[contact]].
std::string column_case(const std::string& mesh, double pressure, const std::string& contact, int degree = 1);

}  // namespace ricochet::test_support
