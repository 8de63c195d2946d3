#include "ricochet/case/read_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/rounded.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/names.hpp"
#include "ricochet/case/quantity.hpp"
#include "ricochet/case/read_bodies.hpp"
#include "ricochet/case/section_reader.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"
#include "ricochet/simulation/step_control.hpp"

namespace ricochet {

using namespace std::string_view_literals;

namespace {

void check_material(const SectionReader& reader, MaterialSection& material) {
  if (!reader.is_usable("relaxation")) return;
  const SectionReader relaxation = reader.tables("relaxation").front();
  if (!relaxation.is_usable("modulus") || !relaxation.is_usable("time")) return;
  const std::size_t moduli = material.relaxation.modulus.size(), times = material.relaxation.time.size();
  if (moduli != times) {
    relaxation.add_problem(
        "time", fmt::format("\"modulus\" and \"time\" must have one entry for each branch, but have {} and {} entries",
                            moduli, times));
  }
}

/// Refuses two keys with the same meaning.
void refuse_both(const SectionReader& reader, const char* key, const char* other) {
  if (reader.is_given(key) && reader.is_given(other))
    reader.add_problem(key, fmt::format("the obstacle already has \"{}\": remove \"{}\"", other, key));
}

void check_motion(const SectionReader& reader) {
  refuse_both(reader, "motion", "velocity");
  for (const char* const key : {"velocity", "motion", "rotation"}) refuse_both(reader, "table", key);
  if (reader.is_given("about") && !reader.is_given("rotation") && !reader.is_given("table"))
    reader.add_problem("about", "\"about\" is the centre of a rotation: set \"rotation\", or remove \"about\"");
}

void check_free_body(const SectionReader& reader) {
  refuse_both(reader, "density", "mass");
  const bool is_free = reader.is_given("mass") || reader.is_given("density");
  const auto only = [&](bool allowed, const char* key, const char* reason) {
    if (!allowed && reader.is_given(key)) reader.add_problem(key, fmt::format("\"{}\" {}", key, reason));
  };
  for (const char* const key : {"inertia", "centre_of_mass", "spin", "force", "torque", "spring", "damper",
                                "rotation_spring", "rotation_damper", "hold"})
    only(is_free, key, "requires a rigid body that moves under the forces on it: set its \"mass\" or \"density\", too");
  for (const char* const key : {"motion", "rotation", "table"})
    only(!is_free, key, "prescribes a motion; an obstacle with a mass or density moves under the forces on it");
  only(!is_free, "rotation_rate",
       "prescribes a motion; an obstacle with a mass or density moves under the forces on it; for a driven roller that "
       "a force presses, set \"spin\", a large \"inertia\" (a flywheel) and \"force\"");
}

void check_obstacle(const SectionReader& reader, ObstacleSection& obstacle) {
  obstacle.name = reader.name();
  if (obstacle.parameters.has("file")) obstacle.parameters.set("file", reader.path(obstacle.parameters.text("file")));
  check_motion(reader);
  reader.fill<FreeBodySection>(obstacle);
  check_free_body(reader);
}

void check_contact(const SectionReader& reader, ContactSection& contact) {
  if (constexpr double unusual = 2.0; contact.friction > unusual)
    reader.add_warning("friction",
                       fmt::format("the coefficient of friction {:g} is unusually large; it is not per cent: 30 % is "
                                   "0.3",
                                   contact.friction));
  if (!reader.is_usable("multipliers") && contact.between_bodies()) contact.multipliers = "p1";
  if (contact.is_of_all_pairs() && !reader.is_given("sliding")) contact.large_sliding = true;
  for (const char* const key : {"friction", "friction_bound", "multipliers", "initial_gap", "pair_at", "sliding"}) {
    if (!contact.tied || !reader.is_given(key)) continue;
    reader.add_problem(
        key,
        fmt::format("\"{}\" is only for surfaces that may separate or slide; these are tied: remove this key", key));
  }
  for (const char* const key : {"multipliers_on", "initial_gap", "pair_at", "sliding", "tied"}) {
    const bool is_of_two = key == "multipliers_on"sv || key == "pair_at"sv || key == "tied"sv;
    if (!reader.is_given(key) || reader.is_given("against") || (contact.is_of_all_pairs() && !is_of_two)) continue;
    reader.add_problem(key, fmt::format("\"{}\" is only for contact between {}; set \"against\", or remove this key",
                                        key, contact.is_of_all_pairs() ? "two groups" : "bodies"));
  }
  if (contact.large_sliding && reader.is_given("pair_at"))
    reader.add_problem("pair_at",
                       "\"pair_at\" is only for small sliding, which keeps its pairs; with sliding = \"large\" they "
                       "follow the motion: remove \"pair_at\"");
  if (contact.large_sliding && contact.multipliers != "p1" && contact.multipliers != "p0")
    reader.add_problem(
        "multipliers",
        fmt::format("multipliers \"{}\" are not possible with sliding = \"large\", where facets are covered in part "
                    "and by different facets in every step; use \"p1\", or \"p0\" with a displacement of degree 2",
                    contact.multipliers));
  if (reader.is_usable("against") && contact.against == contact.group && !contact.large_sliding) {
    reader.add_problem("against",
                       fmt::format("\"against\" is \"{}\", the group itself: a surface can touch itself only with "
                                   "sliding = \"large\"; set this, or name a group of another body",
                                   contact.against));
  }
  if (contact.large_sliding && contact.against == contact.group && reader.is_given("multipliers_on"))
    reader.add_problem("multipliers_on",
                       "a surface that touches itself has no sides: the points that carry the multipliers are selected "
                       "where it touches; remove \"multipliers_on\"");
}

void check_obstacle_name(const SectionReader& reader, const char* key, const std::vector<std::string>& obstacles) {
  const std::string name = reader.text(key);
  if (!reader.is_usable(key) || std::ranges::find(obstacles, name) != obstacles.end()) return;
  const std::string near = nearest_name(name, obstacles);
  reader.add_problem(key,
                     fmt::format("there is no [obstacle.{}]; {}", name,
                                 !near.empty()       ? fmt::format("did you mean \"{}\"?", near)
                                 : obstacles.empty() ? "the case has no obstacles"
                                                     : fmt::format("the obstacles are {}", join_names(obstacles))));
}

// Refuses the same text under the same key in two entries of a list; with `together`, only if the values of that key
// agree as well.
void check_distinct(const std::vector<SectionReader>& readers, const std::string& section, const std::string& name,
                    const std::string& together = "") {
  for (std::size_t i = 0; i < readers.size(); ++i) {
    if (!readers[i].is_usable(name)) continue;
    for (std::size_t j = 0; j < i; ++j) {
      if (!readers[j].is_usable(name) || readers[j].value(name) != readers[i].value(name)) continue;
      if (!together.empty() && readers[i].is_usable(together) && readers[j].is_usable(together) &&
          readers[i].value(together) != readers[j].value(together)) {
        continue;
      }
      readers[i].add_problem(name, fmt::format("the {} \"{}\" is already in another [[{}]], at {}", name,
                                               readers[i].value(name), section, readers[j].where(name).text()));
      break;
    }
  }
}

/// Refuses the keys of adaptive steps for other steps.
void check_adaptive_steps(const SectionReader& reader, TimeSection& time) {
  if (!time.adaptive) {
    time.tolerance = time.smallest = 0.0;
    for (const char* const key : {"tolerance", "largest", "smallest"}) {
      if (!reader.is_given(key) || !reader.is_usable("step")) continue;
      if (reader.is_override("step") && !reader.is_override(key)) {
        reader.add_info(key, fmt::format("\"{}\" is ignored: it is only for adaptive steps", key));
      } else {
        reader.add_problem(key, fmt::format("\"{}\" is only for adaptive steps; write step = \"adaptive\"", key));
      }
    }
    return;
  }
  if (!reader.is_usable("tolerance")) time.tolerance = 1e-3;
  if (!reader.is_given("largest")) {
    reader.add_problem("step",
                       "adaptive steps require \"largest\", the largest length: at most the time between two rows that "
                       "you want to see");
    return;
  }
  time.step = reader.number("largest");
  if (!reader.is_usable("smallest")) time.smallest = std::ldexp(time.step, -20);
  if (reader.is_usable("largest") && reader.is_usable("smallest") && time.smallest > time.step)
    reader.add_problem("smallest", fmt::format("\"smallest\" is {}, above \"largest\", {}", time.smallest, time.step));
}

/// Operators contain 1/h² and h²: both must be normal double numbers.
bool has_square(double step) {
  constexpr double largest_factor = 16.0;  // largest factor of 1/h² in a scheme
  return std::isnormal(step * step) && std::isnormal(largest_factor / (step * step));
}

/// Time must be an exact whole number of shortest steps. Requires usable entries.
void check_smallest(const SectionReader& reader, const TimeSection& time) {
  if (!reader.is_given("smallest") || !reader.is_usable("smallest") || time.smallest > time.step) return;
  const double levels =
      std::min(std::floor(std::log2(StepControl::most_ticks * (time.step / time.end))), 1.0 * StepControl::most_levels);
  const double least = std::ldexp(time.step, -int(levels));
  if (time.smallest >= least * (1.0 - 1e-9)) return;
  reader.add_problem("smallest",
                     fmt::format("\"smallest\" is {}, too short compared with \"largest\", {}, and \"end\", {}: times "
                                 "are whole multiples of it and would lose digits; set at least {:.2g}, or remove it",
                                 time.smallest, time.step, time.end, rounded_up(least, 2)));
}

void check_time(const SectionReader& reader, TimeSection& time) {
  constexpr double most_steps = 1e9;
  check_adaptive_steps(reader, time);
  const char* const step = time.adaptive ? "largest" : "step";
  if (!reader.is_usable(step) || !reader.is_usable("end") || time.step == 0.0) return;
  if (!has_square(time.step)) {
    reader.add_problem(step, fmt::format("\"{}\" is {}: its square is outside the range of floating-point numbers; "
                                         "choose a unit of time in which steps are closer to 1",
                                         step, time.step));
  } else if (!time.adaptive && time.end < time.step) {
    reader.add_problem("end",
                       fmt::format("\"end\" is {}, before the end of the first step of {}", time.end, time.step));
  } else if (time.end / time.step > most_steps) {
    reader.add_problem(step,
                       fmt::format("a step of {} up to the end {} results in {:.3g} steps; at most {:.0e} are possible",
                                   time.step, time.end, time.end / time.step, most_steps));
  } else if (time.adaptive) {
    check_smallest(reader, time);
  }
}

void check_probe(const SectionReader& reader, ProbeSection& probe) {
  if (const auto* const kind = find_probe_kind([&](const std::string& key) { return reader.is_given(key); })) {
    probe.kind = kind->name;
    probe.values = reader.parameters(kind->keys);
  }
  for (const Registration<ProbeKind>& other : probe_registry().all()) {
    const std::vector<std::string>& needed = other.alternatives.front();
    for (const Key& key : other.keys) {
      if (std::ranges::find(needed, key.name) == needed.end() && reader.is_given(key.name) &&
          !reader.is_given(needed.front()))
        reader.add_problem(key.name, fmt::format("\"{}\" is for probes with \"{}\" only", key.name, needed.front()));
    }
  }
  const std::vector<std::string> columns = reserved_probe_names();
  if (reader.is_usable("name") && !is_plain_name(probe.name)) {
    reader.add_problem("name", fmt::format("the name \"{}\" can only contain letters, digits, _ and -", probe.name));
  } else if (std::ranges::find(columns, probe.name) != columns.end()) {
    reader.add_problem("name",
                       fmt::format("the name \"{}\" is already that of a standard column of history.csv", probe.name));
  }
}

void check_expectation(const SectionReader& reader, ExpectSection& expectation) {
  const bool has_value = reader.is_given("value");
  const bool has_tolerance = reader.is_given("relative") || reader.is_given("absolute");
  const bool has_bounds = reader.is_given("minimum") || reader.is_given("maximum");
  if (has_value && has_bounds) {
    reader.add_problem("value", "[[expect]] has either \"value\" or bounds (\"minimum\", \"maximum\"), not both");
  } else if (has_value && !has_tolerance) {
    reader.add_problem("value", "\"value\" needs a tolerance: \"relative\", \"absolute\" or both");
  } else if (!has_value && has_tolerance) {
    const std::string name = reader.is_given("relative") ? "relative" : "absolute";
    reader.add_problem(name, fmt::format("\"{}\" is a tolerance of \"value\", which is missing", name));
  } else if (!has_value && !has_bounds) {
    reader.add_problem("",
                       "[[expect]] expects nothing: set \"value\" with \"relative\" or \"absolute\", or bounds "
                       "(\"minimum\", \"maximum\")");
  }
  if (expectation.minimum && expectation.maximum && *expectation.minimum > *expectation.maximum) {
    reader.add_problem("minimum", fmt::format("\"minimum\" is {}, above \"maximum\", which is {}", *expectation.minimum,
                                              *expectation.maximum));
  }
  for (const std::string key : {"quantity", "over"}) {
    if (!reader.is_given(key) || !reader.is_usable(key)) continue;
    try {
      static_cast<void>(parse_quantity(reader.text(key)));
    } catch (const Error& problem) {
      reader.add_problem(key, problem.what());
    }
  }
}

void read_obstacles_and_contacts(const TomlNode& root, const Sections& sections, Case& result) {
  const TomlNode* obstacles = root.find("obstacle");
  std::vector<std::string> names;  // including refused ones: a contact that names one is not a separate problem
  if (obstacles != nullptr) {
    for (const TomlNode& obstacle : obstacles->children) names.push_back(obstacle.key);
  }
  sections.read("obstacle", result.obstacles, check_obstacle);
  const auto check_name = [&](const SectionReader& reader, const char* key) {
    if (obstacles == nullptr || !obstacles->is_refused) check_obstacle_name(reader, key, names);
  };
  sections.read("contact", result.contacts, [&](const SectionReader& reader, ContactSection& contact) {
    check_contact(reader, contact);
    check_name(reader, "obstacle");
  });
  for (const SectionReader& reader : sections.all("part")) check_name(reader, "rest_on");
  check_name(sections.one("mesh"), "rest_on");
  std::vector<SectionReader> of_kind[3];
  for (const SectionReader& reader : sections.all("contact"))
    of_kind[reader.is_given("obstacle") ? 0 : reader.is_given("against") ? 1 : 2].push_back(reader);
  check_distinct(of_kind[0], "contact", "group", "obstacle");
  check_distinct(of_kind[1], "contact", "group", "against");
  check_distinct(of_kind[2], "contact", "group");
}

}  // namespace

void read_sections(const TomlNode& root, Case& result, Problems& problems) {
  const Sections sections(root, result, problems);
  SectionReader(case_sections().front().keys, root, result, problems).fill(result);
  read_bodies(sections, result);
  sections.read("material", result.materials, check_material);
  check_distinct(sections.all("material"), "material", "group");
  read_obstacles_and_contacts(root, sections, result);
  sections.read("support", result.supports);
  sections.read("traction", result.tractions);
  sections.read("pressure", result.pressures);
  sections.one("load").fill(result.load);
  sections.one("initial").fill(result.initial);
  read_motions(sections, result);
  sections.one("mass").fill(result.mass);
  sections.one("time").fill(result.time);
  check_time(sections.one("time"), result.time);
  sections.read("probe", result.probes, check_probe);
  check_distinct(sections.all("probe"), "probe", "name");
  sections.one("solver").fill(result.solver);
  sections.one("output").fill(result.output);
  sections.one("check").fill(result.check);
  if (result.output.fields_every && result.output.fields_interval) {
    sections.one("output").add_problem("fields_interval",
                                       "\"fields_every\" and \"fields_interval\" exclude each other: use one of them");
  }
  sections.read("expect", result.expectations, check_expectation);
}

}  // namespace ricochet
