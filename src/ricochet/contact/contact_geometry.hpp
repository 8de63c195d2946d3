#pragma once

#include <memory>
#include <vector>

#include "ricochet/contact/contact_rows.hpp"

/// @file Where the contact conditions come from when they follow the motion.
namespace ricochet {

struct ContactCut;         // contact_cut.hpp
struct CurvedContactData;  // curved_contact.hpp

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
  /// A step begins, or begins again. Nothing is held any more.
  virtual void begin_step() const {}
  /// Rounds of a step that come no nearer, as what faces what changes from one to the next, may ask for this: until the
  /// step is done, rows stay as they are and gaps are linear. False: there is nothing to hold, or it is held already.
  virtual bool hold() const { return false; }
  virtual void end_step() const {}
  /// Some step of the run so far was held.
  [[nodiscard]] virtual bool has_held() const { return false; }
  /// To the gaps of a step's end: what points were inside of the other body where it began. Steps that were held leave
  /// that, and to push it out would give energy; it may only not grow.
  virtual void allow_overlap(Vector& /*gap*/) const {}
  /// Sets to 0 what points take no part since the last update: others carry the conditions where they are.
  virtual void leave_out(std::vector<char>& /*eligible*/) const {}
  /// Adds what the forces of reactions are at a place beyond those of the rows, where rows are those of a step: couples
  /// that take back their moment about that place, on the nodes of bodies that touch each other, and on rigid bodies
  /// that move freely. Nothing at other obstacles. `tangential` may be empty.
  virtual void add_couples(const Vector& /*place*/, const ContactRows& /*rows*/, const Vector& /*normal*/,
                           const Vector& /*tangential*/, Vector& /*force*/) const {}
  /// Whether node_normal() knows a node of the contact boundary better than the start does.
  [[nodiscard]] virtual bool has_node(Index entry) const = 0;
  /// What normals do not tell of rows, a fixed number of values; none where rows are the trace times the normal.
  [[nodiscard]] virtual Index row_value_count() const { return 0; }
  [[nodiscard]] virtual Vector row_values(const ContactRows&) const { return {}; }
  /// Makes them those that had these normals (d × points), gaps and values.
  virtual void restore(const Points& normals, const Vector& gap, const Vector& row_values, ContactRows& rows) const = 0;
  /// What it is made of, where it is of curved obstacles alone; else null.
  [[nodiscard]] virtual const CurvedContactData* curved() const { return nullptr; }
  /// The same of some points and nodes, in their numbers; null where that is not to be had.
  [[nodiscard]] virtual std::unique_ptr<ContactGeometry> cut(const ContactCut&) const { return nullptr; }
};

/// Several of them, each of points and nodes of its own.
[[nodiscard]] std::unique_ptr<ContactGeometry> combine(std::vector<std::unique_ptr<ContactGeometry>> parts);

}  // namespace ricochet
