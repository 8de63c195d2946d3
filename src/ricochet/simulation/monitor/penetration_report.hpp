#pragma once

#include <string>
#include <vector>

/// @file Penetration that no contact prevented, as it was found.
namespace ricochet {

/// Entry of `not_watched` for bodies that are not looked at for parts of theirs inside of each other.
inline constexpr const char* bodies_in_themselves = "bodies against themselves";

/// A body that was found inside of an obstacle or of itself, or two bodies that were found inside of each other.
struct UnwatchedPenetration {
  std::string obstacle;             ///< empty: bodies
  std::vector<std::string> bodies;  ///< one, also without an obstacle: it is inside of itself; or two
  double depth = 0.0;
  double relative_depth = 0.0;  ///< to the diameter of the smallest ball around the (smaller) body
  double time = 0.0;
  std::vector<double> place;        ///< of the node, at that time
  double first_time = 0.0;          ///< when it was found
  std::vector<std::string> groups;  ///< boundary groups of the mesh that the node belongs to
  /// The two groups of the contact that keeps the node out, which is deeper than that allows; empty: there is none.
  std::vector<std::string> contact = {};
  /// The node went through the obstacle within one step, so deep on its way.
  bool passed_through = false;
  /// Boundary groups of the facet that the node has gone through, if a body is inside of itself.
  std::vector<std::string> through_groups = {};

  [[nodiscard]] bool is_in_itself() const { return obstacle.empty() && bodies.size() == 1; }
};

/// A contact that goes on beyond its group.
struct ContactBeyondRim {
  std::string group, obstacle;
  double time = 0.0;
  std::vector<double> place;
  std::vector<std::string> groups;  ///< boundary groups of the facets beyond
};

struct PenetrationReport {
  bool checked = false;  ///< false: results of a version that did not look
  long looks_at_obstacles = 0, looks_at_bodies = 0;
  std::vector<UnwatchedPenetration> found = {};
  std::vector<ContactBeyondRim> rims = {};
  long looks_at_themselves = 0;               ///< of bodies
  std::vector<std::string> not_watched = {};  ///< what was not looked at, in words

  /// Nothing was left out.
  [[nodiscard]] bool is_complete() const { return checked && not_watched.empty(); }

  /// The deepest of what was found; nullptr: nothing was.
  [[nodiscard]] const UnwatchedPenetration* deepest() const;
};

}  // namespace ricochet
