#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/expression.hpp"
#include "ricochet/base/snapshot.hpp"
#include "ricochet/base/space_vector.hpp"

/// @file Prescribed motion of a rigid obstacle.
namespace ricochet {

/// Displacement u(t) of a point of the obstacle and rotation θ(t) about that point: x = c + u + Q(θ) (X − c), with θ a
/// vector in 3D (angle |θ| about θ) and one number in 2D.
class ObstaclePath {
 public:
  virtual ~ObstaclePath() = default;
  [[nodiscard]] virtual SpaceVector displacement(double time) const = 0;
  /// Rotation vector θ; only if rotates().
  [[nodiscard]] virtual SpaceVector rotation(double /*time*/) const { return {}; }
  [[nodiscard]] virtual bool rotates() const { return false; }
  /// Constant velocity, if u is linear in t: displacements are then t times this velocity, and θ is zero.
  [[nodiscard]] virtual bool is_uniform() const { return false; }
  [[nodiscard]] virtual SpaceVector velocity() const { return {}; }
  /// Checksum of the file that defines it; empty if none.
  [[nodiscard]] virtual std::string checksum() const { return {}; }
};

/// A path that a program steers: from an instant on it continues with new rates from its current position.
class SteeredPath final : public ObstaclePath {
 public:
  /// `before`: its path until it is steered; null: at rest.
  SteeredPath(std::unique_ptr<const ObstaclePath> before, Index dimension);

  /// Sets the rates from an instant on, which must not be earlier than the last one set. `rotation_rate`: rate of θ;
  /// empty: none. Throws Error(invalid_input) if sizes do not fit, if a rate is not finite, or for a rotation rate if
  /// the path does not rotate.
  void steer(double time, const SpaceVector& velocity, const SpaceVector& rotation_rate);

  [[nodiscard]] SpaceVector displacement(double time) const override;
  [[nodiscard]] SpaceVector rotation(double time) const override;
  [[nodiscard]] bool rotates() const override { return before_ != nullptr && before_->rotates(); }
  [[nodiscard]] std::string checksum() const override { return before_ != nullptr ? before_->checksum() : ""; }

  /// Throws Error(invalid_input) if an entry that is loaded does not fit; the path is then unchanged.
  void persist(const SnapshotVisitor& visit);

 private:
  /// Position at an instant, and rates from there on.
  struct Leg {
    double start = 0.0;
    SpaceVector displacement, rotation, velocity, rotation_rate;
    [[nodiscard]] auto members() { return std::tie(start, displacement, rotation, velocity, rotation_rate); }
  };
  [[nodiscard]] const Leg* leg_at(double time) const;

  std::unique_ptr<const ObstaclePath> before_;
  Index dimension_, rotations_;  ///< number of components of u and of θ
  std::vector<Leg> legs_;        ///< the most recent ones, in their order
};

/// Returns null for zero velocity: such an obstacle is at rest.
[[nodiscard]] std::unique_ptr<ObstaclePath> make_uniform_path(const Vector& velocity);
/// Makes a path from expressions of t: d for the displacement, and 1 or 3 for the rotation; either may be empty.
[[nodiscard]] std::unique_ptr<ObstaclePath> make_path(std::vector<Expression> displacement,
                                                      std::vector<Expression> rotation, Index dimension);
/// Reads a path from a text file of numbers: each line has t and d components of u, optionally followed by those of θ,
/// separated by commas or spaces. A first line of names is skipped. Linear between lines, constant beyond the first and
/// the last. Throws Error(invalid_input) with file and line, or Error(file_access).
[[nodiscard]] std::unique_ptr<ObstaclePath> read_path(const std::string& file, Index dimension);

}  // namespace ricochet
