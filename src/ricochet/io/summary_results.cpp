#include <fmt/format.h>

#include "ricochet/io/summary_visitor.hpp"
#include "ricochet/simulation/impact/restitution.hpp"
#include "ricochet/simulation/impact/rotation_growth.hpp"
#include "ricochet/simulation/monitor/stress_raisers.hpp"

namespace ricochet {

namespace {

/// Text that is null if it is empty.
template <class Text>
IfKnown<Text&> unless_empty(Text& text) {
  return {!text.empty(), text};
}

}  // namespace

void describe(SummaryVisitor& visit, UnwatchedPenetration& found) {
  visit.type("UnwatchedPenetration");
  visit("obstacle", unless_empty(found.obstacle), "name of the obstacle; null for bodies");
  visit("bodies", found.bodies, "names of the bodies; one without an obstacle is inside itself");
  visit("depth", Real{found.depth}, "largest depth");
  visit("relative_depth", Real{found.relative_depth},
        "depth relative to the diameter of the smallest ball around the body, of two bodies the smaller one");
  visit("time", found.time, "time of the largest depth");
  visit("place", found.position, "position of the node at that time");
  visit("first_time", found.first_time, "time when the penetration was found first");
  visit("groups", found.groups, "boundary groups of the mesh that the node belongs to");
  visit("contact", unless_empty(found.contact), "both groups of the contact at the node; null if none");
  visit("passed_through", found.passed_through, "whether the node went through the obstacle within one step");
  visit("through_groups", found.through_groups, "in a body itself: boundary groups of the facet that the node crossed");
}

void describe(SummaryVisitor& visit, ContactBeyondRim& rim) {
  visit.type("ContactBeyondRim");
  visit("group", rim.group, "group of the contact");
  visit("obstacle", rim.obstacle, "name of the obstacle");
  visit("time", rim.time, "time when this was found");
  visit("place", rim.position, "position of the pressed node at the border of the group");
  visit("groups", rim.groups, "boundary groups of the facets beyond the group");
}

void describe(SummaryVisitor& visit, PenetrationReport& report) {
  const UnwatchedPenetration* const deepest = report.deepest();
  visit.type("PenetrationReport");
  visit.derived("checked", visit.run().is_recorded(), "false before the first row of the history: nothing is checked");
  visit("looks_at_obstacles", report.obstacle_checks, "number of checks of nodes against obstacles");
  visit("looks_at_bodies", report.body_checks, "number of checks of bodies against each other");
  visit("looks_at_themselves", report.self_penetration_checks, "number of checks of bodies against themselves");
  visit("not_watched", report.not_watched, "omitted checks, in words");
  visit.derived("depth", Real{deepest != nullptr ? deepest->depth : 0.0},
                "depth of the relatively deepest one; 0 if none was found");
  visit.derived("relative_depth", Real{deepest != nullptr ? deepest->relative_depth : 0.0},
                "its depth relative to the body");
  visit("found", report.found, "penetrations for each obstacle, each pair of bodies and each body in itself");
  visit("contact_beyond_rim", report.rims,
        "contacts that have reached the border of their group: a node there is pressed, and a neighbouring facet "
        "outside the group rises from the obstacle with a slope of less than a quarter");
}

void describe(SummaryVisitor& visit, BodyDescription& body) {
  RigidBody& rigid = body.rigid;
  visit.type("Body");
  visit("name", body.name, "name in messages");
  visit("mass", Real{rigid.mass}, "mass; in the plane per unit of thickness");
  visit("centre", Components{rigid.centre}, "centre of mass of the undeformed body");
  visit("moment_of_inertia", Inertia{rigid.inertia}, "about the centre of mass: in the plane a number");
  visit("separation_time", Real{body.separation}, "time for which contact must be lost for an impact to end");
  visit("held", rigid.held, "whether supports at rest leave the body no rigid motion");
}

namespace {

/// Motion at the beginning of the first step in which the force acts, and at the end of the last one.
void describe_motion(SummaryVisitor& visit, RigidMotionState& before, RigidMotionState& after, bool ended) {
  visit("velocity_before", Components{before.velocity}, "velocity of the centre of mass; not relative to the obstacle");
  visit("velocity_after", IfKnown{ended, Components{after.velocity}}, "after the impact");
  visit("spin_before", Spin{before.spin},
        "angular momentum about the centre of mass, solved with the inertia about it, in rad per time: one number in "
        "the plane, positive counter-clockwise, otherwise a right-handed vector");
  visit("spin_after", IfKnown{ended, Spin{after.spin}}, "after the impact");
  visit("kinetic_energy_before", Real{before.kinetic_energy}, "kinetic energy of the whole motion");
  visit("kinetic_energy_after", IfKnown{ended, Real{after.kinetic_energy}}, "after the impact");
  visit("rigid_kinetic_energy_before", Real{before.rigid_kinetic_energy}, "kinetic energy without that of vibrations");
  visit("rigid_kinetic_energy_after", IfKnown{ended, Real{after.rigid_kinetic_energy}}, "after the impact");
}

const RigidBody& rigid_body(SummaryVisitor& visit, int body) {
  const std::vector<BodyDescription>& bodies = visit.run().bodies;
  if (body < 0 || body >= int(bodies.size()))
    throw Json::Exception(fmt::format("an impact refers to body {}, which is not listed", body));
  return bodies[std::size_t(body)].rigid;
}

/// Other body of an impact between two bodies.
struct OpponentOf {
  Impact& impact;
};

void describe(SummaryVisitor& visit, OpponentOf& opponent) {
  Impact& impact = opponent.impact;
  OtherBody& other = impact.other ? *impact.other : impact.other.emplace();
  visit.type("OtherBody");
  visit("body", other.number, "number of the body, an index of `bodies`");
  visit.derived("other_impulse", IfKnown{impact.ended, Components{impact.other_impulse_on_other()}},
                "change of momentum by everything else");
  describe_motion(visit, other.before, other.after, impact.ended);
  if (!visit.reads()) return;
  const RigidBody& rigid = rigid_body(visit, other.number);
  other.mass = rigid.mass;
  other.held = rigid.held;
}

/// Ratio after / before, for both bodies if there are two.
std::optional<double> kinetic_energy_ratio(const Impact& impact) {
  const double before = impact.before.kinetic_energy + (impact.other ? impact.other->before.kinetic_energy : 0.0);
  const double after = impact.after.kinetic_energy + (impact.other ? impact.other->after.kinetic_energy : 0.0);
  return impact.ended && before > 0.0 ? std::optional(after / before) : std::nullopt;
}

void describe_forces(SummaryVisitor& visit, Impact& impact) {
  Eigen::Vector3d normal = impact.normal();
  double normal_impulse = impact.normal_impulse.norm();
  visit("impulse", Components{impact.impulse}, "impulse of all contact forces of this impact on the body");
  visit("normal", Components{normal}, "mean direction of their normal parts, towards the body");
  visit("normal_impulse", Real{normal_impulse}, "size of the impulse of the normal parts");
  if (visit.reads()) impact.normal_impulse = normal_impulse * normal;
  visit.derived("other_impulse", IfKnown{impact.ended, Components{impact.other_impulse()}},
                "change of momentum by everything else");
  visit("largest_force", Real{impact.largest_force}, "largest resultant over a step, friction included");
  visit("largest_force_time", impact.largest_force_time, "its time");
  visit.derived("mean_force", Real{impact.mean_force()}, "size of `impulse` divided by `contact_time`");
  visit("contact_points", impact.contact_points, "largest number of contact points that carried a force at once");
  visit("all_contact_points", impact.all_contact_points, "number of contact points of the body there");
  visit.derived("coarse", impact.is_coarse(),
                "whether at most 3 of more points carried a force at once: the contact zone is too coarse for a "
                "reliable `largest_force` and `duration`");
  visit("first_place", impact.first_position, "reference position of the point that first carried a force");
}

void describe_restitution(SummaryVisitor& visit, Impact& impact) {
  const std::optional<double> restitution = impact.restitution();
  visit.derived("restitution", IfKnown{restitution.has_value(), Real{restitution.value_or(0.0)}},
                "−`normal_velocity_after` / `normal_velocity_before`; null if this does not characterize the impact");
  visit.derived("restitution_inexact", restitution_error(impact).is_large,
                "whether `method_energy` is a large part of the loss");
  visit("method_energy", Real{impact.method_energy}, "energy that the method put into all bodies meanwhile");
  visit("turn_growth", Real{impact.rotation_growth},
        "with the law `linear`: mean speed over the impulse at which a rotating body grows towards the surface");
  visit.derived("restitution_by_turning", Real{restitution_excess(impact)},
                "amount by which the restitution is too large");
  visit.derived("why_no_restitution", IfKnown{!restitution, why_no_restitution(impact)}, "reason why there is none");
}

void describe_velocities(SummaryVisitor& visit, Impact& impact) {
  const bool has_obstacle = !impact.other;
  visit.derived("normal_velocity_before", Real{impact.normal_velocity_before()},
                "velocity along `normal`, relative to the obstacle or other body");
  visit.derived("normal_velocity_after", IfKnown{impact.ended, Real{impact.normal_velocity_after()}},
                "after the impact");
  visit("obstacle_normal_velocity", IfKnown{has_obstacle, Real{impact.obstacle_velocity}},
        "mean velocity of the obstacle's material along `normal`");
  visit("obstacle_sliding_velocity", IfKnown{has_obstacle, Components{impact.obstacle_sliding}},
        "the same across `normal`");
  visit.derived("tangential_velocity_before", Components{impact.tangential_velocity_before()},
                "velocity across `normal`, not relative");
  visit.derived("tangential_velocity_after", IfKnown{impact.ended, Components{impact.tangential_velocity_after()}},
                "after the impact");
}

}  // namespace

void describe(SummaryVisitor& visit, Impact& impact) {
  double duration = impact.end - impact.begin;
  visit.type("Impact");
  visit("body", impact.body, "number of the body, an index of `bodies`; of two that of the `group` of their contact");
  visit("obstacle", IfKnown{!impact.other, impact.obstacle}, "name of the obstacle; null between bodies");
  visit("begin", impact.begin, "half a step before the first instant with a force");
  visit.derived("end", IfKnown{impact.ended, impact.end}, "half a step after the last instant with a force");
  visit("duration", duration, "time from `begin` to the end, or so far");
  if (visit.reads()) impact.end = impact.begin + duration;
  visit("ended", impact.ended, "false if the body still touches at the end of the run");
  visit("from_start", impact.from_start, "whether the body touched when the run began");
  visit("from_inside", impact.from_inside, "whether the body was inside the obstacle when the run began");
  visit("intervals", impact.intervals, "number of intervals of contact that are taken together");
  visit("contact_time", impact.contact_time, "total time of these intervals");
  describe_forces(visit, impact);
  describe_restitution(visit, impact);
  describe_velocities(visit, impact);
  describe_motion(visit, impact.before, impact.after, impact.ended);
  visit.derived("kinetic_energy_ratio",
                IfKnown{kinetic_energy_ratio(impact).has_value(), Real{kinetic_energy_ratio(impact).value_or(0)}},
                "kinetic energy after / before, of both bodies together if there are two; null if there was none");
  if (visit.reads()) {
    const RigidBody& rigid = rigid_body(visit, impact.body);
    impact.mass = rigid.mass;
    impact.held = rigid.held;
  }
  visit.optional("against", impact.other.has_value(), OpponentOf{impact}, "between bodies: the other one");
}

void describe(SummaryVisitor& visit, PairSliding& pair) {
  visit.type("PairSliding");
  visit("contact", pair.contact, "number of the entry of `[[contact]]`");
  visit("slip", Real{pair.slip},
        "motion of one side against the other along the surface since the pairing, at the pressed point where it is "
        "largest relative to its limit; 0 if no point was ever pressed");
  visit("limit", Real{pair.limit}, "half of the smallest facet there, on either side");
  visit("time", pair.time, "time of this slip");
  visit("place", pair.position, "position of the point in the undeformed body");
  visit("time_beyond", IfKnown{std::isfinite(pair.time_beyond), pair.time_beyond},
        "when the slip first exceeded a limit");
}

void describe(SummaryVisitor& visit, RotationReport& rotation) {
  visit.type("Rotation");
  visit("limit", Real{rotation.limit}, "0.1 rad; \"inf\" if the laws hold for any rotation");
  visit("time_beyond", IfKnown{std::isfinite(rotation.time_beyond), rotation.time_beyond},
        "when it was first exceeded");
  visit("until_impact_end", rotation.until_impact_end,
        "largest rotation up to the end of each impact, to one hundredth");
}

void describe(SummaryVisitor& visit, PeakStressDescription& stress) {
  PeakStressResult& peak = stress.peak;
  const bool grows = peak.raised_by != StressRaiser::none;
  std::string raiser = name_of(peak.raised_by);
  visit.type("PeakStress");
  visit("von_mises", Real{peak.von_mises}, "largest von Mises stress, a mean over a cell");
  visit("time", peak.time, "its time");
  visit("step", peak.step, "its step");
  visit("place", stress.position, "centre of its cell in the undeformed body");
  visit("material", stress.material, "group of its material");
  visit("cell", peak.cell, "number of its cell in the files of fields, from 0");
  visit("element", stress.element, "number of its cell in the mesh file");
  visit("states_looked_at", peak.evaluations, "number of states that were evaluated");
  visit("states", peak.states, "number of all states; if more than were evaluated, a peak in between may be higher");
  visit.derived("grows_with_refinement", grows, "whether the value depends on the mesh");
  visit("sits_on", IfKnown{grows, raiser}, "reason for this, or null");
  for (int k = 1; visit.reads() && k < stress_raisers; ++k) {
    if (name_of(static_cast<StressRaiser>(k)) == raiser) peak.raised_by = static_cast<StressRaiser>(k);
  }
}

void describe_results(SummaryVisitor& visit, RunSummary& run) {
  visit("unwatched_penetration", run.penetration, "penetration that no contact prevents");
  visit("distortion_energy", Real{run.distortion_energy},
        "largest artificial energy that has kept cells from being turned inside out; 0: none was needed");
  visit("bodies", run.bodies, "bodies of the mesh, from the mass matrix of the run");
  visit("impacts", run.impacts, "collisions of each body with each obstacle and of each two bodies, by their begin");
  visit("impacts_left_out", run.impacts_left_out, "number of later impacts, which are only counted");
  visit("sliding", run.sliding, "relative sliding of each contact between bodies without `sliding = \"large\"`");
  visit("rotation", IfKnown{run.is_recorded(), run.rotation},
        "when cells had rotated too far for small strain, from the rows of the history; null before the first one");
  visit("peak_stress", run.peak_stress, "largest von Mises stress of the run; null if there is none");
}

}  // namespace ricochet
