#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/model/model.hpp"

/// @file Methods of benchmarks: a scheme and, by fixed rules, its mass and its step.
namespace ricochet {

/// A method as requested.
struct RequestedMethod {
  std::string scheme;
  std::string mass = {};  ///< empty: the first mass that the scheme accepts

  /// Returns "newmark" or "newmark/consistent".
  [[nodiscard]] std::string text() const;
  bool operator==(const RequestedMethod&) const = default;
};

/// Parses "SCHEME,SCHEME/MASS,…", or "all" for every scheme. Throws Error(usage) that lists schemes or masses.
[[nodiscard]] std::vector<RequestedMethod> parse_methods(const std::string& text);

/// Mass and settings of a method for a case.
struct MethodChoice {
  std::string mass;                             ///< empty if the case is refused
  std::vector<std::string> settings = {};       ///< "key.path=value"
  std::map<std::string, std::string> refusals;  ///< reason, in one line, for each mass that was not accepted

  [[nodiscard]] bool is_refused() const { return mass.empty(); }
};

/// Finds by trial the mass and settings of methods for one case. The mass is that of the case if the scheme accepts it,
/// else the first of equivalent, consistent, lumped and equivalent-lumped that it accepts. If the scheme has a limit of
/// stability, the step is at most nine tenths of it, and cases that then need more than 50,000 steps are refused. A
/// scheme that needs a preset gets the first one. Histories have a row for every step, and no fields are written.
/// Nothing else is changed.
class MethodChooser {
 public:
  explicit MethodChooser(std::string case_path);
  ~MethodChooser();
  MethodChooser(const MethodChooser&) = delete;
  MethodChooser& operator=(const MethodChooser&) = delete;

  /// Makes a choice without messages: refusals are in the result, and the run issues the warnings.
  [[nodiscard]] MethodChoice choose(const RequestedMethod& method);
  [[nodiscard]] const std::string& scheme_of_case() const { return scheme_of_case_; }

 private:
  /// Returns the settings with this mass. Throws Error if the mass is not accepted.
  [[nodiscard]] std::vector<std::string> settings_with(const std::string& scheme, const std::string& mass);
  /// Returns the model with this mass, built once for each mass. Throws Error, each time, if it cannot be built.
  const Model& model_with(const std::string& mass, const Case& input);

  std::string case_path_, scheme_of_case_, mass_of_case_;
  std::map<std::string, std::unique_ptr<Model>> models_;
  std::map<std::string, std::string> problems_;  ///< errors of masses without a model
};

/// Returns the first line of a message, without the location at its start.
[[nodiscard]] std::string short_reason(const std::string& message);

}  // namespace ricochet
