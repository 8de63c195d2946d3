#pragma once

#include <optional>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/fem/vertex_volumes.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Cells that are turned inside out between their quadrature points.
namespace ricochet {

class InversionWatch {
 public:
  /// Watches bodies of laws of finite strain and degree 2. Keeps references.
  InversionWatch(const Body& body, const Ranks& ranks);
  void persist(const SnapshotVisitor& visit) { visit("warned", has_warned_); }

  /// Enters a state. Warns the first time that a cell is inverted at a vertex.
  void watch(double time, const State& state);

 private:
  const Body& body_;
  std::optional<VertexVolumes> volumes_;
  bool has_warned_ = false;
};

}  // namespace ricochet
