#include "ricochet/case/keys_table.hpp"
#include "ricochet/case/names.hpp"

// The part of the table that is about results: what is watched, written, kept and expected.
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
          "What is watched, in columns NAME.… of history.csv: the node nearest to a point, all nodes along a "
          "segment, the force and moment on a boundary, averages and extrema of a group, or the resultant of a "
          "contact.",
      .keys = {
          {.name = "name",
           .required = true,
           .doc = "Prefix of its columns: letters, digits, _ and -; not the name of a standard column."},
          {.name = "at",
           .type = KeyType::vector,
           .unit = "length",
           .doc = "A point: the nearest node is taken, and its distance reported. Columns NAME.displacement_x …, "
                  "velocity_x …, and on a contact boundary gap, pressure, reaction_normal, reaction_tangential_x …"},
          {.name = "from",
           .type = KeyType::vector,
           .unit = "length",
           .doc = "One end of a segment: all nodes along it, from this end on, have the columns of a point, as "
                  "NAME.0.displacement_x and so on."},
          {.name = "to", .type = KeyType::vector, .unit = "length", .doc = "The other end of the segment."},
          {.name = "within",
           .type = KeyType::number,
           .unit = "length",
           .range = positive,
           .doc = "Of a segment: nodes up to this distance from it belong to it; absent: 1e-6 of the body's size."},
          {.name = "boundary",
           .type = KeyType::groups,
           .doc = "Group of boundary facets, or a list of them: force and moment on the body of supports and "
                  "obstacles at its nodes (given loads are not counted). Columns NAME.force_x …, NAME.moment_z, in 3D "
                  "NAME.moment_x …"},
          {.name = "about",
           .type = KeyType::vector,
           .unit = "length",
           .doc = "Point that the moment of a boundary is about, in the reference configuration; absent: the "
                  "origin."},
          {.name = "group",
           .type = KeyType::groups,
           .doc = "Group of cells or of boundary facets, or a list of them: columns "
                  "NAME.displacement_average_x …, _minimum_, _maximum_, the same of the velocity, and of cells "
                  "von_mises_average, _minimum, _maximum. Averages are over volume or area."},
          {.name = "contact",
           .type = KeyType::integer,
           .unit = "1",
           .range = nonnegative,
           .doc = "Number of an entry of [[contact]], the first is 0: its force on the body NAME.force_x …, centre of "
                  "pressure NAME.centre_x … (0 where it is open) and area in contact NAME.area (in 2D a length)."},
          {.name = "every",
           .type = KeyType::integer,
           .unit = "steps",
           .range = {.at_least = 1.0},
           .doc = "Instead of history.csv: rows each so many steps in probes-EVERY.csv, with all probes of the same "
                  "interval."},
      }};
}

Section output_section() {
  return {.name = "output",
          .doc = "How often results are written.",
          .keys = {
              {.name = "fields_every",
               .type = KeyType::integer,
               .unit = "steps",
               .range = nonnegative,
               .doc = "Fields are written each so many steps; 0: never; absent: 10 + steps * dofs / 80000 "
                      "times in the run, but at most 100 times."},
              {.name = "fields_interval",
               .type = KeyType::number,
               .unit = "time",
               .range = positive,
               .doc = "Instead of fields_every: fields are written at the first step at or after each multiple of this "
                      "time, and at the start and the end."},
              {.name = "fields",
               .type = KeyType::names,
               .choices = field_choices(),
               .doc = "The fields that are written (docs/results.md describes them); \"all\" stands for all. Default: "
                      "displacement, velocity, those of contact, and von_mises."},
              {.name = "fields_precision",
               .type = KeyType::choice,
               .standard = "double",
               .choices = {"double", "single"},
               .doc = "Of the numbers in results.h5: 64 or 32 bits. The mesh always has 64."},
              {.name = "compression",
               .type = KeyType::integer,
               .unit = "1",
               .standard = "0",
               .range = {.at_least = 0.0, .at_most = 9.0},
               .doc = "Of results.h5: 0 none, 1 fast, 9 small. Full precision compresses little, single more."},
              {.name = "history_every",
               .type = KeyType::integer,
               .unit = "steps",
               .standard = "1",
               .range = {.at_least = 1.0},
               .doc = "A row of history.csv is written each so many steps."},
              {.name = "checkpoint_every",
               .type = KeyType::integer,
               .unit = "steps",
               .standard = "0",
               .range = nonnegative,
               .doc = "A checkpoint is written each so many steps, from which an interrupted run goes on (`run "
                      "--resume`); 0: by time only."},
              {.name = "checkpoint_seconds",
               .type = KeyType::number,
               .unit = "seconds",
               .standard = "300",
               .range = nonnegative,
               .doc = "A checkpoint is written when so much time has passed since the last one; 0: by steps only."},
          }};
}

Section check_section() {
  const Range small{.at_least = 0.0, .below = 1.0};
  return {
      .name = "check",
      .doc =
          "What a run must keep, whatever the case: a run that breaks its own account of energy or momentum says "
          "so. summary.json has the largest residuals under `checks`.",
      .keys = {
          {.name = "energy_residual",
           .type = KeyType::number,
           .unit = "1",
           .standard = "1e-8",
           .range = small,
           .doc = "Largest energy_residual, relative to the largest energy so far; 0: not checked."},
          {.name = "momentum",
           .type = KeyType::number,
           .unit = "1",
           .standard = "1e-8",
           .range = small,
           .doc = "What the impulses of all forces may leave unexplained of the change of momentum, relative to the "
                  "largest momentum and the sum of all impulses; 0: not checked."},
          {.name = "angular_momentum",
           .type = KeyType::number,
           .unit = "1",
           .standard = "1e-8",
           .range = small,
           .doc = "The same of angular momentum, relative to that times the largest distance of a node from the "
                  "origin. Not checked with degree 1 on curved cells, whose functions contain no rotations."},
          {.name = "on_failure",
           .type = KeyType::choice,
           .standard = "warn",
           .choices = {"warn", "stop"},
           .doc = "\"warn\": once per account; \"stop\": the run ends with status 3."},
      }};
}

Section expect_section() {
  return {.name = "expect",
          .kind = SectionKind::list,
          .doc =
              "Something that must hold at the end of a run, so that a case is its own regression test: either a value "
              "with "
              "a tolerance (relative, absolute or both: the larger one counts), or bounds.",
          .keys = {
              {.name = "quantity", .required = true, .doc = "A number of the results; see Quantities."},
              {.name = "value", .type = KeyType::number, .unit = "of the quantity", .doc = "The value it must have."},
              {.name = "relative",
               .type = KeyType::number,
               .unit = "1",
               .range = nonnegative,
               .doc = "Tolerance as a fraction of value."},
              {.name = "absolute",
               .type = KeyType::number,
               .unit = "of the quantity",
               .range = nonnegative,
               .doc = "Tolerance as a difference from value."},
              {.name = "minimum",
               .type = KeyType::number,
               .unit = "of the quantity",
               .doc = "Instead of value: the least it may be."},
              {.name = "maximum",
               .type = KeyType::number,
               .unit = "of the quantity",
               .doc = "Instead of value: the most it may be."},
              {.name = "when",
               .type = KeyType::conditions,
               .doc = "Key paths and values, as in { \"time.scheme\" = \"midpoint\" }: only runs where all of them "
                      "hold are checked."},
          }};
}

}  // namespace ricochet
