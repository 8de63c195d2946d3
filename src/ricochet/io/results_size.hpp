#pragma once

#include "ricochet/io/results_file.hpp"

/// @file Size of the file of fields, before there is one.
namespace ricochet {

/// In bytes, without compression.
struct ResultsSize {
  double mesh = 0.0, frame = 0.0;
  [[nodiscard]] double of(long frames) const { return mesh + static_cast<double>(frames) * frame; }
};

/// `nodes`, `cells`: of the whole body, of which a rank has a part.
[[nodiscard]] ResultsSize results_size(const Body& body, const SemidiscreteProblem& problem,
                                       const ResultsOptions& options, Index nodes, Index cells);

}  // namespace ricochet
