#include <fmt/format.h>

#include "ricochet/case/keys_table.hpp"
#include "ricochet/case/names.hpp"
#include "ricochet/io/results_format.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"

// Keys on results: recorded, written, checked and expected quantities.
namespace ricochet {

namespace {

std::vector<std::string> field_choices() {
  std::vector<std::string> names = field_names();
  names.emplace_back("all");
  return names;
}

std::string files_of_values() {
  return any_format([](const ResultsFormat& format) { return format.files.front(); });
}

}  // namespace

Section probe_section() {
  Section section{.name = "probe",
                  .kind = SectionKind::list,
                  .doc =
                      "A quantity to record in columns NAME.… of history.csv: the motion of the node nearest to a "
                      "point or of all nodes along a segment, the force and moment on a boundary, averages and extrema "
                      "of a group, or the resultant of a contact."};
  section.keys = {key("name", &ProbeSection::name, {.required = true},
                      "Prefix of its columns: letters, digits, _ and -; not the name of a standard column.")};
  for (const Registration<ProbeKind>& kind : probe_registry().all()) {
    section.alternatives.push_back(kind.alternatives.front());
    section.keys.insert(section.keys.end(), kind.keys.begin(), kind.keys.end());
  }
  section.keys.push_back(key("every", &ProbeSection::every, {.unit = "steps", .range = {.at_least = 1.0}},
                             "Steps between rows. The probe is then written to probes-EVERY.csv, together with all "
                             "probes of the same interval, instead of history.csv."));
  return section;
}

Section output_section() {
  Section section{.name = "output", .doc = "How often results are written."};
  section.keys = {
      key("fields_every", &OutputSection::fields_every, {.unit = "steps", .range = nonnegative},
          "Steps between field frames; 0 disables them. Default: 10 + steps * dofs / 80000 frames in the run, at most "
          "100, and for large bodies only as many as fit into 200 MB (at least two)."),
      key("fields_interval", &OutputSection::fields_interval, {.unit = "time", .range = positive},
          "Time between field frames, instead of fields_every: a frame is written at the first step at or after each "
          "multiple of it, and at the start and the end."),
      key("fields", &OutputSection::fields, {.choices = field_choices()},
          "The fields that are written (docs/results.md describes them); \"all\" selects every field. Default: "
          "displacement, velocity, the contact fields, and von_mises."),
      key("format", &OutputSection::format, {.default_value = "xdmf", .choices = results_format_registry().names()},
          fmt::format("Format of the field files: {}.",
                      any_format([](const ResultsFormat& format) { return format.description; }, ", or "))),
      key("fields_precision", {is_choice(&OutputSection::single_precision, "single")},
          {.default_value = "double", .choices = {"double", "single"}},
          fmt::format("Precision of the fields in {}: 64 or 32 bits. The mesh always has 64.", files_of_values())),
      key("compression", &OutputSection::compression,
          {.unit = "1", .default_value = "0", .range = {.at_least = 0.0, .at_most = 9.0}},
          fmt::format("zlib level of {}, from 0 (off) to 9. Double precision compresses little, single precision more.",
                      files_of_values())),
      key("history_every", &OutputSection::history_every, {.unit = "steps", .range = {.at_least = 1.0}},
          "Steps between rows of history.csv; the end of the run always has a row. Default: 1, and 2 with the scheme "
          "semi-explicit, whose steps cost little more than a row. Independently of this key, impacts, impulses and "
          "penetration are evaluated in every step, and the largest stress in as many steps as a twentieth of the run "
          "time allows; extrema, rotation and the checks of [check] are evaluated from the rows."),
      key("checkpoint_every", &OutputSection::checkpoint_every,
          {.unit = "steps", .default_value = "0", .range = nonnegative},
          "Steps between checkpoints, from which an interrupted run continues (`run --resume`); 0: by time only. A run "
          "that a signal stops always writes a checkpoint; a run that ends writes one unless this and "
          "`checkpoint_seconds` are both 0."),
      key("checkpoint_seconds", &OutputSection::checkpoint_seconds,
          {.unit = "seconds", .default_value = "300", .range = nonnegative},
          "Wall-clock time between checkpoints; 0: by steps only. For the end and the interruption of a run, see "
          "`checkpoint_every`."),
  };
  return section;
}

Section check_section() {
  const Range small{.at_least = 0.0, .below = 1.0};
  Section section{.name = "check",
                  .doc =
                      "Balances that every run must satisfy: a run that violates its balance of energy or momentum "
                      "warns or stops. summary.json contains the largest residuals under `checks`."};
  section.keys = {
      key("energy_residual", &CheckSection::energy_residual, {.unit = "1", .default_value = "1e-8", .range = small},
          "Allowed energy_residual, relative to the largest energy so far; 0 disables the check."),
      key("momentum", &CheckSection::momentum, {.unit = "1", .default_value = "1e-8", .range = small},
          "Allowed imbalance of momentum (its change minus the impulses of all forces), relative to the largest "
          "momentum and the sum of all impulses; 0 disables the check."),
      key("angular_momentum", &CheckSection::angular_momentum, {.unit = "1", .default_value = "1e-8", .range = small},
          "Allowed imbalance of angular momentum, relative to the scale of `momentum` times the largest distance of a "
          "node from the origin. Not checked with degree 1 on curved cells, whose shape functions contain no "
          "rotations."),
      key("on_failure", {is_choice(&CheckSection::stops, "stop")},
          {.default_value = "warn", .choices = {"warn", "stop"}},
          "\"warn\" warns once per balance; \"stop\" ends the run with status 3."),
  };
  return section;
}

Section expect_section() {
  Section section{.name = "expect",
                  .kind = SectionKind::list,
                  .doc =
                      "A condition that must hold at the end of a run, which makes a case its own regression test: a "
                      "value with a tolerance (relative, absolute or both: the larger one counts), or bounds."};
  section.keys = {
      key("name", &ExpectSection::name, {}, "Description of the quantity, for lists of expectations."),
      key("quantity", &ExpectSection::quantity, {.required = true}, "A number in the results; see Quantities."),
      key("over", &ExpectSection::over, {}, "A quantity by which `quantity` is divided."),
      key("times", &ExpectSection::times, {.unit = "1", .default_value = "1"}, "Factor of `quantity`."),
      key("value", &ExpectSection::value, {.unit = "of the quantity"}, "Expected value."),
      key("relative", &ExpectSection::relative, {.unit = "1", .range = nonnegative},
          "Tolerance as a fraction of `value`."),
      key("absolute", &ExpectSection::absolute, {.unit = "of the quantity", .range = nonnegative},
          "Tolerance as a difference from `value`."),
      key("minimum", &ExpectSection::minimum, {.unit = "of the quantity"}, "Lower bound, instead of `value`."),
      key("maximum", &ExpectSection::maximum, {.unit = "of the quantity"}, "Upper bound, instead of `value`."),
      key("published", &ExpectSection::published, {}, "A published value, such as that of another program, as text."),
      key("when", &ExpectSection::when, {},
          "Key paths and values, as in { \"time.scheme\" = \"midpoint\" }: the condition is checked only in runs that "
          "have all of these values."),
  };
  return section;
}

}  // namespace ricochet
