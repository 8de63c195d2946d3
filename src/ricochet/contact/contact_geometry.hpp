#pragma once

#include <memory>
#include <vector>

#include "ricochet/contact/contact_rows.hpp"

/// @file Contact conditions that follow the motion.
namespace ricochet {

struct CurvedContactData;  // curved_contact.hpp

/// State at the start of a step.
struct StepStart {
  const Vector& displacement;
  double time;
};

/// Gaps and rows of contact points as functions of displacement and time, for those points at which they are nonlinear;
/// the other points have constant rows. A row is the derivative of its gap, or the discrete derivative of its gap over
/// a step (Obstacle::normal_of_step).
class ContactGeometry {
 public:
  virtual ~ContactGeometry() = default;
  /// Overwrites the gaps of the points of this geometry.
  virtual void gaps(const Vector& displacement, double time, Vector& gap) const = 0;
  /// Overwrites the gaps of its nodes of the contact boundary.
  virtual void node_gaps(const Vector& displacement, double time, Vector& gap) const = 0;
  /// Normal at a node of the contact boundary; the initial one if it is constant.
  [[nodiscard]] virtual SpaceVector node_normal(Index entry, const Vector& displacement, double time) const = 0;
  /// Updates the rows to this displacement and time; rows that change receive a new revision. Points whose gap is large
  /// compared with the changes of the gaps since the last update may keep their rows. `start`: rows are those of the
  /// step from there; null: those of the instant.
  virtual void update(const Vector& displacement, double time, const StepStart* start, ContactRows& rows) const = 0;
  /// Records a displacement that the next update is not for, if points keep their rows: it shows how fast gaps change.
  virtual void prepare_update(const Vector& /*displacement*/, double /*time*/, const StepStart* /*start*/,
                              ContactRows& /*rows*/) const {}
  /// Begins a step, or begins it again, without frozen rows.
  virtual void begin_step() const {}
  /// Freezes the rows for the remainder of the step, so that gaps are linear: for iterations of a step that do
  /// not converge because the pairing changes from one to the next. Returns false if there is nothing to
  /// freeze, or rows are already frozen.
  virtual bool freeze() const { return false; }
  virtual void end_step() const {}
  /// Whether rows are frozen in the present step.
  [[nodiscard]] virtual bool is_frozen() const { return false; }
  /// Whether rows were frozen in some step of the run so far.
  [[nodiscard]] virtual bool has_frozen() const { return false; }
  /// Adds to the gaps at the end of a step the penetration of points at its start. Steps with frozen rows leave it
  /// behind, and removing it would create energy; it may only not grow.
  virtual void allow_overlap(Vector& /*gap*/) const {}
  /// Deactivates points whose conditions other points enforce since the last update (sets them to 0).
  virtual void deactivate_points(std::vector<char>& /*eligible*/) const {}
  /// Adds the difference between the forces of reactions at a displacement and those of the rows, if these are rows of
  /// a step: couples that cancel their moment about the positions there, on the nodes of bodies in contact with each
  /// other, and on free rigid bodies. Does nothing for other obstacles. `tangential` may be empty.
  virtual void add_couples(const Vector& /*displacement*/, const ContactRows& /*rows*/, const Vector& /*normal*/,
                           const Vector& /*tangential*/, Vector& /*force*/) const {}
  /// Whether node_normal() of a node differs from the initial normal.
  [[nodiscard]] virtual bool has_node(Index entry) const = 0;
  /// How often surfaces have been projected onto each other so far: most of the cost of pairs that slide far.
  [[nodiscard]] virtual long projection_count() const { return 0; }
  /// Values that determine the rows in addition to the normals, a fixed number; none if rows
  /// are the trace times the normal.
  [[nodiscard]] virtual Index row_value_count() const { return 0; }
  [[nodiscard]] virtual Vector row_values(const ContactRows&) const { return {}; }
  /// Restores the rows that had these normals (d × points), gaps and values.
  virtual void restore(const Points& normals, const Vector& gap, const Vector& row_values, ContactRows& rows) const = 0;
  /// Data of a geometry that consists of curved obstacles alone, which can be divided; else null.
  [[nodiscard]] virtual const CurvedContactData* curved() const { return nullptr; }
};

/// Combines several geometries, each with its own points and nodes.
[[nodiscard]] std::unique_ptr<ContactGeometry> combine(std::vector<std::unique_ptr<ContactGeometry>> parts);

}  // namespace ricochet
