#pragma once

#include "ricochet/model/model.hpp"

/// @file Where a mesh lies when a run starts.
namespace ricochet::program {

/// "is 0.1 away from", "touches" or "is 0.1 inside of": what lies before the obstacle's name. Gaps up to the rounding
/// are none.
[[nodiscard]] std::string gap_text(double gap, double rounding);

/// What has brought the mesh of a file to its place: ", scaled by 2, turned by 30°, moved".
[[nodiscard]] std::string placement_text(const BodyFile& mesh);

/// The box around the mesh, after it was scaled, turned and moved, and a line per obstacle: how far it is from the
/// nearest node at the start.
void print_place(const Case& input, const Model& model);

}  // namespace ricochet::program
