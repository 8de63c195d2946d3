#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/expression.hpp"
#include "ricochet/base/snapshot.hpp"
#include "ricochet/base/space_vector.hpp"

/// @file How a rigid obstacle moves where its motion is given.
namespace ricochet {

/// Displacement u(t) of a point of the obstacle and rotation θ(t) about that point: x = c + u + Q(θ) (X − c), θ a
/// vector in 3D (|θ| about θ) and one number in 2D.
class ObstaclePath {
 public:
  virtual ~ObstaclePath() = default;
  [[nodiscard]] virtual SpaceVector displacement(double time) const = 0;
  /// Only where turns().
  [[nodiscard]] virtual SpaceVector rotation(double /*time*/) const { return {}; }
  [[nodiscard]] virtual bool turns() const { return false; }
  /// A constant one, where u is linear in t: then displacements are this times t, and θ is zero.
  [[nodiscard]] virtual bool is_uniform() const { return false; }
  [[nodiscard]] virtual SpaceVector velocity() const { return {}; }
  /// Of the file that it comes from; empty: none.
  [[nodiscard]] virtual std::string checksum() const { return {}; }
};

/// A path that a program steers: from an instant on it has other rates, from where it is then.
class SteeredPath final : public ObstaclePath {
 public:
  /// `before`: its path until it is steered; null: at rest.
  SteeredPath(std::unique_ptr<const ObstaclePath> before, Index dimension);

  /// From this instant on, not before the last one that was set. `rotation_rate`: of θ; empty: none. Throws
  /// Error(invalid_input) where sizes do not fit, where it is not finite, or for a rate where the path does not turn.
  void steer(double time, const SpaceVector& velocity, const SpaceVector& rotation_rate);

  [[nodiscard]] SpaceVector displacement(double time) const override;
  [[nodiscard]] SpaceVector rotation(double time) const override;
  [[nodiscard]] bool turns() const override { return before_ != nullptr && before_->turns(); }
  [[nodiscard]] std::string checksum() const override { return before_ != nullptr ? before_->checksum() : ""; }

  void save(Snapshot& snapshot, const std::string& name) const;
  /// Throws Error(invalid_input) where it does not fit.
  void load(const Snapshot& snapshot, const std::string& name);

 private:
  /// Where it was at an instant, and how fast it goes from there.
  struct Leg {
    double start = 0.0;
    SpaceVector displacement, rotation, velocity, rotation_rate;
  };
  [[nodiscard]] const Leg* leg_at(double time) const;

  std::unique_ptr<const ObstaclePath> before_;
  Index dimension_, rotations_;  ///< numbers of u and of θ
  std::vector<Leg> legs_;        ///< the last ones, in their order
};

/// Null where it is zero: such an obstacle rests.
[[nodiscard]] std::unique_ptr<ObstaclePath> make_uniform_path(const Vector& velocity);
/// Expressions of t: d of the displacement, and 1 or 3 of the rotation; either may be empty.
[[nodiscard]] std::unique_ptr<ObstaclePath> make_path(std::vector<Expression> displacement,
                                                      std::vector<Expression> rotation, Index dimension);
/// From a text file of numbers: t and d components of u in each line, perhaps followed by those of θ; separated by
/// commas or spaces. A first line of names is passed over. Linear between lines, constant beyond the first and the
/// last. Throws Error(invalid_input) with file and line, or Error(file_access).
[[nodiscard]] std::unique_ptr<ObstaclePath> read_path(const std::string& file, Index dimension);

}  // namespace ricochet
