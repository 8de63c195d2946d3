#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "ricochet/contact/sliding/sliding_pair.hpp"

/// @file Positions from which the rows of sliding surfaces were computed, and can be recomputed.
namespace ricochet {

/// Layout of a vector of values: 1 if rows are those of a step, then the displacements of all surface nodes at its end,
/// then those at its start.
class SurfaceDisplacements {
 public:
  SurfaceDisplacements(const std::vector<std::unique_ptr<SlidingPair>>& pairs, Index dimension)
      : dimension_(dimension) {
    for (const auto& pair : pairs) nodes_.insert(nodes_.end(), pair->nodes().begin(), pair->nodes().end());
    std::ranges::sort(nodes_);
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  }

  [[nodiscard]] Index count() const { return 1 + 2 * half(); }

  /// Writes the leading values. `start`: null if rows are those of an instant.
  void write(const Vector& displacement, const Vector* start, Vector& values) const {
    values[0] = start != nullptr ? 1.0 : 0.0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Index at = 1 + Index(i) * dimension_, first = nodes_[i] * dimension_;
      values.segment(at, dimension_) = displacement.segment(first, dimension_);
      if (start != nullptr) values.segment(at + half(), dimension_) = start->segment(first, dimension_);
    }
  }

  /// Reads the displacements of surface nodes at the end and at the start; other nodes are unchanged. Returns
  /// whether rows are those of a step.
  bool read(const Vector& values, Vector& displacement, Vector& start) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const Index at = 1 + Index(i) * dimension_, first = nodes_[i] * dimension_;
      displacement.segment(first, dimension_) = values.segment(at, dimension_);
      start.segment(first, dimension_) = values.segment(at + half(), dimension_);
    }
    return values[0] != 0.0;
  }

 private:
  [[nodiscard]] Index half() const { return dimension_ * Index(nodes_.size()); }

  Index dimension_;
  std::vector<Index> nodes_;  ///< of all pairs, ascending
};

}  // namespace ricochet
