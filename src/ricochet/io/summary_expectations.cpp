#include "ricochet/io/summary_expectations.hpp"

#include <array>
#include <string>
#include <utility>

namespace ricochet {

namespace {

/// Entries that exist only if the case specifies them.
const std::array<std::pair<std::string, std::optional<double> ExpectationResult::*>, 4> optional_numbers{
    {{"wanted_value", &ExpectationResult::expected_value},
     {"tolerance", &ExpectationResult::tolerance},
     {"minimum", &ExpectationResult::minimum},
     {"maximum", &ExpectationResult::maximum}}};

}  // namespace

Json expectations_to_json(const std::vector<ExpectationResult>& expectations) {
  Json result = Json::array();
  for (const ExpectationResult& e : expectations) {
    Json entry = {{"name", e.name},
                  {"quantity", e.quantity},
                  {"published", e.published},
                  {"value", Json::number(e.value)},
                  {"wanted", e.expected}};
    for (const auto& [name, member] : optional_numbers) {
      if (const std::optional<double> number = e.*member) entry[name] = *number;
    }
    entry.update({{"location", e.location}, {"checked", e.checked}, {"holds", e.holds}, {"note", e.note}});
    result.push_back(entry);
  }
  return result;
}

std::vector<ExpectationResult> read_expectations(const Json& summary) {
  std::vector<ExpectationResult> result;
  const Json entries = summary.value("expectations", Json::array());
  for (const Json& entry : entries) {
    ExpectationResult e{.name = entry.value("name", ""),
                        .quantity = entry.at("quantity"),
                        .published = entry.value("published", ""),
                        .value = entry.at("value").to_number(),
                        .expected = entry.at("wanted"),
                        .location = entry.at("location"),
                        .checked = entry.at("checked"),
                        .holds = entry.at("holds"),
                        .note = entry.at("note")};
    for (const auto& [name, member] : optional_numbers) {
      if (entry.contains(name)) e.*member = entry.at(name).get<double>();
    }
    result.push_back(std::move(e));
  }
  return result;
}

}  // namespace ricochet
