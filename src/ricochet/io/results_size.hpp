#pragma once

#include "ricochet/io/results_file.hpp"

/// @file Estimated size of the files of fields.
namespace ricochet {

/// Bytes of the fields without compression.
struct ResultsSize {
  double mesh = 0.0, frame = 0.0;
  [[nodiscard]] double of(long frames) const { return mesh + static_cast<double>(frames) * frame; }
};

/// Estimate for the whole body, of `nodes` and `cells`; `body` may be one rank's part.
[[nodiscard]] ResultsSize results_size(const Body& body, const SemidiscreteProblem& problem,
                                       const ResultsOptions& options, Index nodes, Index cells);

}  // namespace ricochet
