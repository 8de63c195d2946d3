#include "ricochet/io/penetration_json.hpp"

#include <nlohmann/json.hpp>

namespace ricochet {

using Json = nlohmann::ordered_json;

namespace {

Json to_json(const UnwatchedPenetration& p) {
  return {{"obstacle", p.obstacle.empty() ? Json() : Json(p.obstacle)},
          {"bodies", p.bodies},
          {"depth", p.depth},
          {"relative_depth", p.relative_depth},
          {"time", p.time},
          {"place", p.place},
          {"first_time", p.first_time},
          {"groups", p.groups}};
}

Json to_json(const ContactBeyondRim& rim) {
  return {{"group", rim.group},
          {"obstacle", rim.obstacle},
          {"time", rim.time},
          {"place", rim.place},
          {"groups", rim.groups}};
}

}  // namespace

Json to_json(const PenetrationReport& report) {
  Json found = Json::array(), rims = Json::array();
  for (const UnwatchedPenetration& p : report.found) found.push_back(to_json(p));
  for (const ContactBeyondRim& rim : report.rims) rims.push_back(to_json(rim));
  const UnwatchedPenetration* deepest = report.deepest();
  return {{"checked", report.checked},
          {"looks_at_obstacles", report.looks_at_obstacles},
          {"looks_at_bodies", report.looks_at_bodies},
          {"depth", deepest != nullptr ? deepest->depth : 0.0},
          {"relative_depth", deepest != nullptr ? deepest->relative_depth : 0.0},
          {"found", found},
          {"contact_beyond_rim", rims}};
}

PenetrationReport penetration_report_from_json(const Json& json) {
  PenetrationReport report{json.at("checked"), json.at("looks_at_obstacles"), json.at("looks_at_bodies")};
  for (const Json& p : json.at("found")) {
    report.found.push_back({p.at("obstacle").is_string() ? p.at("obstacle").get<std::string>() : "", p.at("bodies"),
                            p.at("depth"), p.at("relative_depth"), p.at("time"), p.at("place"), p.at("first_time"),
                            p.at("groups")});
  }
  for (const Json& rim : json.at("contact_beyond_rim"))
    report.rims.push_back({rim.at("group"), rim.at("obstacle"), rim.at("time"), rim.at("place"), rim.at("groups")});
  return report;
}

}  // namespace ricochet
