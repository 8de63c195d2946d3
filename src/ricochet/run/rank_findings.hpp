#pragma once

#include "ricochet/io/summary.hpp"

/// @file Merging of the findings of ranks, each in its part of a body.
namespace ricochet {

/// Merges the findings of another rank into a summary: the deepest penetration of each kind, doubtful contacts, and the
/// largest stress.
void merge_findings(const RunSummary& other, RunSummary& summary);

}  // namespace ricochet
