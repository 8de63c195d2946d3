#pragma once

#include <string>

/// @file One-dimensional bodies run as two-dimensional strips.
namespace ricochet::test_support {

/// Writes a strip [x0, x0 + length] of `cells` squares in a row as a .msh file; returns its path. Groups: "body",
/// "left", "right", "sides" (both long sides). With `triangles`, each square is divided in two.
std::string strip_mesh(double x0, double length, int cells, bool triangles = false);

/// Returns the part of a case that makes a strip one-dimensional: Poisson's ratio 0 and no lateral displacement.
std::string strip_case(const std::string& mesh, double young, double density, int degree = 1);

}  // namespace ricochet::test_support
