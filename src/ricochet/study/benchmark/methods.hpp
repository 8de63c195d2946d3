#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/model/model.hpp"

/// @file Methods that benchmarks are run with: a scheme, and by fixed rules its mass and its step.
namespace ricochet {

/// A method as it is asked for.
struct AskedMethod {
  std::string scheme;
  std::string mass = {};  ///< empty: the first that the scheme takes

  /// "newmark" or "newmark/consistent".
  [[nodiscard]] std::string text() const;
  bool operator==(const AskedMethod&) const = default;
};

/// From "SCHEME,SCHEME/MASS,…", or "all": every scheme there is. Throws Error(usage) that lists schemes or masses.
[[nodiscard]] std::vector<AskedMethod> parse_methods(const std::string& text);

/// What a method becomes with a case.
struct MethodChoice {
  std::string mass;                             ///< empty: the case is refused
  std::vector<std::string> settings = {};       ///< "key.path=value"
  std::map<std::string, std::string> refusals;  ///< why masses were not taken, each in one line

  [[nodiscard]] bool is_refused() const { return mass.empty(); }
};

/// Finds by trial what methods become with one case. The mass is that of the case where the scheme takes it, else the
/// first of equivalent, consistent, lumped and equivalent-lumped that it takes; where the scheme has a limit of
/// stability the step is at most nine tenths of that, and cases that then take more than 50,000 steps are refused;
/// where it needs a preset, it gets the first one. Histories have a row for every step, and no fields are written.
/// Nothing else is changed.
class MethodChooser {
 public:
  explicit MethodChooser(std::string case_path);
  ~MethodChooser();
  MethodChooser(const MethodChooser&) = delete;
  MethodChooser& operator=(const MethodChooser&) = delete;

  /// Says nothing of what is refused or doubtful: that is in what it returns, and told by the run.
  [[nodiscard]] MethodChoice choose(const AskedMethod& method);
  [[nodiscard]] const std::string& scheme_of_case() const { return scheme_of_case_; }

 private:
  /// The settings with this mass. Throws Error where it is not taken.
  [[nodiscard]] std::vector<std::string> settings_with(const std::string& scheme, const std::string& mass);
  /// Built once for each mass. Throws Error, each time, where it cannot be.
  const Model& model_with(const std::string& mass, const Case& input);

  std::string case_path_, scheme_of_case_, mass_of_case_;
  std::map<std::string, std::unique_ptr<Model>> models_;
  std::map<std::string, std::string> problems_;  ///< of masses that have no model
};

/// The first line of a message, without the place that it begins with.
[[nodiscard]] std::string short_reason(const std::string& message);

}  // namespace ricochet
