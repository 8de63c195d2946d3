#pragma once

#include "ricochet/io/summary.hpp"

/// @file Probes of nodes, in words.
namespace ricochet::program {

/// A line per probe: one of a point says how far its node is, one of a segment how many nodes it has and from where to
/// where; on a contact boundary with the largest contact force.
void print_probes(const RunSummary& summary);

}  // namespace ricochet::program
