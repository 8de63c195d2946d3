#include "ricochet/study/benchmark/methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <regex>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/scheme/scheme.hpp"

namespace ricochet {

namespace {

/// Ratio of the step to the largest stable one.
constexpr double part_of_critical_step = 0.9;
/// Steps of a run; more would take minutes without further insight.
constexpr long most_steps = 50'000;

void require_known(const std::string& noun, const std::string& name, const std::vector<std::string>& known) {
  if (std::ranges::count(known, name) > 0) return;
  const std::string meant = nearest_name(name, known);
  throw Error(ErrorKind::usage, fmt::format("--scheme: there is no {} \"{}\"{}; available: {}", noun, name,
                                            meant.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", meant),
                                            join_names(known, " and ", false)));
}

RequestedMethod parse_method(const std::string& text) {
  const std::size_t slash = text.find('/');
  RequestedMethod method{text.substr(0, slash), slash == std::string::npos ? "" : text.substr(slash + 1)};
  require_known("scheme", method.scheme, scheme_names());
  if (slash != std::string::npos) require_known("mass", method.mass, mass_names());
  return method;
}

/// Returns the setting of a preset for a scheme that needs one.
std::vector<std::string> preset_setting(const std::string& scheme) {
  for (const Key& key : scheme_registry().find(scheme).keys) {
    if (key.name == "preset" && !key.choices.empty()) return {fmt::format("time.preset=\"{}\"", key.choices.front())};
  }
  return {};
}

/// Returns the masses in the order in which they are tried.
std::vector<std::string> masses_to_try(const RequestedMethod& method, const std::string& mass_of_case) {
  if (!method.mass.empty()) return {method.mass};
  std::vector<std::string> masses{mass_of_case};
  for (const char* mass : {"equivalent", "consistent", "lumped", "equivalent-lumped"}) {
    if (mass != mass_of_case) masses.emplace_back(mass);
  }
  return masses;
}

}  // namespace

std::string RequestedMethod::text() const { return mass.empty() ? scheme : scheme + "/" + mass; }

std::vector<RequestedMethod> parse_methods(const std::string& text) {
  std::vector<RequestedMethod> methods;
  if (text == "all") {
    for (const std::string& scheme : scheme_names()) methods.push_back({scheme});
    return methods;
  }
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    RequestedMethod method = parse_method(text.substr(begin, comma - begin));
    if (std::ranges::count(methods, method) == 0) methods.push_back(std::move(method));
    begin = comma + 1;
  }
  return methods;
}

std::string short_reason(const std::string& message) {
  static const std::regex prefix(R"(^(--set [^:]*|[^:\s]*):(\d+:\d+:)?\s*)");
  return std::regex_replace(message.substr(0, message.find('\n')), prefix, "", std::regex_constants::format_first_only);
}

MethodChooser::MethodChooser(std::string case_path) : case_path_(std::move(case_path)) {
  const log::Silence silence;
  const Case input = read_case(case_path_);
  scheme_of_case_ = input.time.scheme;
  mass_of_case_ = input.mass.type;
}

MethodChooser::~MethodChooser() = default;

MethodChoice MethodChooser::choose(const RequestedMethod& method) {
  const log::Silence silence;
  MethodChoice chosen;
  for (const std::string& mass : masses_to_try(method, mass_of_case_)) {
    try {
      chosen.settings = settings_with(method.scheme, mass);
      chosen.mass = mass;
      return chosen;
    } catch (const Error& problem) {
      chosen.refusals[mass] = short_reason(problem.what());
    }
  }
  return chosen;
}

std::vector<std::string> MethodChooser::settings_with(const std::string& scheme_name, const std::string& mass) {
  std::vector<std::string> settings{fmt::format("time.scheme=\"{}\"", scheme_name),
                                    fmt::format("mass.type=\"{}\"", mass)};
  for (const std::string& setting : preset_setting(scheme_name)) settings.push_back(setting);
  settings.insert(settings.end(), {"output.history_every=1", "output.fields_every=0"});
  const Case input = read_case(case_path_, settings);
  const SemidiscreteProblem& problem = model_with(mass, input).problem;
  std::unique_ptr<Scheme> scheme = make_scheme(input.time);
  const std::optional<double> limit = scheme->stability_limit(problem);
  if (limit && part_of_critical_step * *limit < input.time.step) {
    settings.push_back(fmt::format("time.step={:.6g}", part_of_critical_step * *limit));
    const TimeSection shortened = read_case(case_path_, settings).time;
    if (step_count(shortened) > most_steps)
      throw Error(ErrorKind::invalid_input, "omitted: a stable time step would require more than 50,000 steps");
    scheme = make_scheme(shortened);
  }
  scheme->analyse(problem);
  return settings;
}

const Model& MethodChooser::model_with(const std::string& mass, const Case& input) {
  if (const auto known = problems_.find(mass); known != problems_.end())
    throw Error(ErrorKind::invalid_input, known->second);
  std::unique_ptr<Model>& model = models_[mass];
  if (model != nullptr) return *model;
  try {
    model = build_model(input);
  } catch (const Error& problem) {
    problems_[mass] = problem.what();
    throw;
  }
  return *model;
}

}  // namespace ricochet
