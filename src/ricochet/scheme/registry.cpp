#include <fmt/format.h>

#include <functional>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/scheme/scheme.hpp"

namespace ricochet {

// The schemes: a name as written in a case file and the constructor that its own file defines. One line each.
// clang-format off
#define RICOCHET_SCHEMES(scheme)                \
  scheme("midpoint", make_midpoint)             \
  scheme("klr-conserving", make_klr_conserving) \
  scheme("newmark", make_newmark)               \
  scheme("semi-explicit", make_semi_explicit)
// clang-format on

#define RICOCHET_DECLARE(name, make) std::unique_ptr<Scheme> make(const SchemeParameters&);
RICOCHET_SCHEMES(RICOCHET_DECLARE)
#undef RICOCHET_DECLARE

namespace {

struct Registration {
  std::string name;
  std::function<std::unique_ptr<Scheme>(const SchemeParameters&)> make;
};

const std::vector<Registration>& registrations() {
#define RICOCHET_REGISTER(name, make) {name, make},
  static const std::vector<Registration> all{RICOCHET_SCHEMES(RICOCHET_REGISTER)};
#undef RICOCHET_REGISTER
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
