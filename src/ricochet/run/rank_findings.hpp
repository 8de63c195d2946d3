#pragma once

#include "ricochet/io/summary.hpp"

/// @file What ranks find, each in its part of a body.
namespace ricochet {

/// Adds what another rank has found to a summary: penetration, of each kind the deepest, and the largest stress.
void merge_findings(const RunSummary& other, RunSummary& summary);

}  // namespace ricochet
