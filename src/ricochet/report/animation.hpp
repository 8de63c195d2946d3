#pragma once

#include <optional>
#include <string>

/// @file Pictures of a moving body, described in JSON for the script that draws them.
namespace ricochet {

struct AnimationOptions {
  std::string field = "von_mises";
  std::optional<double> time = {};  ///< of a single picture
  /// Interval of time to be shown.
  std::optional<std::pair<double, double>> interval = {};
  std::string title = {};
  double width = 0.0, height = 0.0;  ///< cm; 0: chosen to suit the body
  bool half = false;                 ///< section only, for an axisymmetric body
  bool zoom = false;                 ///< on the contact
};

/// Describes the visible surface of the body of a run in every frame, or in one, with the values of a field and the
/// obstacles. Throws Error(usage) if there is no such frame or field, and lists those that exist.
[[nodiscard]] std::string describe_animation(const std::string& directory, const AnimationOptions& options);

}  // namespace ricochet
