#include "ricochet/case/keys.hpp"
#include "ricochet/case/names.hpp"

// The table itself. Nothing else in the program lists the keys of a case file.
namespace ricochet {

namespace {

const Range positive{.above = 0.0};
const Range nonnegative{.at_least = 0.0};

constexpr const char* position = "x, y and z";
constexpr const char* position_and_time = "x, y, z and t";

Key parameters_key() {
  return {.name = "parameters",
          .type = KeyType::parameters,
          .doc = "Numbers by name, for use in the expressions of this section."};
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const NewmarkPreset& preset : newmark_presets()) names.push_back(preset.name);
  return names;
}

Section top_section() {
  return {.name = "",
          .kind = SectionKind::top,
          .doc = "Before the first section.",
          .keys = {{.name = "title", .standard = "", .doc = "A line about the case, repeated in its results."}}};
}

Section mesh_section() {
  return {
      .name = "mesh",
      .required = true,
      .doc = "The body and how it is discretized.",
      .keys = {
          {.name = "file",
           .required = true,
           .doc = "Mesh file (.msh), or geometry for the gmsh program (.geo, .step, …). A relative path is relative to "
                  "the "
                  "folder of the case file, also when given by --set."},
          {.name = "size",
           .type = KeyType::number,
           .unit = "length",
           .range = positive,
           .doc = "Target size of the cells; only for geometry that is still to be meshed, in the unit of that file."},
          {.name = "scale",
           .type = KeyType::number,
           .unit = "1",
           .standard = "1",
           .range = positive,
           .doc = "Multiplies all coordinates of the mesh."},
          {.name = "degree",
           .type = KeyType::integer,
           .unit = "1",
           .standard = "1",
           .choices = {"1", "2"},
           .doc = "Polynomial degree of the displacement."},
          {.name = "plane",
           .type = KeyType::choice,
           .standard = "strain",
           .choices = {"strain", "stress"},
           .doc = "In two dimensions: plane strain or plane stress."},
      }};
}

Key damping_key() {
  return {.name = "damping",
          .type = KeyType::table,
          .keys = {{.name = "mass",
                    .type = KeyType::number,
                    .unit = "1/time",
                    .standard = "0",
                    .range = nonnegative,
                    .doc = "Rayleigh damping proportional to the mass matrix."},
                   {.name = "stiffness",
                    .type = KeyType::number,
                    .unit = "time",
                    .standard = "0",
                    .range = nonnegative,
                    .doc = "Rayleigh damping proportional to the stiffness matrix."}},
          .doc = "Rayleigh damping."};
}

Section material_section() {
  return {
      .name = "material",
      .kind = SectionKind::list,
      .required = true,
      .alternatives = {{"lambda", "mu"}, {"young", "poisson"}},
      .doc = "Isotropic linear elasticity of one physical group of cells.",
      .keys = {
          {.name = "group", .required = true, .doc = "Name of the physical group of cells in the mesh."},
          {.name = "density",
           .type = KeyType::number,
           .unit = "density",
           .required = true,
           .range = positive,
           .doc = "Mass per volume."},
          {.name = "lambda",
           .type = KeyType::number,
           .unit = "stress",
           .doc = "First Lamé parameter; 3 lambda + 2 mu must be positive."},
          {.name = "mu",
           .type = KeyType::number,
           .unit = "stress",
           .range = positive,
           .doc = "Second Lamé parameter, the shear modulus."},
          {.name = "young", .type = KeyType::number, .unit = "stress", .range = positive, .doc = "Young's modulus."},
          {.name = "poisson",
           .type = KeyType::number,
           .unit = "1",
           .range = {.above = -1.0, .below = 0.5},
           .doc = "Poisson's ratio."},
          damping_key(),
      }};
}

Section obstacle_section() {
  return {
      .name = "obstacle",
      .kind = SectionKind::named,
      .doc = "A rigid obstacle, named so that [[contact]] can refer to it.",
      .keys = {
          {.name = "type",
           .type = KeyType::choice,
           .required = true,
           .choices = obstacle_types(),
           .doc = "Shape: a half-space bounded by a plane."},
          {.name = "point",
           .type = KeyType::vector,
           .unit = "length",
           .required = true,
           .doc = "A point of the plane."},
          {.name = "normal",
           .type = KeyType::vector,
           .unit = "1",
           .required = true,
           .doc = "Normal of the plane, out of the obstacle; of any length but zero."},
          {.name = "velocity",
           .type = KeyType::vector,
           .unit = "length/time",
           .doc = "Constant velocity of the plane; without it the plane rests. Friction acts on the velocity of the "
                  "body relative to it, and obstacle_work is what it puts into the body."},
          {.name = "rotation_rate",
           .type = KeyType::number,
           .unit = "angle/time",
           .standard = "0",
           .doc = "Rate in rad per time at which the plane turns about its normal through `point`, right-handed: a "
                  "turntable. In three dimensions only."},
      }};
}

Section contact_section() {
  return {
      .name = "contact",
      .kind = SectionKind::list,
      .doc = "A part of the boundary that may touch an obstacle.",
      .keys = {
          {.name = "group", .required = true, .doc = "Name of the physical group of boundary facets in the mesh."},
          {.name = "obstacle", .required = true, .doc = "Name of the obstacle, a section [obstacle.NAME]."},
          {.name = "friction",
           .type = KeyType::number,
           .unit = "1",
           .standard = "0",
           .range = nonnegative,
           .doc = "Coefficient F of Coulomb's law: the friction force is at most F times the normal force."},
          {.name = "friction_bound",
           .type = KeyType::number,
           .unit = "stress",
           .standard = "0",
           .range = nonnegative,
           .doc = "Largest friction traction; 0: no bound. With `friction`, Coulomb's law holds up to this bound. "
                  "Alone it is Tresca's law: the friction traction is at most this wherever the body is pressed."},
          {.name = "multipliers",
           .type = KeyType::choice,
           .standard = "nodal",
           .choices = multiplier_space_names(),
           .doc = "Space of the contact pressure and the friction traction: forces at the nodes, piecewise constant, "
                  "continuous piecewise linear, or biorthogonal to the displacement. See docs/multipliers.md."},
          {.name = "unstable_multipliers",
           .type = KeyType::choice,
           .standard = "refuse",
           .choices = {"refuse", "allow"},
           .doc = "What to do with multipliers that do not go together with the displacement's degree (the inf-sup "
                  "condition fails, and pressures may oscillate). Allowed ones are warned of."},
      }};
}

Section support_section() {
  return {.name = "support",
          .kind = SectionKind::list,
          .doc = "Prescribed displacement components on a part of the boundary.",
          .keys = {
              {.name = "group", .required = true, .doc = "Name of the physical group of boundary facets in the mesh."},
              {.name = "components",
               .type = KeyType::components,
               .required = true,
               .choices = {"x", "y", "z"},
               .doc = "The components that are prescribed."},
              {.name = "value",
               .type = KeyType::formula,
               .unit = "length",
               .standard = "0",
               .variables = "t",
               .doc = "The displacement of these components."},
              parameters_key(),
          }};
}

Section traction_section() {
  return {.name = "traction",
          .kind = SectionKind::list,
          .doc = "Force on a part of the boundary.",
          .keys = {
              {.name = "group", .required = true, .doc = "Name of the physical group of boundary facets in the mesh."},
              {.name = "value",
               .type = KeyType::formulas,
               .unit = "stress",
               .required = true,
               .variables = position_and_time,
               .doc = "Force per area of the undeformed boundary."},
              parameters_key(),
          }};
}

Section load_section() {
  return {.name = "load",
          .doc = "Forces on the whole body.",
          .keys = {
              {.name = "gravity",
               .type = KeyType::vector,
               .unit = "acceleration",
               .doc = "Acceleration of gravity; none if absent."},
              {.name = "body_force",
               .type = KeyType::formulas,
               .unit = "force/volume",
               .variables = position_and_time,
               .doc = "Force per volume; none if absent."},
              parameters_key(),
          }};
}

Section initial_section() {
  return {
      .name = "initial",
      .doc = "The state at t = 0.",
      .keys = {
          {.name = "displacement",
           .type = KeyType::formulas,
           .unit = "length",
           .choices = {"static"},
           .variables = position,
           .doc =
               "Displacement at t = 0; \"static\" is the equilibrium under the loads at t = 0, contact and friction "
               "included. Where the velocity or a moving obstacle makes the body slide, friction has that direction if "
               "such an equilibrium exists, and else acts from t = 0 on only. Zero if absent."},
          {.name = "velocity",
           .type = KeyType::formulas,
           .unit = "length/time",
           .variables = position,
           .doc = "Velocity at t = 0. Zero if absent."},
          parameters_key(),
      }};
}

Section mass_section() {
  return {.name = "mass",
          .doc = "The mass matrix.",
          .keys = {
              {.name = "type",
               .type = KeyType::choice,
               .standard = "equivalent",
               .choices = mass_names(),
               .doc = "The equivalent masses have no inertia on contact nodes, and keep total mass, centre of gravity "
                      "and moments of inertia. \"equivalent-lumped\" is diagonal, for the scheme \"semi-explicit\"."}}};
}

Section time_section() {
  return {
      .name = "time",
      .required = true,
      .doc = "The time scheme and its steps.",
      .keys = {
          {.name = "scheme",
           .type = KeyType::choice,
           .required = true,
           .choices = scheme_names(),
           .doc = "The time scheme."},
          {.name = "beta",
           .type = KeyType::number,
           .unit = "1",
           .range = positive,
           .doc = "Newmark's beta, textbook definition; for the scheme \"newmark\" only."},
          {.name = "gamma",
           .type = KeyType::number,
           .unit = "1",
           .range = nonnegative,
           .doc = "Newmark's gamma, textbook definition; unstable below 1/2; for the scheme \"newmark\" only."},
          {.name = "preset",
           .type = KeyType::choice,
           .choices = preset_names(),
           .doc = "Instead of beta and gamma: \"trapezoidal\" is beta = 1/4, gamma = 1/2; \"textbook-half\" is beta = "
                  "gamma = 1/2."},
          {.name = "step",
           .type = KeyType::number,
           .unit = "time",
           .required = true,
           .range = positive,
           .doc = "Length of a time step; \"semi-explicit\" refuses one above its critical step, which `ricochet "
                  "info` shows."},
          {.name = "end",
           .type = KeyType::number,
           .unit = "time",
           .required = true,
           .range = positive,
           .doc = "The run goes from t = 0 to here; at least one step and at most 1e9."},
      }};
}

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
           .doc = "Name of a physical group of boundary facets: force and moment on the body of supports and "
                  "obstacles at its nodes (given loads are not counted). Columns NAME.force_x …, NAME.moment_z, in 3D "
                  "NAME.moment_x …"},
          {.name = "about",
           .type = KeyType::vector,
           .unit = "length",
           .doc = "Point that the moment of a boundary is about, in the reference configuration; absent: the "
                  "origin."},
          {.name = "group",
           .doc = "Name of a physical group of cells or of boundary facets: columns "
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

Section solver_section() {
  return {
      .name = "solver",
      .doc = "How a step is solved. Nothing here needs to be given.",
      .keys = {
          {.name = "method",
           .type = KeyType::choice,
           .standard = "auto",
           .choices = {"auto", "direct", "iterative"},
           .doc = "\"direct\": a Cholesky factor, made once; exact to rounding. \"iterative\": conjugate gradients "
                  "with a direct solve near the contact; takes little memory and no time to factorize, and a few "
                  "times as long per step where a wave crosses a few cells in it, more where it crosses many. "
                  "\"auto\": direct where the factor fits into memory and takes minutes, not hours, to make. A "
                  "static start is solved as by \"auto\", the contact nodes of \"semi-explicit\" always directly."},
          {.name = "tolerance",
           .type = KeyType::number,
           .unit = "1",
           .standard = "1e-10",
           .range = {.above = 0.0, .at_most = 1e-3},
           .doc = "Of the iterative method: the force left over in a step, relative to the forces of the step, in "
                  "the energy norm. Contact and friction hold to rounding with any method."},
          {.name = "memory",
           .type = KeyType::number,
           .unit = "GB",
           .range = positive,
           .doc = "What factors may take, for the choice of \"auto\"; absent: half of the machine's memory."},
          {.name = "contact_points",
           .type = KeyType::choice,
           .standard = "near",
           .choices = {"near", "all"},
           .doc = "\"near\": the points that may touch in a step take part in its contact problem; others are looked "
                  "at after it, and where one has penetrated the step is solved again with it. \"all\": all do, which "
                  "changes results by rounding only; for exported contact problems of one size."},
      }};
}

std::vector<std::string> field_choices() {
  std::vector<std::string> names = field_names();
  names.emplace_back("all");
  return names;
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
               .doc = "The fields that are written, see the README; \"all\" stands for all of them. Absent: "
                      "displacement, velocity, what there is of contact, and von_mises."},
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

}  // namespace

const std::vector<NewmarkPreset>& newmark_presets() {
  static const std::vector<NewmarkPreset> presets{{"trapezoidal", 0.25, 0.5}, {"textbook-half", 0.5, 0.5}};
  return presets;
}

const std::vector<Section>& case_sections() {
  static const std::vector<Section> sections{
      top_section(),     mesh_section(),    material_section(), obstacle_section(),
      contact_section(), support_section(), traction_section(), load_section(),
      initial_section(), mass_section(),    time_section(),     solver_section(),
      probe_section(),   output_section(),  check_section(),    expect_section()};
  return sections;
}

}  // namespace ricochet
