#include <fmt/format.h>

#include "ricochet/case/keys_table.hpp"
#include "ricochet/case/names.hpp"

// Keys on the model: materials, contact, loads and supports, initial conditions.
namespace ricochet {

namespace {

constexpr const char* position = "x, y and z";
constexpr const char* position_and_time = "x, y, z and t";

Key parameters_key() {
  return {.name = "parameters",
          .type = KeyType::parameters,
          .doc = "Numbers by name, for use in the expressions of this section."};
}

Key against_key() {
  Key key = group_key("boundary facets", "boundary");
  key.name = "against";
  key.required = false;
  key.doc =
      "Group of boundary facets of another body, or several: what `group` may touch, in place of an obstacle. "
      "`group` itself with `sliding = \"large\"`: a surface that touches itself.";
  return key;
}

Key damping_key() {
  return {.name = "damping",
          .type = KeyType::table,
          .keys = {{.name = "mass",
                    .type = KeyType::number,
                    .unit = "1/time",
                    .default_value = "0",
                    .range = nonnegative,
                    .doc = "Rayleigh damping proportional to the mass matrix."},
                   {.name = "stiffness",
                    .type = KeyType::number,
                    .unit = "time",
                    .default_value = "0",
                    .range = nonnegative,
                    .doc = "Rayleigh damping proportional to the stiffness matrix."}},
          .doc = "Rayleigh damping."};
}

Key relaxation_key() {
  return {.name = "relaxation",
          .type = KeyType::table,
          .keys = {{.name = "modulus",
                    .type = KeyType::numbers,
                    .unit = "1",
                    .required = true,
                    .range = positive,
                    .doc = "Shear modulus of each branch, relative to that of the law at zero strain."},
                   {.name = "time",
                    .type = KeyType::numbers,
                    .unit = "time",
                    .required = true,
                    .range = positive,
                    .doc = "Relaxation time of each branch."}},
          .doc =
              "Of laws of finite strain: branches whose stress relaxes (a Prony series). The law's own constants are "
              "those that are left in the end."};
}

}  // namespace

Key group_key(const char* kind, const char* built_in) {
  return {
      .name = "group",
      .type = KeyType::groups,
      .required = true,
      .doc = fmt::format("Group of {0} in the mesh, or several: [\"a\", \"b\"]. \"{1}\" stands for all {0}, unless the "
                         "mesh has a group of that name.",
                         kind, built_in)};
}

Section material_section() {
  Section section{.name = "material",
                  .kind = SectionKind::list,
                  .required = true,
                  .doc = "The material of one or more groups of cells.",
                  .keys = {
                      group_key("cells", "all"),
                      {.name = "density",
                       .type = KeyType::number,
                       .unit = "density",
                       .required = true,
                       .range = positive,
                       .doc = "Mass per volume."},
                      {.name = "law",
                       .type = KeyType::choice,
                       .default_value = "linear",
                       .doc = "The material law: \"linear\" for small strains and rotations, the others for any; all "
                              "materials of a case are of one or the other kind."},
                      {.name = "dilatation",
                       .type = KeyType::choice,
                       .default_value = "automatic",
                       .choices = {"automatic", "pointwise", "mean"},
                       .doc = "Of laws of finite strain: where the volume's part of the energy is taken, \"pointwise\" "
                              "or of a \"mean\" over each cell, which does not lock as Poisson's ratio nears 1/2; "
                              "\"automatic\": the mean from 0.4 on, where the law and the cells have one."},
                      damping_key(),
                      relaxation_key(),
                  }};
  return with_types(std::move(section), "law", material_law_registry());
}

/// Keys of a free rigid body.
std::vector<Key> free_body_keys() {
  return {
      {.name = "mass",
       .type = KeyType::number,
       .unit = "mass",
       .range = positive,
       .doc = "With it, or a density, the obstacle is a rigid body that moves by the forces on it; `velocity` is then "
              "that of its centre of mass at the start. In two dimensions the mass per length."},
      {.name = "density",
       .type = KeyType::number,
       .unit = "density",
       .range = positive,
       .doc = "The same, of a ball, a ring or a closed surface: mass, centre of mass and inertia are those of what it "
              "encloses."},
      {.name = "inertia",
       .type = KeyType::axial,
       .unit = "mass·length²",
       .doc =
           "Moment of inertia about the centre of mass; in three dimensions the principal ones about the axes x, y and "
           "z. Absent: that of the shape, with its mass."},
      {.name = "centre_of_mass", .type = KeyType::vector, .unit = "length", .doc = "Absent: that of the shape."},
      {.name = "spin",
       .type = KeyType::axial,
       .unit = "angle/time",
       .doc = "Angular velocity of the rigid body at the start, in rad per time."},
      {.name = "force",
       .type = KeyType::formulas,
       .unit = "force",
       .variables = "t",
       .doc = "Force on the rigid body's centre of mass, besides gravity, contact, springs and dampers."},
      {.name = "torque",
       .type = KeyType::axial_formulas,
       .unit = "force·length",
       .variables = "t",
       .doc = "Torque on the rigid body, about its centre of mass."},
      {.name = "spring",
       .type = KeyType::vector,
       .unit = "force/length",
       .doc = "Stiffness of springs from the rigid body's centre of mass to where it starts, per direction."},
      {.name = "damper",
       .type = KeyType::vector,
       .unit = "force·time/length",
       .doc = "Dampers on the velocity of the rigid body's centre of mass, per direction."},
      {.name = "rotation_spring",
       .type = KeyType::number,
       .unit = "force·length",
       .default_value = "0",
       .range = nonnegative,
       .doc = "Torque per angle that turns the rigid body back to how it starts; in two dimensions only."},
      {.name = "rotation_damper",
       .type = KeyType::number,
       .unit = "force·length·time",
       .default_value = "0",
       .range = nonnegative,
       .doc = "Torque per angular velocity of the rigid body."},
      {.name = "hold",
       .type = KeyType::names,
       .choices = {"x", "y", "z", "rotation"},
       .doc = "What the rigid body does not do: move along these directions, turn."},
  };
}

Section obstacle_section() {
  Section section{
      .name = "obstacle",
      .kind = SectionKind::named,
      .doc = "A rigid obstacle, named so that [[contact]] can refer to it.",
      .keys = {
          {.name = "type",
           .type = KeyType::choice,
           .required = true,
           .decides = true,
           .doc = "Its shape: a plane with a half-space behind it, a sphere or a cylinder or a torus, from outside or "
                  "from inside, a surface from a file, or what an expression describes."},
          {.name = "velocity",
           .type = KeyType::vector,
           .unit = "length/time",
           .doc =
               "Constant velocity of the obstacle; without any motion it rests. Friction acts on the velocity of the "
               "body relative to it, and obstacle_work is what it puts into the body."},
          {.name = "rotation_rate",
           .type = KeyType::number,
           .unit = "angle/time",
           .default_value = "0",
           .doc =
               "Rate in rad per time at which the obstacle turns about its own axis, right-handed: the normal of a "
               "plane through `point` (a turntable), the axis of a cylinder or a torus, in two dimensions the centre "
               "of a circle. Its surface stays where it is, and drags what touches it."},
          {.name = "motion",
           .type = KeyType::formulas,
           .unit = "length",
           .variables = "t",
           .doc = "Displacement of the obstacle from where it is described, in place of a velocity: [\"0\", "
                  "\"-0.1*sin(5*t)\"]."},
          {.name = "rotation",
           .type = KeyType::axial_formulas,
           .unit = "angle",
           .variables = "t",
           .doc =
               "Rotation of the obstacle about the point `about`, in rad: one expression in two dimensions, in three "
               "a vector whose direction is the axis and whose length is the angle. It comes before the motion."},
          {.name = "about",
           .type = KeyType::vector,
           .unit = "length",
           .doc =
               "The point of the obstacle, as it is described, that it turns about. Absent: the centre of a sphere, a "
               "cylinder or a torus, the point of a plane, else the origin."},
          {.name = "table",
           .type = KeyType::text,
           .doc =
               "Text file with the motion, in place of `motion` and `rotation`: in each line t and the components of "
               "the displacement, perhaps those of the rotation; separated by commas, semicolons or spaces, with "
               "decimal points. Linear between lines, constant before the first and after the last. The first line may "
               "be a header, whose words begin with letters; '#' begins a comment."},
          parameters_key(),
      }};
  for (Key& key : free_body_keys()) section.keys.push_back(std::move(key));
  return with_types(std::move(section), "type", obstacle_registry());
}

Section contact_section() {
  return {
      .name = "contact",
      .kind = SectionKind::list,
      .alternatives = {{"obstacle"}, {"against"}},
      .stands_alone = names_bodies,
      .alone = "`group` is \"all\", or a pattern such as \"disc-*\": every body may touch every other",
      .doc = "A part of the boundary that may touch an obstacle, or the boundary of another body.",
      .keys = {
          group_key("boundary facets", "boundary"),
          {.name = "obstacle", .doc = "Name of the obstacle, a section [obstacle.NAME]."},
          against_key(),
          {.name = "friction",
           .type = KeyType::number,
           .unit = "1",
           .default_value = "0",
           .range = nonnegative,
           .doc = "Coefficient F of Coulomb's law: the friction force is at most F times the normal force."},
          {.name = "friction_bound",
           .type = KeyType::number,
           .unit = "stress",
           .default_value = "0",
           .range = nonnegative,
           .doc = "Largest friction traction; 0: no bound. With `friction`, Coulomb's law holds up to this bound. "
                  "Alone it is Tresca's law: the friction traction is at most this wherever the body is pressed."},
          {.name = "multipliers",
           .type = KeyType::choice,
           .choices = multiplier_space_names(),
           .doc = "Space of the contact pressure and the friction traction: forces at the nodes, piecewise constant, "
                  "continuous piecewise linear, or biorthogonal to the displacement. See docs/multipliers.md. Absent: "
                  "nodal with an obstacle, p1 between bodies."},
          {.name = "multipliers_on",
           .type = KeyType::choice,
           .default_value = "automatic",
           .choices = {"automatic", "group", "against"},
           .doc =
               "Between bodies, the side that carries the multipliers. \"automatic\" takes the one within whose facets "
               "normals turn less (docs/sliding.md), which is the round one against a flat one unless its facets are "
               "twice as large; where turns are alike, with sliding = \"large\" the smaller one, else the one with "
               "the finer mesh, then the more curved, then the softer one."},
          {.name = "initial_gap",
           .type = KeyType::choice,
           .default_value = "geometry",
           .choices = {"geometry", "closed"},
           .doc = "Between bodies, gaps at the start: those of the meshes, or zero where the meshes overlap. Facets of "
                  "curved surfaces that touch overlap by up to h²/8R."},
          {.name = "pair_at",
           .type = KeyType::vector,
           .unit = "length",
           .doc = "Between bodies, the displacement of the body of `group`, relative to the other one, at which facets "
                  "that face each other are found: where the bodies will meet. Absent: where they start."},
          {.name = "tied",
           .type = KeyType::flag,
           .default_value = "false",
           .doc = "Between bodies: the surfaces are glued together for good, also where their meshes do not match. "
                  "Friction and multipliers have no part in it."},
          {.name = "sliding",
           .type = KeyType::choice,
           .choices = {"small", "large"},
           .doc = "Between bodies: small sliding keeps the pairs of facets that were found at the start; with large "
                  "sliding they follow the motion. See docs/sliding.md. Absent: small, of every body against every "
                  "other large."},
          {.name = "unstable_multipliers",
           .type = KeyType::choice,
           .default_value = "refuse",
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
              group_key("boundary facets", "boundary"),
              {.name = "components",
               .type = KeyType::components,
               .required = true,
               .choices = {"x", "y", "z"},
               .doc = "The components that are prescribed."},
              {.name = "value",
               .type = KeyType::formula,
               .unit = "length",
               .default_value = "0",
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
              group_key("boundary facets", "boundary"),
              {.name = "value",
               .type = KeyType::formulas,
               .unit = "stress",
               .required = true,
               .variables = position_and_time,
               .doc = "Force per area of the undeformed boundary."},
              parameters_key(),
          }};
}

Section pressure_section() {
  return {
      .name = "pressure",
      .kind = SectionKind::list,
      .doc = "Pressure on a part of the boundary.",
      .keys = {
          group_key("boundary facets", "boundary"),
          {.name = "value",
           .type = KeyType::formula,
           .unit = "stress",
           .required = true,
           .variables = position_and_time,
           .doc = "Positive where it presses. With laws of finite strain it stays normal to the surface and acts on "
                  "the area that it has now; with the linear law it keeps the direction and the area of the start. "
                  "In plane stress it is per undeformed thickness."},
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

}  // namespace ricochet
