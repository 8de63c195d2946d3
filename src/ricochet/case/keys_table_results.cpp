#include "ricochet/case/keys_table.hpp"
#include "ricochet/case/names.hpp"

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
  return {
      .name = "probe",
      .kind = SectionKind::list,
      .alternatives = {{"at"}, {"from", "to"}, {"boundary"}, {"group"}, {"contact"}},
      .doc =
          "A quantity to record in columns NAME.… of history.csv: the motion of the node nearest to a point or of all "
          "nodes along a segment, the force and moment on a boundary, averages and extrema of a group, or the "
          "resultant of a contact.",
      .keys = {
          {.name = "name",
           .required = true,
           .doc = "Prefix of its columns: letters, digits, _ and -; not the name of a standard column."},
          {.name = "at",
           .type = KeyType::vector,
           .unit = "length",
           .doc = "A point: the probe uses the nearest node and reports its distance. Columns NAME.displacement_x …, "
                  "velocity_x …, and on a contact boundary gap, pressure, reaction_normal, reaction_tangential_x …. If "
                  "nodes of two bodies in contact coincide there, it uses the node on the side with the multipliers."},
          {.name = "from",
           .type = KeyType::vector,
           .unit = "length",
           .doc = "One end of a segment. All nodes along it, numbered from this end, have the columns of a point: "
                  "NAME.0.displacement_x and so on."},
          {.name = "to", .type = KeyType::vector, .unit = "length", .doc = "The other end of the segment."},
          {.name = "within",
           .type = KeyType::number,
           .unit = "length",
           .range = positive,
           .doc = "Nodes within this distance of the segment belong to it. Default: 1e-6 of the body's size."},
          {.name = "boundary",
           .type = KeyType::groups,
           .doc = "Group of boundary facets, or a list of groups. Columns: force and moment on the body at its nodes, "
                  "from supports and contacts together (prescribed loads are not included), NAME.force_x …, "
                  "NAME.moment_z, in 3D NAME.moment_x …; and from the supports alone, NAME.support_x …, "
                  "NAME.support_moment_z, in 3D NAME.support_moment_x …"},
          {.name = "about",
           .type = KeyType::vector,
           .unit = "length",
           .doc = "Reference point of the moment on a boundary, in the reference configuration. Default: the origin."},
          {.name = "group",
           .type = KeyType::groups,
           .doc = "Group of cells or of boundary facets, or a list of groups. Columns NAME.displacement_average_x …, "
                  "_minimum_, _maximum_, the same for the velocity, and for cells von_mises_average, _minimum, "
                  "_maximum. Averages are over volume or area."},
          {.name = "contact",
           .type = KeyType::integer,
           .unit = "1",
           .range = nonnegative,
           .doc = "Number of an entry of [[contact]], counted from 0. Columns: its force on the body NAME.force_x … "
                  "(between bodies, on the body of its \"group\"), its centre of pressure NAME.centre_x … (0 while it "
                  "is open) and its area in contact NAME.area (a length in 2D)."},
          {.name = "every",
           .type = KeyType::integer,
           .unit = "steps",
           .range = {.at_least = 1.0},
           .doc = "Steps between rows. The probe is then written to probes-EVERY.csv, together with all probes of the "
                  "same "
                  "interval, instead of history.csv."},
      }};
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
