#pragma once

#include "ricochet/model/model.hpp"

/// @file Position of a mesh at the start of a run.
namespace ricochet::program {

/// Returns "is 0.1 away from", "touches" or "is 0.1 inside", to precede the obstacle's name. Gaps up to the rounding
/// count as zero.
[[nodiscard]] std::string gap_text(double gap, double rounding);

/// Returns how the mesh of a file was placed: ", scaled by 2, rotated by 30°, moved".
[[nodiscard]] std::string placement_text(const BodyFile& mesh);

/// Prints the bounding box of the mesh after scaling, turning and moving, and a line per obstacle with its distance
/// from the nearest node at the start.
void print_position(const Case& input, const Model& model);

}  // namespace ricochet::program
