#pragma once

#include <string>
#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Rotations beyond what small strain allows.
namespace ricochet {

/// Above this rotation of a cell, in rad, small strain no longer holds: it takes the rotation for a strain of half a
/// per cent.
inline constexpr double rotation_limit = 0.1;

/// "a strain of 0.5 % that is not there (1 - cos of the angle)"
[[nodiscard]] std::string spurious_strain(double rotation);

class RotationWatch {
 public:
  /// `column`: of max_rotation in a row. Keeps a reference.
  RotationWatch(const Body& body, std::size_t column) : body_(body), column_(column) {}
  void save(Snapshot& snapshot, const std::string& name) const { snapshot.save(name, warned_); }
  void load(const Snapshot& snapshot, const std::string& name) { warned_ = snapshot.flag(name); }

  /// A row of history.csv. Warns the first time that a cell has turned too far.
  void watch(const std::vector<double>& row, const State& state);

 private:
  const Body& body_;
  std::size_t column_;
  bool warned_ = false;
};

}  // namespace ricochet
