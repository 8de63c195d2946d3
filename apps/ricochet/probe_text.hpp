#pragma once

#include "ricochet/io/summary.hpp"

/// @file Probes of nodes, in words.
namespace ricochet::program {

/// Prints a line per probe: the distance of its node for a point, the number of nodes and their range for a segment; on
/// a contact boundary also the largest contact force.
void print_probes(const RunSummary& summary);

}  // namespace ricochet::program
