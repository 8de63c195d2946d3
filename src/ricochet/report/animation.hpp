#pragma once

#include <optional>
#include <string>
#include <vector>

/// @file Pictures of a body as it moves: what is to be drawn, described in JSON for the script that draws it.
namespace ricochet {

struct AnimationOptions {
  std::string field = "von_mises";
  std::optional<double> time = {};  ///< of a single picture
  /// The part of the time to be shown.
  std::optional<std::pair<double, double>> interval = {};
  std::string title = {};
  double width = 0.0, height = 0.0;  ///< cm; 0: what suits the body
  bool half = false;                 ///< of an axisymmetric body the section alone
  bool zoom = false;                 ///< on the contact
};

/// The visible surface of the body of a run in every frame, or in one, with the values of a field and the obstacles.
/// Throws Error(usage) where there is no such frame or field, and says what there is.
[[nodiscard]] std::string describe_animation(const std::string& directory, const AnimationOptions& options);

}  // namespace ricochet
