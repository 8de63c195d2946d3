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
          .doc = "Named numbers for use in the expressions of this section."};
}

Key against_key() {
  Key key = group_key("boundary facets", "boundary");
  key.name = "against";
  key.required = false;
  key.doc =
      "Group of boundary facets of another body, or a list of groups, that `group` may touch instead of an obstacle. "
      "With `sliding = \"large\"` also `group` itself: a surface that touches itself.";
  return key;
}

Key damping_key() {
  return {
      .name = "damping",
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
                .doc = "Rayleigh damping proportional to the stiffness matrix. If materials at contact nodes without "
                       "inertia differ in it, it counts twice at these nodes (docs/energy.md, section Damping)."}},
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
                    .doc = "Shear modulus of each branch, relative to the law's shear modulus at zero strain."},
                   {.name = "time",
                    .type = KeyType::numbers,
                    .unit = "time",
                    .required = true,
                    .range = positive,
                    .doc = "Relaxation time of each branch."}},
          .doc =
              "For laws of finite strain: viscoelastic branches (a Prony series). The constants of the law are the "
              "long-term ones, after relaxation."};
}

}  // namespace

Key group_key(const char* kind, const char* built_in) {
  return {.name = "group",
          .type = KeyType::groups,
          .required = true,
          .doc = fmt::format("Group of {0} in the mesh, or a list of groups: [\"a\", \"b\"]. \"{1}\" means all {0}, "
                             "unless the mesh has a group of that name.",
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
                       .doc = "The material law: \"linear\" for small strains and rotations, the others for strains "
                              "and rotations of any size. All materials of a case must be of the same kind."},
                      {.name = "dilatation",
                       .type = KeyType::choice,
                       .default_value = "automatic",
                       .choices = {"automatic", "pointwise", "mean"},
                       .doc = "For laws of finite strain: evaluation of the volumetric energy, \"pointwise\" or with "
                              "the \"mean\" dilatation of each cell, which does not lock as Poisson's ratio approaches "
                              "1/2. \"automatic\": the mean from 0.4 on, if the law and the cells support it."},
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
       .doc = "Mass of the obstacle, per length in two dimensions. With a mass or a density, the obstacle is a rigid "
              "body that moves under the forces on it, and `velocity` is the initial velocity of its centre of mass."},
      {.name = "density",
       .type = KeyType::number,
       .unit = "density",
       .range = positive,
       .doc = "Density, instead of `mass`, of a ball, a ring or a closed surface: it determines the mass, centre of "
              "mass and inertia of the enclosed body."},
      {.name = "inertia",
       .type = KeyType::axial,
       .unit = "mass·length²",
       .doc = "Moment of inertia about the centre of mass; in three dimensions the principal moments about the axes x, "
              "y and z. Default: that of the shape, with its mass."},
      {.name = "centre_of_mass",
       .type = KeyType::vector,
       .unit = "length",
       .doc = "Position of the centre of mass. Default: that of the shape."},
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
       .doc = "Stiffness, per direction, of springs from the rigid body's centre of mass to its initial position."},
      {.name = "damper",
       .type = KeyType::vector,
       .unit = "force·time/length",
       .doc = "Constants, per direction, of dampers on the velocity of the rigid body's centre of mass."},
      {.name = "rotation_spring",
       .type = KeyType::number,
       .unit = "force·length",
       .default_value = "0",
       .range = nonnegative,
       .doc = "Torque per angle that rotates the rigid body back to its initial orientation; in two dimensions only."},
      {.name = "rotation_damper",
       .type = KeyType::number,
       .unit = "force·length·time",
       .default_value = "0",
       .range = nonnegative,
       .doc = "Damping torque per angular velocity of the rigid body."},
      {.name = "hold",
       .type = KeyType::names,
       .choices = {"x", "y", "z", "rotation"},
       .doc = "Blocked motions of the rigid body: translation along these directions, or rotation."},
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
           .doc = "Shape of the obstacle: a plane with a half-space behind it; a sphere, cylinder or torus, touched "
                  "from outside or from inside; a surface from a file; or a shape described by an expression."},
          {.name = "velocity",
           .type = KeyType::vector,
           .unit = "length/time",
           .doc = "Constant velocity of the obstacle, which rests if no motion is specified. Friction depends on the "
                  "velocity of the body relative to it, and obstacle_work is the work that it does on the body."},
          {.name = "rotation_rate",
           .type = KeyType::number,
           .unit = "angle/time",
           .default_value = "0",
           .doc = "Rate, in rad per time, at which the obstacle rotates about its own axis, right-handed: the normal "
                  "of a plane through `point` (a turntable), the axis of a cylinder or a torus, in two dimensions the "
                  "centre of a circle. Its surface keeps its position and drags bodies that touch it."},
          {.name = "motion",
           .type = KeyType::formulas,
           .unit = "length",
           .variables = "t",
           .doc = "Displacement of the obstacle from its described position, instead of a velocity: [\"0\", "
                  "\"-0.1*sin(5*t)\"]."},
          {.name = "rotation",
           .type = KeyType::axial_formulas,
           .unit = "angle",
           .variables = "t",
           .doc =
               "Rotation of the obstacle about the point `about`, in rad: one expression in two dimensions, in three a "
               "vector whose direction is the axis and whose length is the angle. It is applied before the motion."},
          {.name = "about",
           .type = KeyType::vector,
           .unit = "length",
           .doc = "Centre of `rotation`, a point of the obstacle in its described position. Default: the centre of a "
                  "sphere, a cylinder or a torus, the point of a plane, otherwise the origin."},
          {.name = "table",
           .type = KeyType::text,
           .doc =
               "Text file with the motion, instead of `motion` and `rotation`. Each line has t and the components of "
               "the displacement, optionally followed by those of the rotation, separated by commas, semicolons or "
               "spaces, with decimal points. The motion is linear between lines, constant before the first and after "
               "the last. The first line may be a header, whose words begin with letters; '#' begins a comment."},
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
      .alone = "`group` must be \"all\", or a pattern such as \"disc-*\": every body may touch every other",
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
                  "Without `friction`, Tresca's law holds: the friction traction is at most this bound wherever the "
                  "body is pressed."},
          {.name = "multipliers",
           .type = KeyType::choice,
           .choices = multiplier_space_names(),
           .doc = "Space of the contact pressure and the friction traction: forces at the nodes, piecewise constant, "
                  "continuous piecewise linear, or biorthogonal to the displacement. See docs/multipliers.md. Default: "
                  "nodal with an obstacle, p1 between bodies."},
          {.name = "multipliers_on",
           .type = KeyType::choice,
           .default_value = "automatic",
           .choices = {"automatic", "group", "against"},
           .doc = "Between bodies: the side that carries the multipliers. \"automatic\" selects the side whose normals "
                  "vary less within a facet (docs/sliding.md): of a round and a flat side the round one, unless its "
                  "facets are twice as large. If they vary equally, it selects the smaller side with sliding = "
                  "\"large\", otherwise the one with the finer mesh, then the more curved, then the softer one."},
          {.name = "initial_gap",
           .type = KeyType::choice,
           .default_value = "geometry",
           .choices = {"geometry", "closed"},
           .doc = "Between bodies: the initial gaps, those of the meshes or zero where the meshes overlap. Facets of "
                  "curved surfaces that touch overlap by up to h²/8R."},
          {.name = "pair_at",
           .type = KeyType::vector,
           .unit = "length",
           .doc = "Between bodies: the displacement of the body of `group`, relative to the other one, at which facets "
                  "that face each other are paired: where the bodies will meet. Default: where they start."},
          {.name = "tied",
           .type = KeyType::flag,
           .default_value = "false",
           .doc = "Between bodies: the surfaces are bonded permanently, even if their meshes do not match. Friction "
                  "and multipliers do not apply."},
          {.name = "sliding",
           .type = KeyType::choice,
           .choices = {"small", "large"},
           .doc = "Between bodies: small sliding keeps the pairs of facets that are found at the start; with large "
                  "sliding they follow the motion. See docs/sliding.md. Default: small; large if every body may touch "
                  "every other."},
          {.name = "unstable_multipliers",
           .type = KeyType::choice,
           .default_value = "refuse",
           .choices = {"refuse", "allow"},
           .doc = "Treatment of multipliers that do not suit the displacement's degree (the inf-sup condition fails, "
                  "and pressures may oscillate). If allowed, they cause a warning."},
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
               .doc = "The prescribed displacement of these components."},
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
  return {.name = "pressure",
          .kind = SectionKind::list,
          .doc = "Pressure on a part of the boundary.",
          .keys = {
              group_key("boundary facets", "boundary"),
              {.name = "value",
               .type = KeyType::formula,
               .unit = "stress",
               .required = true,
               .variables = position_and_time,
               .doc = "The pressure, positive if it presses on the body. With laws of finite strain it stays normal to "
                      "the surface and acts on its current area; with the linear law it keeps its initial direction "
                      "and area. In plane stress it is per undeformed thickness."},
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
           .doc = "Displacement at t = 0; \"static\" is the equilibrium under the loads at t = 0, including contact "
                  "and friction. Where the velocity or a moving obstacle makes the body slide, friction has that "
                  "direction if such an equilibrium exists, and otherwise acts only from t = 0 on. Zero if absent."},
          {.name = "velocity",
           .type = KeyType::formulas,
           .unit = "length/time",
           .variables = position,
           .doc = "Velocity at t = 0. Zero if absent."},
          parameters_key(),
      }};
}

}  // namespace ricochet
