#include <fmt/format.h>

#include <functional>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/scheme/scheme.hpp"

namespace ricochet {

// One constructor per file of this folder.
std::unique_ptr<Scheme> make_midpoint(const SchemeParameters&);
std::unique_ptr<Scheme> make_klr_conserving(const SchemeParameters&);
std::unique_ptr<Scheme> make_newmark(const SchemeParameters&);

namespace {

struct Registration {
  std::string name;
  std::function<std::unique_ptr<Scheme>(const SchemeParameters&)> make;
};

const std::vector<Registration>& registrations() {
  static const std::vector<Registration> all{
      {"midpoint", make_midpoint},
      {"klr-conserving", make_klr_conserving},
      {"newmark", make_newmark},
  };
  return all;
}

}  // namespace

std::vector<std::string> scheme_names() {
  std::vector<std::string> names;
  for (const Registration& entry : registrations()) names.push_back(entry.name);
  return names;
}

std::unique_ptr<Scheme> make_scheme(const SchemeParameters& parameters) {
  for (const Registration& entry : registrations()) {
    if (entry.name == parameters.name) return entry.make(parameters);
  }
  throw Error(ErrorKind::invalid_input,
              fmt::format("unknown scheme \"{}\"; known: {}", parameters.name, join_names(scheme_names())));
}

void Scheme::energy_state(const State& state, Vector& displacement, Vector& velocity) const {
  displacement = state.displacement;
  velocity = state.velocity;
}

}  // namespace ricochet
