#include "ricochet/scheme/newmark_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

/// Named pair of values of beta and gamma.
struct Preset {
  std::string name;
  double beta, gamma;
};
const std::array<Preset, 2> presets{{{"trapezoidal", 0.25, 0.5}, {"textbook-half", 0.5, 0.5}}};

const Preset& find_preset(const std::string& name) {
  return *std::ranges::find_if(presets, [&](const Preset& preset) { return preset.name == name; });
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets) names.push_back(preset.name);
  return names;
}

/// Returns whether either beta and gamma or a preset are given; otherwise adds a problem.
bool is_complete(const ParameterCheck& check) {
  const bool has_preset = check.is_given("preset");
  for (const std::string name : {"beta", "gamma"}) {
    if (has_preset && check.is_given(name) && check.is_override(name) == check.is_override("preset")) {
      check.add_problem(
          "preset",
          fmt::format(
              "\"preset\" and \"{}\" are given together: \"preset\" sets beta and gamma, remove one or the other",
              name));
      return false;
    }
    if (!has_preset && !check.is_given(name)) {
      std::vector<std::string> texts;
      for (const Preset& preset : presets)
        texts.push_back(fmt::format("\"{}\" (beta = {}, gamma = {})", preset.name, preset.beta, preset.gamma));
      check.add_problem("scheme", fmt::format("the scheme \"newmark\" needs \"beta\" and \"gamma\", or a \"preset\": "
                                              "{}; \"{}\" is missing",
                                              join_names(texts, " or ", false), name));
      return false;
    }
  }
  return true;
}

/// Chooses between a preset and a given beta or gamma: the one from --set takes precedence.
void choose(const ParameterCheck& check, const std::string& name, double of_preset, Parameters& values) {
  const bool own_counts = check.is_usable(name) && check.is_override(name);
  if (check.is_usable(name)) {
    const std::string loser = own_counts ? "preset" : name, winner = own_counts ? name : "preset";
    check.add_info(loser, fmt::format("\"{}\" is overridden by {}", loser, check.location(winner)));
  }
  if (own_counts) {
    values.erase("preset");
  } else {
    values.set(name, of_preset);
  }
}

}  // namespace

std::vector<Key> newmark_keys() {
  return {
      number_key("beta", "1", {.range = positive}, "Newmark's beta, textbook definition."),
      number_key("gamma", "1", {.range = nonnegative}, "Newmark's gamma, textbook definition; unstable below 1/2."),
      choice_key("preset", preset_names(), {},
                 "Instead of beta and gamma: \"trapezoidal\" is beta = 1/4, gamma = 1/2; \"textbook-half\" is beta = "
                 "gamma = 1/2.")};
}

void check_newmark(const ParameterCheck& check, Parameters& values) {
  if (!is_complete(check)) return;
  if (check.is_usable("preset")) {
    const Preset& preset = find_preset(values.text("preset"));
    choose(check, "beta", preset.beta, values);
    choose(check, "gamma", preset.gamma, values);
  }
  if (!values.has("beta") || !values.has("gamma")) return;  // refused
  const double beta = values.number("beta"), gamma = values.number("gamma");
  const std::string at = check.is_given("gamma") ? "gamma" : "preset";
  if (gamma < 0.5) {
    check.add_warning(at, fmt::format("Newmark's scheme is unstable with gamma = {} (below 1/2)", gamma));
  } else if (2.0 * beta < gamma) {
    check.add_warning(at, fmt::format("Newmark's scheme is only conditionally stable with beta = {}, gamma = {} "
                                      "(2 beta < gamma): the step must be small enough, and "
                                      "prescribed displacements of nodes with inertia diverge at any step",
                                      beta, gamma));
  }
}

JumpResponse newmark_jump_response(const NewmarkParameters& parameters) {
  const auto [beta, gamma] = parameters;
  if (gamma < 0.5 || 2.0 * beta < gamma || (gamma == 0.5 && beta == 0.25)) return JumpResponse::unstable;
  return gamma == 0.5 || 2.0 * beta == gamma ? JumpResponse::undamped : JumpResponse::damped;
}

NewmarkParameters newmark_parameters(const Parameters& values) {
  if (values.has("beta") || !values.has("preset")) return {values.number("beta"), values.number("gamma")};
  const Preset& preset = find_preset(values.text("preset"));
  return {preset.beta, preset.gamma};
}

}  // namespace ricochet
