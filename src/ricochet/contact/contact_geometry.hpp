#pragma once

#include <memory>
#include <vector>

#include "ricochet/contact/contact_rows.hpp"

/// @file Where the contact conditions come from when they follow the motion.
namespace ricochet {

/// Where a step began.
struct StepStart {
  const Vector& displacement;
  double time;
};

/// Gaps and rows of contact points as functions of the displacement and the time, for those points at which they are
/// not linear; the others have their constant rows. A row is the derivative of its gap, or that of its gap over a step
/// (Obstacle::normal_of_step).
class ContactGeometry {
 public:
  virtual ~ContactGeometry() = default;
  /// Overwrites the gaps of the points that it is responsible for.
  virtual void gaps(const Vector& displacement, double time, Vector& gap) const = 0;
  /// The same for nodes of the contact boundary.
  virtual void node_gaps(const Vector& displacement, double time, Vector& gap) const = 0;
  /// The normal at a node of the contact boundary; that of the start where it is constant.
  [[nodiscard]] virtual SpaceVector node_normal(Index entry, const Vector& displacement, double time) const = 0;
  /// Makes the rows those at this displacement and time; rows that change get another revision. Points that are far
  /// from touching beside what gaps have changed since the last look keep theirs. `start`: rows are those of the step
  /// from there, null: of that instant.
  virtual void update(const Vector& displacement, double time, const StepStart* start, ContactRows& rows) const = 0;
  /// Makes them those that had these normals (d × points) and gaps.
  virtual void restore(const Points& normals, const Vector& gap, ContactRows& rows) const = 0;
};

}  // namespace ricochet
