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
#include "ricochet/case/read_obstacle.hpp"
#include "ricochet/case/section_reader.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"
#include "ricochet/simulation/step_control.hpp"

namespace ricochet {

using namespace std::string_view_literals;

namespace {

// Readers of all entries of a list of sections; one reader for a plain section; none for refused entries.
class Sections {
 public:
  Sections(const TomlNode& root, Problems& problems) : root_(root), problems_(problems) {}

  [[nodiscard]] SectionReader one(const std::string& name) const {
    static const TomlNode absent;
    const TomlNode* node = root_.find(name);
    return {find_section(name)->keys, node != nullptr && node->is_table() ? *node : absent, problems_};
  }
  [[nodiscard]] std::vector<SectionReader> all(const std::string& name) const {
    std::vector<SectionReader> readers;
    const TomlNode* node = root_.find(name);
    if (node == nullptr || node->is_refused) return readers;
    for (const TomlNode& entry : node->children) {
      if (!entry.is_refused) readers.emplace_back(find_section(name)->keys, entry, problems_);
    }
    return readers;
  }

 private:
  const TomlNode& root_;
  Problems& problems_;
};

MaterialSection read_material(const SectionReader& reader, Case& result) {
  MaterialSection material;
  material.group = reader.groups("group", result.group_lists);
  material.density = reader.number("density");
  material.law = reader.text("law");
  material.dilatation = reader.text("dilatation");
  material.parameters = reader.type_parameters(*find_section("material"));
  const SectionReader damping = reader.table("damping");
  material.damping.mass = damping.number("mass");
  material.damping.stiffness = damping.number("stiffness");
  if (!reader.is_usable("relaxation")) return material;
  const SectionReader relaxation = reader.table("relaxation");
  material.relaxation = {relaxation.vector("modulus"), relaxation.vector("time")};
  if (!relaxation.is_usable("modulus") || !relaxation.is_usable("time")) return material;
  const std::size_t moduli = material.relaxation.modulus.size(), times = material.relaxation.time.size();
  if (moduli != times) {
    relaxation.add_problem(
        "time", fmt::format("\"modulus\" and \"time\" must have one entry for each branch, but have {} and {} entries",
                            moduli, times));
  }
  return material;
}

ContactSection read_contact(const SectionReader& reader, Case& result) {
  ContactSection contact;
  contact.group = reader.groups("group", result.group_lists);
  contact.obstacle = reader.text("obstacle");
  contact.against = reader.groups("against", result.group_lists);
  contact.friction = reader.number("friction");
  if (constexpr double unusual = 2.0; contact.friction > unusual)
    reader.add_warning("friction",
                       fmt::format("the coefficient of friction {:g} is unusually large; it is not per cent: 30 % is "
                                   "0.3",
                                   contact.friction));
  contact.friction_bound = reader.number("friction_bound");
  contact.multipliers = reader.text("multipliers");
  if (contact.multipliers.empty()) contact.multipliers = contact.between_bodies() ? "p1" : "nodal";
  contact.multipliers_on = reader.text("multipliers_on");
  contact.closed_gaps = reader.text("initial_gap") == "closed";
  contact.large_sliding =
      reader.text("sliding") == "large" || (contact.is_of_all_pairs() && !reader.is_given("sliding"));
  contact.pair_at = reader.vector("pair_at");
  contact.tied = reader.flag("tied");
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
  contact.allow_unstable_multipliers = reader.text("unstable_multipliers") == "allow";
  return contact;
}

void check_obstacle_name(const SectionReader& reader, const char* key, const std::vector<std::string>& obstacles) {
  const std::string name = reader.text(key);
  if (!reader.is_usable(key) || std::find(obstacles.begin(), obstacles.end(), name) != obstacles.end()) return;
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
void read_adaptive_steps(const SectionReader& reader, TimeSection& time) {
  time.adaptive = reader.is_usable("step") && reader.text("step") == adaptive_steps;
  if (!time.adaptive) {
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
  time.tolerance = reader.optional_number("tolerance").value_or(1e-3);
  if (!reader.is_given("largest")) {
    reader.add_problem("step",
                       "adaptive steps require \"largest\", the largest length: at most the time between two rows that "
                       "you want to see");
    return;
  }
  time.step = reader.number("largest");
  time.smallest = reader.optional_number("smallest").value_or(std::ldexp(time.step, -20));
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
  const double least = std::ldexp(time.step, -static_cast<int>(levels));
  if (time.smallest >= least * (1.0 - 1e-9)) return;
  reader.add_problem("smallest",
                     fmt::format("\"smallest\" is {}, too short compared with \"largest\", {}, and \"end\", {}: times "
                                 "are whole multiples of it and would lose digits; set at least {:.2g}, or remove it",
                                 time.smallest, time.step, time.end, rounded_up(least, 2)));
}

TimeSection read_time(const SectionReader& reader) {
  constexpr double most_steps = 1e9;
  TimeSection time;
  time.scheme = reader.text("scheme");
  time.parameters = reader.type_parameters(*find_section("time"));
  read_adaptive_steps(reader, time);
  if (!time.adaptive) time.step = reader.number("step");
  time.end = reader.number("end");
  const char* const step = time.adaptive ? "largest" : "step";
  if (!reader.is_usable(step) || !reader.is_usable("end") || time.step == 0.0) return time;
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
  return time;
}

SupportSection read_support(const SectionReader& reader, Case& result) {
  SupportSection support;
  support.group = reader.groups("group", result.group_lists);
  support.components = reader.choice_numbers("components");
  support.value = reader.formula("value");
  return support;
}

InitialSection read_initial(const SectionReader& reader) {
  InitialSection initial;
  initial.static_equilibrium = reader.text("displacement") == "static";
  initial.displacement = reader.formulas("displacement");
  initial.velocity = reader.formulas("velocity");
  return initial;
}

ProbeSection read_probe(const SectionReader& reader, Case& result) {
  ProbeSection probe;
  probe.name = reader.text("name");
  probe.every = reader.optional_integer("every").value_or(0);
  const auto* const kind = find_probe_kind([&](const std::string& key) { return reader.is_given(key); });
  if (kind != nullptr) {
    probe.kind = kind->name;
    probe.values = reader.parameters(kind->keys, result.group_lists);
  }
  for (const Registration<ProbeKind>& other : probe_registry().all()) {
    for (const Key& key : other.keys) {
      const std::string& first = other.alternatives.front().front();
      const auto& needed = other.alternatives.front();
      if (std::find(needed.begin(), needed.end(), key.name) == needed.end() && reader.is_given(key.name) &&
          !reader.is_given(first))
        reader.add_problem(key.name, fmt::format("\"{}\" is for probes with \"{}\" only", key.name, first));
    }
  }
  const std::vector<std::string> columns = reserved_probe_names();
  if (reader.is_usable("name") && !is_plain_name(probe.name)) {
    reader.add_problem("name", fmt::format("the name \"{}\" can only contain letters, digits, _ and -", probe.name));
  } else if (std::find(columns.begin(), columns.end(), probe.name) != columns.end()) {
    reader.add_problem("name",
                       fmt::format("the name \"{}\" is already that of a standard column of history.csv", probe.name));
  }
  return probe;
}

void check_expectation(const SectionReader& reader) {
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
  if (reader.is_usable("minimum") && reader.is_usable("maximum") &&
      reader.number("minimum") > reader.number("maximum")) {
    reader.add_problem("minimum", fmt::format("\"minimum\" is {}, above \"maximum\", which is {}",
                                              reader.number("minimum"), reader.number("maximum")));
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

ExpectSection read_expectation(const SectionReader& reader) {
  ExpectSection expectation;
  expectation.name = reader.text("name");
  expectation.quantity = reader.text("quantity");
  expectation.over = reader.text("over");
  expectation.times = reader.number("times");
  expectation.value = reader.number("value");
  expectation.relative = reader.optional_number("relative");
  expectation.absolute = reader.optional_number("absolute");
  expectation.minimum = reader.optional_number("minimum");
  expectation.maximum = reader.optional_number("maximum");
  expectation.published = reader.text("published");
  expectation.when = reader.conditions("when");
  check_expectation(reader);
  return expectation;
}

void read_obstacles_and_contacts(const TomlNode& root, const Sections& sections, Case& result) {
  const TomlNode* obstacles = root.find("obstacle");
  std::vector<std::string> names;  // including refused ones: a contact that names one is not a separate problem
  if (obstacles != nullptr) {
    for (const TomlNode& obstacle : obstacles->children) names.push_back(obstacle.key);
  }
  for (const SectionReader& reader : sections.all("obstacle"))
    result.obstacles.push_back(read_obstacle(reader, result.path));
  const std::vector<SectionReader> contacts = sections.all("contact");
  for (const SectionReader& reader : contacts) {
    result.contacts.push_back(read_contact(reader, result));
    if (obstacles == nullptr || !obstacles->is_refused) check_obstacle_name(reader, "obstacle", names);
  }
  std::vector<SectionReader> bodies = sections.all("part");
  bodies.push_back(sections.one("mesh"));
  for (const SectionReader& reader : bodies) {
    if (obstacles == nullptr || !obstacles->is_refused) check_obstacle_name(reader, "rest_on", names);
  }
  std::vector<SectionReader> of_kind[3];
  for (const SectionReader& reader : contacts)
    of_kind[reader.is_given("obstacle") ? 0 : reader.is_given("against") ? 1 : 2].push_back(reader);
  check_distinct(of_kind[0], "contact", "group", "obstacle");
  check_distinct(of_kind[1], "contact", "group", "against");
  check_distinct(of_kind[2], "contact", "group");
}

}  // namespace

void read_sections(const TomlNode& root, Case& result, Problems& problems) {
  const Sections sections(root, problems);
  result.title = SectionReader(case_sections().front().keys, root, problems).text("title");
  result.mesh = read_mesh(sections.one("mesh"), result.path);
  for (const SectionReader& reader : sections.all("part")) result.parts.push_back(read_part(reader, result.path));
  for (const SectionReader& reader : sections.all("material"))
    result.materials.push_back(read_material(reader, result));
  check_distinct(sections.all("material"), "material", "group");
  read_obstacles_and_contacts(root, sections, result);
  for (const SectionReader& reader : sections.all("support")) result.supports.push_back(read_support(reader, result));
  for (const SectionReader& reader : sections.all("traction")) {
    result.tractions.push_back({reader.groups("group", result.group_lists), reader.formulas("value")});
  }
  for (const SectionReader& reader : sections.all("pressure"))
    result.pressures.push_back({reader.groups("group", result.group_lists), reader.formula("value")});
  const SectionReader load = sections.one("load");
  result.load = {load.vector("gravity"), load.formulas("body_force")};
  result.initial = read_initial(sections.one("initial"));
  read_motions(sections.one("mesh"), sections.all("part"), sections.all("motion"), result);
  const SectionReader mass = sections.one("mass");
  result.mass = {mass.text("type"), mass.type_parameters(*find_section("mass"))};
  result.time = read_time(sections.one("time"));
  for (const SectionReader& reader : sections.all("probe")) result.probes.push_back(read_probe(reader, result));
  check_distinct(sections.all("probe"), "probe", "name");
  const SectionReader solver = sections.one("solver");
  result.solver = {solver.text("method"), solver.number("tolerance"), solver.optional_number("memory"),
                   solver.text("preconditioner"), solver.text("contact_points")};
  const SectionReader output = sections.one("output");
  result.output = {.fields_every = output.optional_integer("fields_every"),
                   .fields_interval = output.optional_number("fields_interval"),
                   .fields = output.chosen("fields"),
                   .vtkhdf = output.text("format") == "vtkhdf",
                   .single_precision = output.text("fields_precision") == "single",
                   .compression = static_cast<int>(output.integer("compression")),
                   .history_every = output.optional_integer("history_every"),
                   .checkpoint_every = output.integer("checkpoint_every"),
                   .checkpoint_seconds = output.number("checkpoint_seconds")};
  const SectionReader check = sections.one("check");
  result.check = {check.number("energy_residual"), check.number("momentum"), check.number("angular_momentum"),
                  check.text("on_failure") == "stop"};
  if (result.output.fields_every && result.output.fields_interval) {
    output.add_problem("fields_interval",
                       "\"fields_every\" and \"fields_interval\" exclude each other: use one of them");
  }
  for (const SectionReader& reader : sections.all("expect")) result.expectations.push_back(read_expectation(reader));
}

}  // namespace ricochet
