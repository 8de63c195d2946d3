#include "ricochet/case/keys_table.hpp"
#include "ricochet/case/names.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"

// Keys on results: recorded, written, checked and expected quantities.
namespace ricochet {

namespace {

std::vector<std::string> field_choices() {
  std::vector<std::string> names = field_names();
  names.emplace_back("all");
  return names;
}

}  // namespace

Section probe_section() {
  Section section{
      .name = "probe",
      .kind = SectionKind::list,
      .doc =
          "A quantity to record in columns NAME.… of history.csv: the motion of the node nearest to a point or of all "
          "nodes along a segment, the force and moment on a boundary, averages and extrema of a group, or the "
          "resultant of a contact.",
      .keys = {
          {.name = "name",
           .required = true,
           .doc = "Prefix of its columns: letters, digits, _ and -; not the name of a standard column."},
          {.name = "every",
           .type = KeyType::integer,
           .unit = "steps",
           .range = {.at_least = 1.0},
           .doc = "Steps between rows. The probe is then written to probes-EVERY.csv, together with all probes of the "
                  "same interval, instead of history.csv."},
      }};
  for (const Registration<ProbeKind>& kind : probe_registry().all()) {
    section.alternatives.push_back(kind.alternatives.front());
    section.keys.insert(section.keys.end() - 1, kind.keys.begin(), kind.keys.end());
  }
  return section;
}

Section output_section() {
  return {
      .name = "output",
      .doc = "How often results are written.",
      .keys = {
          {.name = "fields_every",
           .type = KeyType::integer,
           .unit = "steps",
           .range = nonnegative,
           .doc = "Steps between field frames; 0 disables them. Default: 10 + steps * dofs / 80000 frames in the run, "
                  "at most 100, and for large bodies only as many as fit into 200 MB (at least two)."},
          {.name = "fields_interval",
           .type = KeyType::number,
           .unit = "time",
           .range = positive,
           .doc =
               "Time between field frames, instead of fields_every: a frame is written at the first step at or after "
               "each multiple of it, and at the start and the end."},
          {.name = "fields",
           .type = KeyType::names,
           .choices = field_choices(),
           .doc = "The fields that are written (docs/results.md describes them); \"all\" selects every field. Default: "
                  "displacement, velocity, the contact fields, and von_mises."},
          {.name = "format",
           .type = KeyType::choice,
           .default_value = "xdmf",
           .choices = {"xdmf", "vtkhdf"},
           .doc = "Format of the field files: results.h5 with results.xdmf, which ParaView and meshio read, or "
                  "results.vtkhdf, one file with all frames for ParaView 5.12 and later."},
          {.name = "fields_precision",
           .type = KeyType::choice,
           .default_value = "double",
           .choices = {"double", "single"},
           .doc = "Precision of the fields in results.h5 or results.vtkhdf: 64 or 32 bits. The mesh always has 64."},
          {.name = "compression",
           .type = KeyType::integer,
           .unit = "1",
           .default_value = "0",
           .range = {.at_least = 0.0, .at_most = 9.0},
           .doc = "zlib level of results.h5 or results.vtkhdf, from 0 (off) to 9. Double precision compresses little, "
                  "single precision "
                  "more."},
          {.name = "history_every",
           .type = KeyType::integer,
           .unit = "steps",
           .range = {.at_least = 1.0},
           .doc = "Steps between rows of history.csv; the end of the run always has a row. Default: 1, and 2 with the "
                  "scheme semi-explicit, whose steps cost little more than a row. Independently of this key, impacts, "
                  "impulses and penetration are evaluated in every step, and the largest stress in as many steps as a "
                  "twentieth of the run time allows; extrema, rotation and the checks of [check] are evaluated from "
                  "the rows."},
          {.name = "checkpoint_every",
           .type = KeyType::integer,
           .unit = "steps",
           .default_value = "0",
           .range = nonnegative,
           .doc = "Steps between checkpoints, from which an interrupted run continues (`run --resume`); 0: by time "
                  "only. A run that a signal stops always writes a checkpoint; a run that ends writes one unless this "
                  "and `checkpoint_seconds` are both 0."},
          {.name = "checkpoint_seconds",
           .type = KeyType::number,
           .unit = "seconds",
           .default_value = "300",
           .range = nonnegative,
           .doc = "Wall-clock time between checkpoints; 0: by steps only. For the end and the interruption of a run, "
                  "see `checkpoint_every`."},
      }};
}

Section check_section() {
  const Range small{.at_least = 0.0, .below = 1.0};
  return {.name = "check",
          .doc =
              "Balances that every run must satisfy: a run that violates its balance of energy or momentum warns or "
              "stops. summary.json contains the largest residuals under `checks`.",
          .keys = {
              {.name = "energy_residual",
               .type = KeyType::number,
               .unit = "1",
               .default_value = "1e-8",
               .range = small,
               .doc = "Allowed energy_residual, relative to the largest energy so far; 0 disables the check."},
              {.name = "momentum",
               .type = KeyType::number,
               .unit = "1",
               .default_value = "1e-8",
               .range = small,
               .doc = "Allowed imbalance of momentum (its change minus the impulses of all forces), relative to the "
                      "largest momentum and the sum of all impulses; 0 disables the check."},
              {.name = "angular_momentum",
               .type = KeyType::number,
               .unit = "1",
               .default_value = "1e-8",
               .range = small,
               .doc = "Allowed imbalance of angular momentum, relative to the scale of `momentum` times the largest "
                      "distance of a node from the origin. Not checked with degree 1 on curved cells, whose shape "
                      "functions contain no rotations."},
              {.name = "on_failure",
               .type = KeyType::choice,
               .default_value = "warn",
               .choices = {"warn", "stop"},
               .doc = "\"warn\" warns once per balance; \"stop\" ends the run with status 3."},
          }};
}

Section expect_section() {
  return {
      .name = "expect",
      .kind = SectionKind::list,
      .doc =
          "A condition that must hold at the end of a run, which makes a case its own regression test: a value with a "
          "tolerance (relative, absolute or both: the larger one counts), or bounds.",
      .keys = {
          {.name = "name", .doc = "Description of the quantity, for lists of expectations."},
          {.name = "quantity", .required = true, .doc = "A number in the results; see Quantities."},
          {.name = "over", .doc = "A quantity by which `quantity` is divided."},
          {.name = "times", .type = KeyType::number, .unit = "1", .default_value = "1", .doc = "Factor of `quantity`."},
          {.name = "value", .type = KeyType::number, .unit = "of the quantity", .doc = "Expected value."},
          {.name = "relative",
           .type = KeyType::number,
           .unit = "1",
           .range = nonnegative,
           .doc = "Tolerance as a fraction of `value`."},
          {.name = "absolute",
           .type = KeyType::number,
           .unit = "of the quantity",
           .range = nonnegative,
           .doc = "Tolerance as a difference from `value`."},
          {.name = "minimum",
           .type = KeyType::number,
           .unit = "of the quantity",
           .doc = "Lower bound, instead of `value`."},
          {.name = "maximum",
           .type = KeyType::number,
           .unit = "of the quantity",
           .doc = "Upper bound, instead of `value`."},
          {.name = "published", .doc = "A published value, such as that of another program, as text."},
          {.name = "when",
           .type = KeyType::conditions,
           .doc = "Key paths and values, as in { \"time.scheme\" = \"midpoint\" }: the condition is checked only in "
                  "runs that have all of these values."},
      }};
}

}  // namespace ricochet
