#pragma once

#include <vector>

#include "ricochet/contact/contact_rows.hpp"
#include "ricochet/contact/sliding/sliding_pair.hpp"

/// @file Forces of points that slide far, if they act at other positions than those of their rows.
namespace ricochet {

/// Forces that act elsewhere than in the middle of the step are those of the rows there, with friction of the same size
/// and along the same tangents, and a couple that cancels its moment across the gap.
class SlidingCouples {
 public:
  /// `nodes`: reference positions of all nodes, d × count; kept by reference.
  explicit SlidingCouples(const Points& nodes) : nodes_(nodes) {}

  /// Finds the points without a reaction, as flags. Returns false if there are no others.
  [[nodiscard]] bool find_forces(const std::vector<SlidingPair::Point>& points, const Vector& normal,
                                 const Vector& tangential, std::vector<char>& forceless) const;
  /// Adds the difference between the forces of a point at `displacement` and those of its rows.
  /// `view`: its view there, with rows.
  void add(Index point, const SlidingView& view, const Vector& displacement, const ContactRows& rows,
           const Vector& normal, const Vector& tangential, Vector& force);

 private:
  const Points& nodes_;
  std::vector<SlidingVector> positions_, motions_;
};

}  // namespace ricochet
