#include "ricochet/contact/obstacle.hpp"

#include <fmt/format.h>

#include <functional>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

/// The half-space below a plane: gap (x − p)·n.
class Plane final : public Obstacle {
 public:
  explicit Plane(const ObstacleParameters& parameters)
      : point_(parameters.point), normal_(parameters.normal / parameters.normal.norm()) {}

  [[nodiscard]] double gap(const Vector& position) const override { return (position - point_).dot(normal_); }
  [[nodiscard]] Vector normal(const Vector&) const override { return normal_; }
  [[nodiscard]] double gap_rounding(const Vector& position) const override {
    const double size = (position.cwiseAbs() + point_.cwiseAbs()).dot(normal_.cwiseAbs());
    return 8.0 * std::numeric_limits<double>::epsilon() * size;
  }

 private:
  Vector point_;
  Vector normal_;
};

struct Registration {
  std::string type;
  std::function<std::unique_ptr<Obstacle>(const ObstacleParameters&)> make;
};

const std::vector<Registration>& registrations() {
  static const std::vector<Registration> all{
      {"plane", [](const ObstacleParameters& p) { return std::make_unique<Plane>(p); }},
  };
  return all;
}

}  // namespace

std::vector<std::string> obstacle_types() {
  std::vector<std::string> names;
  for (const Registration& entry : registrations()) names.push_back(entry.type);
  return names;
}

std::unique_ptr<Obstacle> make_obstacle(const ObstacleParameters& parameters) {
  for (const Registration& entry : registrations()) {
    if (entry.type == parameters.type) return entry.make(parameters);
  }
  throw Error(ErrorKind::invalid_input,
              fmt::format("unknown obstacle type \"{}\"; known: {}", parameters.type, join_names(obstacle_types())));
}

}  // namespace ricochet
