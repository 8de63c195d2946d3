#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/history/column.hpp"
#include "ricochet/simulation/history/probe.hpp"

/// @file Sensors: quantities of points, boundaries, groups and contacts in the history. Those of a [[probe]] are
/// registered (probe_kind.hpp).
namespace ricochet {

/// State, and quantities that several sensors need.
struct Observation {
  const State& state;
  const Vector& gap;               ///< per node of the contact boundary
  const Vector& pressure;          ///< likewise; on several ranks a part, completed by the sum over them
  const Vector& nominal_pressure;  ///< per undeformed area; at small strain equal to `pressure`
};

class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Columns, whose names are the sensor's name, a dot and the quantity.
  [[nodiscard]] virtual Columns columns() const = 0;
  /// Appends the values of the columns; allocates nothing after the first time. On several ranks each appends its part,
  /// and the columns state how the parts are combined; all ranks have the same sensors and observe together.
  virtual void observe(const Observation& observation, std::vector<double>& row) = 0;
};

/// Motion of a node and, on the contact boundary, its gap, pressure and contact force.
[[nodiscard]] std::unique_ptr<Sensor> make_point_sensor(const SemidiscreteProblem& problem, const Probe& probe);

/// Force and moment on the body at the nodes of some facets, of supports and contacts together, and of the supports
/// alone: where contact and facets share nodes, only the latter are the reaction of the support. Moments are about
/// `about`, with reference positions, at finite strain with current ones. Prescribed loads are part of neither.
[[nodiscard]] std::unique_ptr<Sensor> make_boundary_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                                           const std::vector<Index>& nodes, const Vector& about);

/// Average (over volume or area), minimum and maximum of displacement and velocity in some cells or facets, for cells
/// also of the von Mises stress.
[[nodiscard]] std::unique_ptr<Sensor> make_cell_group_sensor(const std::string& name, const Body& body,
                                                             const std::vector<Index>& cells,
                                                             const Ranks& ranks = one_rank());
[[nodiscard]] std::unique_ptr<Sensor> make_facet_group_sensor(const std::string& name, const Body& body,
                                                              const std::vector<Index>& facets,
                                                              const Ranks& ranks = one_rank());

/// Contact pair by its number; `exchanged`: ContactPair::exchanged.
struct SensedPair {
  int number = 0;
  bool exchanged = false;
};

/// Resultant of a [[contact]], summed over its pairs: the force on the body, which between bodies is that of the pair's
/// first group in the case; the centre of pressure Σ r_N x / Σ r_N (0 if open), with the positions x that the moments
/// of boundaries use; and the area of the pressed part of the facets on the side that carries the multipliers (in 2D a
/// length; contact_surface.hpp), at finite strain after deformation, and before it as "nominal_area".
[[nodiscard]] std::unique_ptr<Sensor> make_contact_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                                          const std::vector<SensedPair>& pairs);

/// Force of a contact between bodies alone, in the columns pair_force.N_x … of contact N: a pair, and its corners.
[[nodiscard]] std::unique_ptr<Sensor> make_pair_force_sensor(const SemidiscreteProblem& problem, int contact,
                                                             const std::vector<SensedPair>& pairs);
[[nodiscard]] std::vector<RowQuantity> pair_force_quantities();

/// Motion of a free rigid body and the contact force on it.
[[nodiscard]] std::unique_ptr<Sensor> make_free_body_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                                            const Obstacle& obstacle);
[[nodiscard]] std::vector<RowQuantity> free_body_quantities();

// Functions for the implementation of sensors:

/// Returns false for the many points that are open.
[[nodiscard]] bool carries_force(const StepForces& forces, Index point);
/// Force of a contact point on the body: r_N n − t r_T.
[[nodiscard]] inline SpaceVector contact_force(const StepForces& forces, Index point) {
  return forces.rows->force(point, forces.normal_reaction, forces.tangential_reaction);
}
/// As above, for the forces that acted over the step.
[[nodiscard]] bool carries_acting_force(const StepForces& forces, Index point);
[[nodiscard]] inline SpaceVector acting_contact_force(const StepForces& forces, Index point) {
  return forces.rows->force(point, forces.acting_normal(), forces.acting_tangential());
}

}  // namespace ricochet
