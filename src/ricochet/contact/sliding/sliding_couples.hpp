#pragma once

#include <vector>

#include "ricochet/contact/contact_rows.hpp"
#include "ricochet/contact/sliding/sliding_pair.hpp"

/// @file Forces of points that slide far, where they act at another place than that of their rows.
namespace ricochet {

/// Forces that act at another place than the middle of the step are those of the rows there, with friction as strong
/// and along the same tangents, and a couple that takes back its moment across the gap.
class SlidingCouples {
 public:
  /// `nodes`: reference positions of all nodes, d × count; kept by reference.
  explicit SlidingCouples(const Points& nodes) : nodes_(nodes) {}

  /// Adds what the forces of a point at `place` are beyond those of its rows. `view`: what it sees there, with rows.
  void add(Index point, const SlidingView& view, const Vector& place, const ContactRows& rows, const Vector& normal,
           const Vector& tangential, Vector& force);

 private:
  const Points& nodes_;
  std::vector<SlidingVector> places_, motions_;
};

}  // namespace ricochet
