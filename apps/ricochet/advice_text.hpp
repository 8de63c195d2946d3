#pragma once

#include "ricochet/model/model.hpp"

/// @file What `ricochet info` says of meshes and cases besides what is written in them: sizes, places, times.
namespace ricochet::program {

/// A line per group of cells or facets, the built-in ones too: how large, where, and which way facets look.
void print_groups(const Mesh& mesh, bool axisymmetric = false);
/// Of all cells: their smallest heights.
void print_cell_sizes(const Mesh& mesh);
/// Place, masses, wave speeds, times that waves take, a step to begin with, and when bodies meet obstacles.
void print_advice(const Case& input, const Model& model);
/// A line for each contact between bodies: which group carries the multipliers, how much of it faces the other one, and
/// when the bodies would meet.
void print_facings(const Case& input, const Model& model);

}  // namespace ricochet::program
