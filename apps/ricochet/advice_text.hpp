#pragma once

#include "ricochet/model/model.hpp"

/// @file Output of `ricochet info` that is not written in meshes and cases: sizes, positions, times.
namespace ricochet::program {

/// Prints a line per group of cells or facets, including built-in groups: size, position, and the direction of facets.
void print_groups(const Mesh& mesh, bool axisymmetric = false);
/// Prints the smallest heights of all cells.
void print_cell_sizes(const Mesh& mesh);
/// Prints position, masses, wave speeds, travel times of waves, a suggested step, and the times when bodies meet
/// obstacles.
void print_advice(const Case& input, const Model& model);
/// Prints a line for each contact between bodies: the group that carries the multipliers, how much of it faces the
/// other group, and when the bodies would meet.
void print_facings(const Case& input, const Model& model);

}  // namespace ricochet::program
