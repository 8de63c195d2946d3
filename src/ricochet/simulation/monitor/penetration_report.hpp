#pragma once

#include <string>
#include <vector>

/// @file Report on penetration that no contact prevented.
namespace ricochet {

/// Entry of `not_watched` for bodies that are not checked for self-penetration.
inline constexpr const char* bodies_in_themselves = "bodies against themselves";

/// Body that was found inside an obstacle or itself, or two bodies that were found inside each other.
struct UnwatchedPenetration {
  std::string obstacle;             ///< empty for bodies
  std::vector<std::string> bodies;  ///< one, without an obstacle inside itself; or two
  double depth = 0.0;
  double relative_depth = 0.0;  ///< to the diameter of the smallest ball around the (smaller) body
  double time = 0.0;
  std::vector<double> position;     ///< of the node, at that time
  double first_time = 0.0;          ///< time of its detection
  std::vector<std::string> groups;  ///< boundary groups of the mesh that the node belongs to
  /// Both groups of the contact at the node, which is deeper than the contact allows; empty if there is no contact.
  std::vector<std::string> contact = {};
  /// True if the node passed through the obstacle within one step, with this depth on its path.
  bool passed_through = false;
  /// Boundary groups of the facet that the node has passed through, if a body is inside itself.
  std::vector<std::string> through_groups = {};

  [[nodiscard]] bool is_self_penetration() const { return obstacle.empty() && bodies.size() == 1; }
};

/// Contact that continues beyond its group.
struct ContactBeyondRim {
  std::string group, obstacle;
  double time = 0.0;
  std::vector<double> position;
  std::vector<std::string> groups;  ///< boundary groups of the facets beyond the group
};

struct PenetrationReport {
  long obstacle_checks = 0, body_checks = 0;
  std::vector<UnwatchedPenetration> found = {};
  std::vector<ContactBeyondRim> rims = {};
  long self_penetration_checks = 0;           ///< checks for self-penetration
  std::vector<std::string> not_watched = {};  ///< objects that were not checked, in words

  /// Returns whether everything was checked.
  [[nodiscard]] bool is_complete() const { return not_watched.empty(); }

  /// Deepest penetration; nullptr if none was found.
  [[nodiscard]] const UnwatchedPenetration* deepest() const;
};

}  // namespace ricochet
