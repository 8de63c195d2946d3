#include "ricochet/io/summary_results.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/json.hpp"
#include "ricochet/simulation/impact/restitution.hpp"
#include "ricochet/simulation/impact/rotation_growth.hpp"
#include "ricochet/simulation/monitor/stress_raisers.hpp"

namespace ricochet {

namespace {

Json numbers(const std::vector<double>& values) {
  Json result = Json::array();
  for (const double value : values) result.push_back(Json::number(value));
  return result;
}

std::vector<double> to_numbers(const Json& values) {
  std::vector<double> result;
  for (const Json& value : values) result.push_back(value.to_number());
  return result;
}

/// Two components in the plane.
Json components(const Eigen::Vector3d& values, int dimension) {
  Json result = Json::array();
  for (int k = 0; k < dimension; ++k) result.push_back(Json::number(values[k]));
  return result;
}

/// Angular velocity; in the plane its component about z.
Json turning(const Eigen::Vector3d& values, int dimension) {
  return dimension == 2 ? Json::number(values[2]) : components(values, 3);
}

Json bodies_to_json(const RunSummary& summary) {
  Json result = Json::array();
  for (const BodyDescription& body : summary.bodies) {
    Json inertia = Json::number(body.rigid.inertia(2, 2));
    if (summary.dimension == 3) {
      inertia = Json::array();
      for (int k = 0; k < 3; ++k) inertia.push_back(components(body.rigid.inertia.row(k), 3));
    }
    result.push_back({{"name", body.name},
                      {"mass", Json::number(body.rigid.mass)},
                      {"centre", components(body.rigid.centre, summary.dimension)},
                      {"moment_of_inertia", inertia},
                      {"separation_time", Json::number(body.separation)},
                      {"held", body.rigid.held}});
  }
  return result;
}

/// Other body of an impact of two bodies.
Json other_to_json(const Impact& impact, int dimension) {
  const OtherBody& other = *impact.other;
  const auto if_ended = [&](const Json& value) { return impact.ended ? value : Json(); };
  return {{"body", other.number},
          {"other_impulse", if_ended(components(impact.other_impulse_on_other(), dimension))},
          {"velocity_before", components(other.before.velocity, dimension)},
          {"velocity_after", if_ended(components(other.after.velocity, dimension))},
          {"spin_before", turning(other.before.spin, dimension)},
          {"spin_after", if_ended(turning(other.after.spin, dimension))},
          {"kinetic_energy_before", Json::number(other.before.kinetic_energy)},
          {"kinetic_energy_after", if_ended(Json::number(other.after.kinetic_energy))},
          {"rigid_kinetic_energy_before", Json::number(other.before.rigid_kinetic_energy)},
          {"rigid_kinetic_energy_after", if_ended(Json::number(other.after.rigid_kinetic_energy))}};
}

/// Ratio after / before, for both bodies if there are two.
Json kinetic_energy_ratio(const Impact& impact) {
  const double before = impact.before.kinetic_energy + (impact.other ? impact.other->before.kinetic_energy : 0.0);
  const double after = impact.after.kinetic_energy + (impact.other ? impact.other->after.kinetic_energy : 0.0);
  return impact.ended && before > 0.0 ? Json::number(after / before) : Json();
}

Json impact_to_json(const Impact& impact, int dimension) {
  // Unknown or non-existent values are null.
  const auto if_ended = [&](const Json& value) { return impact.ended ? value : Json(); };
  const auto of_obstacle = [&](const Json& value) { return impact.other ? Json() : value; };
  const std::optional<double> restitution = impact.restitution();
  Json result = {{"body", impact.body},
                 {"obstacle", of_obstacle(impact.obstacle)},
                 {"begin", Json::number(impact.begin)},
                 {"end", if_ended(Json::number(impact.end))},
                 {"duration", Json::number(impact.end - impact.begin)},
                 {"ended", impact.ended},
                 {"from_start", impact.from_start},
                 {"from_inside", impact.from_inside},
                 {"intervals", impact.intervals},
                 {"contact_time", Json::number(impact.contact_time)},
                 {"impulse", components(impact.impulse, dimension)},
                 {"normal", components(impact.normal(), dimension)},
                 {"normal_impulse", Json::number(impact.normal_impulse.norm())},
                 {"other_impulse", if_ended(components(impact.other_impulse(), dimension))},
                 {"largest_force", Json::number(impact.largest_force)},
                 {"largest_force_time", Json::number(impact.largest_force_time)},
                 {"mean_force", Json::number(impact.mean_force())},
                 {"contact_points", impact.contact_points},
                 {"all_contact_points", impact.all_contact_points},
                 {"coarse", impact.is_coarse()},
                 {"first_place", numbers(impact.first_position)},
                 {"restitution", restitution ? Json::number(*restitution) : Json()},
                 {"restitution_inexact", restitution_error(impact).is_large},
                 {"method_energy", impact.method_energy ? Json::number(*impact.method_energy) : Json()},
                 {"turn_growth", Json::number(impact.rotation_growth)},
                 {"restitution_by_turning", Json::number(restitution_excess(impact))},
                 {"why_no_restitution", restitution ? Json() : Json(why_no_restitution(impact))},
                 {"normal_velocity_before", Json::number(impact.normal_velocity_before())},
                 {"normal_velocity_after", if_ended(Json::number(impact.normal_velocity_after()))},
                 {"obstacle_normal_velocity", of_obstacle(Json::number(impact.obstacle_velocity))},
                 {"obstacle_sliding_velocity", of_obstacle(components(impact.obstacle_sliding, dimension))},
                 {"tangential_velocity_before", components(impact.tangential_velocity_before(), dimension)},
                 {"tangential_velocity_after", if_ended(components(impact.tangential_velocity_after(), dimension))},
                 {"velocity_before", components(impact.before.velocity, dimension)},
                 {"velocity_after", if_ended(components(impact.after.velocity, dimension))},
                 {"spin_before", turning(impact.before.spin, dimension)},
                 {"spin_after", if_ended(turning(impact.after.spin, dimension))},
                 {"kinetic_energy_before", Json::number(impact.before.kinetic_energy)},
                 {"kinetic_energy_after", if_ended(Json::number(impact.after.kinetic_energy))},
                 {"rigid_kinetic_energy_before", Json::number(impact.before.rigid_kinetic_energy)},
                 {"rigid_kinetic_energy_after", if_ended(Json::number(impact.after.rigid_kinetic_energy))},
                 {"kinetic_energy_ratio", kinetic_energy_ratio(impact)}};
  if (impact.other) result["against"] = other_to_json(impact, dimension);
  return result;
}

Json impacts_to_json(const RunSummary& summary) {
  Json result = Json::array();
  for (const Impact& impact : summary.impacts) result.push_back(impact_to_json(impact, summary.dimension));
  return result;
}

Json found_to_json(const UnwatchedPenetration& p) {
  return {{"obstacle", p.obstacle.empty() ? Json() : Json(p.obstacle)},
          {"bodies", p.bodies},
          {"depth", Json::number(p.depth)},
          {"relative_depth", Json::number(p.relative_depth)},
          {"time", Json::number(p.time)},
          {"place", numbers(p.position)},
          {"first_time", Json::number(p.first_time)},
          {"groups", p.groups},
          {"contact", p.contact.empty() ? Json() : Json(p.contact)},
          {"passed_through", p.passed_through},
          {"through_groups", p.through_groups}};
}

/// Writes the deepest penetration separately, so that it has a path (summary.unwatched_penetration.depth), then all.
Json penetration_to_json(const PenetrationReport& report) {
  Json found = Json::array(), rims = Json::array();
  for (const UnwatchedPenetration& p : report.found) found.push_back(found_to_json(p));
  for (const ContactBeyondRim& rim : report.rims) {
    rims.push_back({{"group", rim.group},
                    {"obstacle", rim.obstacle},
                    {"time", Json::number(rim.time)},
                    {"place", numbers(rim.position)},
                    {"groups", rim.groups}});
  }
  const UnwatchedPenetration* deepest = report.deepest();
  return {{"checked", report.checked},
          {"looks_at_obstacles", report.obstacle_checks},
          {"looks_at_bodies", report.body_checks},
          {"looks_at_themselves", report.self_penetration_checks},
          {"not_watched", report.not_watched},
          {"depth", Json::number(deepest != nullptr ? deepest->depth : 0.0)},
          {"relative_depth", Json::number(deepest != nullptr ? deepest->relative_depth : 0.0)},
          {"found", found},
          {"contact_beyond_rim", rims}};
}

Json sliding_to_json(const RunSummary& summary) {
  Json result = Json::array();
  for (const PairSliding& pair : summary.sliding) {
    result.push_back({{"contact", pair.contact},
                      {"slip", Json::number(pair.slip)},
                      {"limit", Json::number(pair.limit)},
                      {"time", Json::number(pair.time)},
                      {"place", numbers(pair.position)},
                      {"time_beyond", std::isfinite(pair.time_beyond) ? Json::number(pair.time_beyond) : Json()}});
  }
  return result;
}

Json rotation_to_json(const RunSummary& summary) {
  if (!summary.rotation) return {};
  const RotationReport& rotation = *summary.rotation;
  return {{"limit", Json::number(rotation.limit)},
          {"time_beyond", std::isfinite(rotation.time_beyond) ? Json::number(rotation.time_beyond) : Json()},
          {"until_impact_end", numbers(rotation.until_impact_end)}};
}

Json peak_stress_to_json(const RunSummary& summary) {
  if (!summary.peak_stress) return {};
  const PeakStressDescription& d = *summary.peak_stress;
  return {{"von_mises", Json::number(d.peak.von_mises)},
          {"time", Json::number(d.peak.time)},
          {"step", d.peak.step},
          {"place", numbers(d.position)},
          {"material", d.material},
          {"cell", d.peak.cell},
          {"element", d.element},
          {"states_looked_at", d.peak.evaluations},
          {"states", d.peak.states},
          {"grows_with_refinement", d.peak.raised_by != StressRaiser::none},
          {"sits_on", d.peak.raised_by != StressRaiser::none ? Json(name_of(d.peak.raised_by)) : Json()}};
}

Eigen::Vector3d vector_from(const Json& values) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < values.size() && k < 3; ++k) result[static_cast<Index>(k)] = values.at(k).to_number();
  return result;
}

RigidMotionState motion_from(const Json& impact, const std::string& when) {
  const Json& spin = impact.at("spin_" + when);
  return {vector_from(impact.at("velocity_" + when)),
          spin.is_array() ? vector_from(spin) : Eigen::Vector3d(0.0, 0.0, spin.to_number()),
          impact.at("kinetic_energy_" + when).to_number(), impact.at("rigid_kinetic_energy_" + when).to_number()};
}

const RigidBody& rigid_body(int body, const std::vector<BodyDescription>& bodies, const std::string& path) {
  if (body < 0 || body >= static_cast<int>(bodies.size()))
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("{}: not a summary of a run: an impact refers to body {}, which is not listed", path, body));
  return bodies[static_cast<std::size_t>(body)].rigid;
}

OtherBody other_from(const Json& json, bool ended, const std::vector<BodyDescription>& bodies,
                     const std::string& path) {
  OtherBody other;
  other.number = json.at("body");
  const RigidBody& rigid = rigid_body(other.number, bodies, path);
  other.mass = rigid.mass;
  other.held = rigid.held;
  other.before = motion_from(json, "before");
  if (ended) other.after = motion_from(json, "after");
  return other;
}

Impact impact_from(const Json& json, const std::vector<BodyDescription>& bodies, const std::string& path) {
  Impact impact;
  impact.body = json.at("body");
  if (json.at("obstacle").is_string()) impact.obstacle = json.at("obstacle");
  impact.begin = json.at("begin").to_number();
  impact.end = impact.begin + json.at("duration").to_number();
  impact.ended = json.at("ended");
  impact.from_start = json.at("from_start");
  impact.from_inside = json.value("from_inside", false);
  impact.intervals = json.at("intervals");
  impact.contact_time = json.at("contact_time").to_number();
  impact.impulse = vector_from(json.at("impulse"));
  impact.normal_impulse = json.at("normal_impulse").to_number() * vector_from(json.at("normal"));
  impact.largest_force = json.at("largest_force").to_number();
  impact.largest_force_time = json.at("largest_force_time").to_number();
  impact.contact_points = json.value("contact_points", 0L);
  impact.all_contact_points = json.value("all_contact_points", 0L);
  impact.first_position = to_numbers(json.value("first_place", Json::array()));
  const Json method_energy = json.value("method_energy", Json());
  if (method_energy.is_number() || method_energy.is_string()) impact.method_energy = method_energy.to_number();
  impact.rotation_growth = json.value("turn_growth", Json(0.0)).to_number();
  const RigidBody& rigid = rigid_body(impact.body, bodies, path);
  impact.mass = rigid.mass;
  impact.held = rigid.held;
  if (json.contains("against")) {
    impact.other = other_from(json.at("against"), impact.ended, bodies, path);
  } else {
    impact.obstacle_velocity = json.at("obstacle_normal_velocity").to_number();
    impact.obstacle_sliding = vector_from(json.value("obstacle_sliding_velocity", Json::array()));
  }
  impact.before = motion_from(json, "before");
  if (impact.ended) impact.after = motion_from(json, "after");
  return impact;
}

BodyDescription body_from(const Json& json) {
  BodyDescription body;
  body.rigid.mass = json.at("mass").to_number();
  body.rigid.centre = vector_from(json.at("centre"));
  const Json& inertia = json.at("moment_of_inertia");
  if (!inertia.is_array()) body.rigid.inertia(2, 2) = inertia.to_number();
  for (std::size_t k = 0; inertia.is_array() && k < 3; ++k)
    body.rigid.inertia.row(static_cast<Index>(k)) = vector_from(inertia.at(k));
  body.separation = json.at("separation_time").to_number();
  body.rigid.held = json.value("held", false);
  body.name = json.value("name", "");
  return body;
}

PenetrationReport penetration_from(const Json& json) {
  PenetrationReport report{json.at("checked"), json.at("looks_at_obstacles"), json.at("looks_at_bodies")};
  for (const Json& p : json.at("found")) {
    report.found.push_back({p.at("obstacle").is_string() ? p.at("obstacle").get<std::string>() : "",
                            p.at("bodies"),
                            p.at("depth").to_number(),
                            p.at("relative_depth").to_number(),
                            p.at("time").to_number(),
                            to_numbers(p.at("place")),
                            p.at("first_time").to_number(),
                            p.at("groups"),
                            {}});
    if (p.contains("contact") && p.at("contact").is_array()) report.found.back().contact = p.at("contact");
    if (p.contains("passed_through")) report.found.back().passed_through = p.at("passed_through");
    if (p.contains("through_groups")) report.found.back().through_groups = p.at("through_groups");
  }
  for (const Json& rim : json.at("contact_beyond_rim"))
    report.rims.push_back({rim.at("group"), rim.at("obstacle"), rim.at("time").to_number(), to_numbers(rim.at("place")),
                           rim.at("groups")});
  report.self_penetration_checks = json.value("looks_at_themselves", 0L);
  report.not_watched = json.value("not_watched", std::vector<std::string>{bodies_in_themselves});
  return report;
}

PairSliding sliding_from(const Json& json) {
  PairSliding pair;
  pair.contact = json.at("contact");
  pair.slip = json.at("slip").to_number();
  pair.limit = json.at("limit").to_number();
  pair.time = json.at("time").to_number();
  pair.position = to_numbers(json.at("place"));
  if (json.at("time_beyond").is_number()) pair.time_beyond = json.at("time_beyond").to_number();
  return pair;
}

RotationReport rotation_from(const Json& json) {
  RotationReport result;
  result.limit = json.at("limit").to_number();
  if (json.at("time_beyond").is_number()) result.time_beyond = json.at("time_beyond").to_number();
  result.until_impact_end = to_numbers(json.at("until_impact_end"));
  return result;
}

StressRaiser raiser_named(const Json& name) {
  for (int k = 1; k < stress_raisers && name.is_string(); ++k) {
    const auto raiser = static_cast<StressRaiser>(k);
    if (name_of(raiser) == name.get<std::string>()) return raiser;
  }
  return StressRaiser::none;
}

PeakStressDescription peak_stress_from(const Json& json) {
  PeakStressDescription result;
  result.peak = {json.at("von_mises").to_number(),
                 json.at("time").to_number(),
                 json.at("step"),
                 json.at("cell"),
                 json.at("states_looked_at"),
                 json.at("states"),
                 raiser_named(json.value("sits_on", Json()))};
  result.position = to_numbers(json.at("place"));
  result.element = json.at("element");
  result.material = json.at("material");
  return result;
}

}  // namespace

Json summary_results_to_json(const RunSummary& summary) {
  return {{"unwatched_penetration", penetration_to_json(summary.penetration)},
          {"bodies", bodies_to_json(summary)},
          {"impacts", impacts_to_json(summary)},
          {"impacts_left_out", summary.impacts_left_out},
          {"sliding", sliding_to_json(summary)},
          {"rotation", rotation_to_json(summary)},
          {"peak_stress", peak_stress_to_json(summary)}};
}

void read_summary_results(const Json& json, const std::string& path, RunSummary& summary) {
  if (json.contains("unwatched_penetration")) summary.penetration = penetration_from(json.at("unwatched_penetration"));
  for (const Json& body : json.value("bodies", Json::array())) summary.bodies.push_back(body_from(body));
  for (const Json& impact : json.value("impacts", Json::array()))
    summary.impacts.push_back(impact_from(impact, summary.bodies, path));
  for (const Json& pair : json.value("sliding", Json::array())) summary.sliding.push_back(sliding_from(pair));
  summary.impacts_left_out = json.value("impacts_left_out", 0L);
  if (json.contains("rotation") && json.at("rotation").is_object())
    summary.rotation = rotation_from(json.at("rotation"));
  if (json.contains("peak_stress") && json.at("peak_stress").is_object())
    summary.peak_stress = peak_stress_from(json.at("peak_stress"));
}

}  // namespace ricochet
