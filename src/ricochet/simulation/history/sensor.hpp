#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/history/column.hpp"
#include "ricochet/simulation/history/probe.hpp"

/// @file What is watched besides the whole body: points, boundaries, groups, contacts. To add a kind: a file in
/// sensors/ with a class, its function here, and its keys in the section [[probe]] of a case.
namespace ricochet {

/// A state, and what several sensors want to know of it.
struct Observation {
  const State& state;
  const Vector& gap;               ///< per node of the contact boundary
  const Vector& pressure;          ///< likewise; of several ranks a part, which the sum over them completes
  const Vector& nominal_pressure;  ///< per undeformed area: at small strain `pressure`
};

class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Its columns, named by the sensor's name, a dot, and what it is.
  [[nodiscard]] virtual Columns columns() const = 0;
  /// Appends their values; allocates nothing after the first time. Of several ranks what this one has, which then is
  /// put together as the columns say; all ranks have the same sensors and observe together.
  virtual void observe(const Observation& observation, std::vector<double>& row) = 0;
};

/// Motion of a node and, on the contact boundary, its gap, pressure and contact force.
[[nodiscard]] std::unique_ptr<Sensor> make_point_sensor(const SemidiscreteProblem& problem, const Probe& probe);

/// With these columns, sums all of them, zero: of a node that other ranks have.
[[nodiscard]] std::unique_ptr<Sensor> make_absent_sensor(Columns columns);

/// Force and moment on the body of supports and contacts together at the nodes of some facets, and of the supports
/// alone: where a contact shares nodes with the facets, only the latter are the reaction of the support. Moments are
/// about `about`, with reference positions, at finite strain with those of the state. Given loads are not part of
/// either.
[[nodiscard]] std::unique_ptr<Sensor> make_boundary_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                                           const std::vector<Index>& nodes, const Vector& about);

/// Average (over volume or area), least and largest value of displacement and velocity in some cells or facets, and of
/// cells also of von Mises' stress.
[[nodiscard]] std::unique_ptr<Sensor> make_cell_group_sensor(const std::string& name, const Body& body,
                                                             const std::vector<Index>& cells,
                                                             const Ranks& ranks = one_rank());
[[nodiscard]] std::unique_ptr<Sensor> make_facet_group_sensor(const std::string& name, const Body& body,
                                                              const std::vector<Index>& facets,
                                                              const Ranks& ranks = one_rank());

/// A contact pair, by its number; `exchanged`: ContactPair::exchanged.
struct SensedPair {
  int number = 0;
  bool exchanged = false;
};

/// Resultant of a [[contact]], the sum over its pairs: force on the body, which between bodies is that of the pair's
/// first group in the case; centre of pressure Σ r_N x / Σ r_N with the
/// places x that the moments of boundaries take (0 where open), and area of the pressed part of the facets on the side
/// that carries the multipliers (in 2D a length; contact_surface.hpp), at finite strain after the
/// deformation, and before it as "nominal_area".
[[nodiscard]] std::unique_ptr<Sensor> make_contact_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                                          const std::vector<SensedPair>& pairs);

/// The force of a contact between bodies alone, in the columns pair_force.N_x … of contact N.
[[nodiscard]] std::unique_ptr<Sensor> make_pair_force_sensor(const SemidiscreteProblem& problem, int contact,
                                                             bool exchanged);

/// Motion of a rigid body that moves freely, and the contact force on it.
[[nodiscard]] std::unique_ptr<Sensor> make_free_body_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                                            const Obstacle& obstacle);

// For those who write sensors:

/// False for the many points that are open.
[[nodiscard]] bool carries_force(const StepForces& forces, Index point);
/// The force of a contact point on the body: r_N n − t r_T.
[[nodiscard]] inline SpaceVector contact_force(const StepForces& forces, Index point) {
  return forces.rows->force(point, forces.normal_reaction, forces.tangential_reaction);
}
/// The same of what acted over the step.
[[nodiscard]] bool carries_acting_force(const StepForces& forces, Index point);
[[nodiscard]] inline SpaceVector acting_contact_force(const StepForces& forces, Index point) {
  return forces.rows->force(point, forces.acting_normal(), forces.acting_tangential());
}
template <class Values>
void append(const Values& values, std::vector<double>& row) {
  for (Index k = 0; k < values.size(); ++k) row.push_back(values[k]);
}

}  // namespace ricochet
