#pragma once

#include <string>
#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/fem/cell_rotations.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Rotations beyond the range of small strain.
namespace ricochet {

/// Returns a text such as "a strain of 0.5 % that is not there (1 - cos of the angle)".
[[nodiscard]] std::string spurious_strain(double rotation);

/// Rotation beyond which small strain does not hold; infinite if the laws of the body are those of finite strain.
[[nodiscard]] double limit_of_rotation(const Body& body);

class RotationWatch {
 public:
  /// `column` is the index of max_rotation in a row. Keeps references.
  RotationWatch(const Body& body, const Ranks& ranks, std::size_t column);
  void persist(const SnapshotVisitor& visit);

  /// Enters a row of history.csv. Warns the first time that a cell has rotated too far. Allocates nothing.
  void watch(const std::vector<double>& row, const State& state);
  [[nodiscard]] double limit() const { return limit_; }
  /// Time of the first row in which a cell has rotated too far; infinite if none.
  [[nodiscard]] double time_beyond_limit() const;
  /// Largest rotation in rows up to that time, accurate to a hundredth and on the correct side of the limit.
  [[nodiscard]] double largest_until(double time) const;

 private:
  struct RotationRecord {
    double time, rotation;
    [[nodiscard]] auto members() { return std::tie(time, rotation); }
  };
  const Body& body_;
  const Ranks& ranks_;
  std::size_t column_;
  double limit_;
  std::vector<RotationRecord> records_;
};

}  // namespace ricochet
