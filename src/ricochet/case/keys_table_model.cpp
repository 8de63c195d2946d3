#include <fmt/format.h>

#include "ricochet/case/keys_table.hpp"
#include "ricochet/case/names.hpp"

// Keys on the model: materials, contact, loads and supports, initial conditions.
namespace ricochet {

namespace {

constexpr const char* position = "x, y and z";
constexpr const char* position_and_time = "x, y, z and t";

Key parameters_key() {
  return key("parameters", {}, {.type = KeyType::parameters},
             "Named numbers for use in the expressions of this section.");
}

Key against_key() {
  Key key = group_key(member(&ContactSection::against), "boundary facets", "boundary");
  key.name = "against";
  key.required = false;
  key.doc =
      "Group of boundary facets of another body, or a list of groups, that `group` may touch instead of an obstacle. "
      "With `sliding = \"large\"` also `group` itself: a surface that touches itself.";
  return key;
}

std::vector<Key> damping_keys() {
  return {
      key("mass", &DampingSection::mass, {.unit = "1/time", .default_value = "0", .range = nonnegative},
          "Rayleigh damping proportional to the mass matrix."),
      key("stiffness", &DampingSection::stiffness, {.unit = "time", .default_value = "0", .range = nonnegative},
          "Rayleigh damping proportional to the stiffness matrix. If materials at contact nodes without inertia differ "
          "in it, it counts twice at these nodes (docs/energy.md, section Damping)."),
  };
}

std::vector<Key> relaxation_keys() {
  return {
      key("modulus", &RelaxationSection::modulus,
          {.type = KeyType::numbers, .unit = "1", .required = true, .range = positive},
          "Shear modulus of each branch, relative to the law's shear modulus at zero strain."),
      key("time", &RelaxationSection::time,
          {.type = KeyType::numbers, .unit = "time", .required = true, .range = positive},
          "Relaxation time of each branch."),
  };
}

/// Keys of a free rigid body.
std::vector<Key> free_body_keys() {
  return {
      key("mass", &FreeBodySection::mass, {.unit = "mass", .range = positive},
          "Mass of the obstacle, per length in two dimensions. With a mass or a density, the obstacle is a rigid body "
          "that moves under the forces on it, and `velocity` is the initial velocity of its centre of mass."),
      key("density", &FreeBodySection::density, {.unit = "density", .range = positive},
          "Density, instead of `mass`, of a ball, a ring or a closed surface: it determines the mass, centre of mass "
          "and inertia of the enclosed body."),
      key("inertia", &FreeBodySection::inertia, {.type = KeyType::axial, .unit = "mass·length²"},
          "Moment of inertia about the centre of mass; in three dimensions the principal moments about the axes x, y "
          "and z. Default: that of the shape, with its mass."),
      key("centre_of_mass", &FreeBodySection::centre_of_mass, {.unit = "length"},
          "Position of the centre of mass. Default: that of the shape."),
      key("spin", &FreeBodySection::spin, {.type = KeyType::axial, .unit = "angle/time"},
          "Angular velocity of the rigid body at the start, in rad per time."),
      key("force", &FreeBodySection::force, {.unit = "force", .variables = "t"},
          "Force on the rigid body's centre of mass, besides gravity, contact, springs and dampers."),
      key("torque", &FreeBodySection::torque,
          {.type = KeyType::axial_formulas, .unit = "force·length", .variables = "t"},
          "Torque on the rigid body, about its centre of mass."),
      key("spring", &FreeBodySection::spring, {.unit = "force/length"},
          "Stiffness, per direction, of springs from the rigid body's centre of mass to its initial position."),
      key("damper", &FreeBodySection::damper, {.unit = "force·time/length"},
          "Constants, per direction, of dampers on the velocity of the rigid body's centre of mass."),
      key("rotation_spring", &FreeBodySection::rotation_spring,
          {.unit = "force·length", .default_value = "0", .range = nonnegative},
          "Torque per angle that rotates the rigid body back to its initial orientation; in two dimensions only."),
      key("rotation_damper", &FreeBodySection::rotation_damper,
          {.unit = "force·length·time", .default_value = "0", .range = nonnegative},
          "Damping torque per angular velocity of the rigid body."),
      key("hold", &FreeBodySection::hold, {.choices = {"x", "y", "z", "rotation"}},
          "Blocked motions of the rigid body: translation along these directions, or rotation."),
  };
}

}  // namespace

Key group_key(KeyMember member, const char* kind, const char* built_in) {
  return key("group", {std::move(member)}, {.type = KeyType::groups, .required = true},
             fmt::format("Group of {0} in the mesh, or a list of groups: [\"a\", \"b\"]. \"{1}\" means all {0}, unless "
                         "the mesh has a group of that name.",
                         kind, built_in));
}

Section material_section() {
  Section section{.name = "material",
                  .kind = SectionKind::list,
                  .required = true,
                  .doc = "The material of one or more groups of cells."};
  section.keys = {
      group_key(member(&MaterialSection::group), "cells", "all"),
      key("density", &MaterialSection::density, {.unit = "density", .required = true, .range = positive},
          "Mass per volume."),
      key("law", &MaterialSection::law, {.default_value = "linear"},
          "The material law: \"linear\" for small strains and rotations, the others for strains and rotations of any "
          "size. All materials of a case must be of the same kind."),
      key("dilatation", &MaterialSection::dilatation,
          {.default_value = "automatic", .choices = {"automatic", "pointwise", "mean"}},
          "For laws of finite strain: evaluation of the volumetric energy, \"pointwise\" or with the \"mean\" "
          "dilatation of each cell, which does not lock as Poisson's ratio approaches 1/2. \"automatic\": the mean "
          "from 0.4 on, if the law and the cells support it."),
      key("damping", &MaterialSection::damping, {.keys = damping_keys()}, "Rayleigh damping."),
      key("relaxation", &MaterialSection::relaxation, {.keys = relaxation_keys()},
          "For laws of finite strain: viscoelastic branches (a Prony series). The constants of the law are the "
          "long-term ones, after relaxation."),
  };
  return with_types(std::move(section), "law", material_law_registry(), &MaterialSection::parameters);
}

Section obstacle_section() {
  Section section{.name = "obstacle",
                  .kind = SectionKind::named,
                  .doc = "A rigid obstacle, named so that [[contact]] can refer to it."};
  section.keys = {
      key("type", &ObstacleSection::type, {.required = true, .decides = true},
          "Shape of the obstacle: a plane with a half-space behind it, a body touched from outside or from inside "
          "(`side`), a surface from a file, or a shape described by an expression."),
      key("velocity", &ObstacleSection::velocity, {.unit = "length/time"},
          "Constant velocity of the obstacle, which rests if no motion is specified. Friction depends on the velocity "
          "of the body relative to it, and obstacle_work is the work that it does on the body."),
      key("rotation_rate", &ObstacleSection::rotation_rate, {.unit = "angle/time", .default_value = "0"},
          "Rate, in rad per time, at which the obstacle rotates about its own axis, right-handed: its `axis` through "
          "`centre`, the normal of a plane through `point` (a turntable), in two dimensions the centre of a circle. "
          "Its surface keeps its position and drags bodies that touch it."),
      key("motion", &ObstacleSection::motion, {.unit = "length", .variables = "t"},
          "Displacement of the obstacle from its described position, instead of a velocity: [\"0\", "
          "\"-0.1*sin(5*t)\"]."),
      key("rotation", &ObstacleSection::rotation, {.type = KeyType::axial_formulas, .unit = "angle", .variables = "t"},
          "Rotation of the obstacle about the point `about`, in rad: one expression in two dimensions, in three a "
          "vector whose direction is the axis and whose length is the angle. It is applied before the motion."),
      key("about", &ObstacleSection::about, {.unit = "length"},
          "Centre of `rotation`, a point of the obstacle in its described position. Default: its `centre` or, of a "
          "plane, its `point`, otherwise the origin."),
      key("table", {path(&ObstacleSection::table)}, {},
          "Text file with the motion, instead of `motion` and `rotation`. Each line has t and the components of the "
          "displacement, optionally followed by those of the rotation, separated by commas, semicolons or spaces, with "
          "decimal points. The motion is linear between lines, constant before the first and after the last. The first "
          "line may be a header, whose words begin with letters; '#' begins a comment."),
      parameters_key(),
  };
  for (Key& key : free_body_keys()) section.keys.push_back(std::move(key));
  return with_types(std::move(section), "type", obstacle_registry(), &ObstacleSection::parameters);
}

Section contact_section() {
  Section section{.name = "contact",
                  .kind = SectionKind::list,
                  .alternatives = {{"obstacle"}, {"against"}},
                  .stands_alone = names_bodies,
                  .alone = "`group` must be \"all\", or a pattern such as \"disc-*\": every body may touch every other",
                  .doc = "A part of the boundary that may touch an obstacle, or the boundary of another body."};
  section.keys = {
      group_key(member(&ContactSection::group), "boundary facets", "boundary"),
      key("obstacle", &ContactSection::obstacle, {}, "Name of the obstacle, a section [obstacle.NAME]."),
      against_key(),
      key("friction", &ContactSection::friction, {.unit = "1", .default_value = "0", .range = nonnegative},
          "Coefficient F of Coulomb's law: the friction force is at most F times the normal force."),
      key("friction_bound", &ContactSection::friction_bound,
          {.unit = "stress", .default_value = "0", .range = nonnegative},
          "Largest friction traction; 0: no bound. With `friction`, Coulomb's law holds up to this bound. Without "
          "`friction`, Tresca's law holds: the friction traction is at most this bound wherever the body is pressed."),
      key("multipliers", &ContactSection::multipliers, {.choices = multiplier_space_names()},
          "Space of the contact pressure and the friction traction: forces at the nodes, piecewise constant, "
          "continuous piecewise linear, or biorthogonal to the displacement. See docs/multipliers.md. Default: nodal "
          "with an obstacle, p1 between bodies."),
      key("multipliers_on", &ContactSection::multipliers_on,
          {.default_value = "automatic", .choices = {"automatic", "group", "against"}},
          "Between bodies: the side that carries the multipliers. \"automatic\" selects the side whose normals vary "
          "less within a facet (docs/sliding.md): of a round and a flat side the round one, unless its facets are "
          "twice as large. If they vary equally, it selects the smaller side with sliding = \"large\", otherwise the "
          "one with the finer mesh, then the more curved, then the softer one."),
      key("initial_gap", {is_choice(&ContactSection::closed_gaps, "closed")},
          {.default_value = "geometry", .choices = {"geometry", "closed"}},
          "Between bodies: the initial gaps, those of the meshes or zero where the meshes overlap. Facets of curved "
          "surfaces that touch overlap by up to h²/8R."),
      key("pair_at", &ContactSection::pair_at, {.unit = "length"},
          "Between bodies: the displacement of the body of `group`, relative to the other one, at which facets that "
          "face each other are paired: where the bodies will meet. Default: where they start."),
      key("tied", &ContactSection::tied, {.default_value = "false"},
          "Between bodies: the surfaces are bonded permanently, even if their meshes do not match. Friction and "
          "multipliers do not apply."),
      key("sliding", {is_choice(&ContactSection::large_sliding, "large")}, {.choices = {"small", "large"}},
          "Between bodies: small sliding keeps the pairs of facets that are found at the start; with large sliding "
          "they follow the motion. See docs/sliding.md. Default: small; large if every body may touch every other."),
      key("unstable_multipliers", {is_choice(&ContactSection::allow_unstable_multipliers, "allow")},
          {.default_value = "refuse", .choices = {"refuse", "allow"}},
          "Treatment of multipliers that do not suit the displacement's degree (the inf-sup condition fails, and "
          "pressures may oscillate). If allowed, they cause a warning."),
  };
  return section;
}

Section support_section() {
  Section section{.name = "support",
                  .kind = SectionKind::list,
                  .doc = "Prescribed displacement components on a part of the boundary."};
  section.keys = {
      group_key(member(&SupportSection::group), "boundary facets", "boundary"),
      key("components", &SupportSection::components, {.required = true, .choices = {"x", "y", "z"}},
          "The components that are prescribed."),
      key("value", &SupportSection::value, {.unit = "length", .default_value = "0", .variables = "t"},
          "The prescribed displacement of these components."),
      parameters_key(),
  };
  return section;
}

Section traction_section() {
  Section section{.name = "traction", .kind = SectionKind::list, .doc = "Force on a part of the boundary."};
  section.keys = {
      group_key(member(&TractionSection::group), "boundary facets", "boundary"),
      key("value", &TractionSection::value, {.unit = "stress", .required = true, .variables = position_and_time},
          "Force per area of the undeformed boundary."),
      parameters_key(),
  };
  return section;
}

Section pressure_section() {
  Section section{.name = "pressure", .kind = SectionKind::list, .doc = "Pressure on a part of the boundary."};
  section.keys = {
      group_key(member(&PressureSection::group), "boundary facets", "boundary"),
      key("value", &PressureSection::value, {.unit = "stress", .required = true, .variables = position_and_time},
          "The pressure, positive if it presses on the body. With laws of finite strain it stays normal to the surface "
          "and acts on its current area; with the linear law it keeps its initial direction and area. In plane stress "
          "it is per undeformed thickness."),
      parameters_key(),
  };
  return section;
}

Section load_section() {
  Section section{.name = "load", .doc = "Forces on the whole body."};
  section.keys = {
      key("gravity", &LoadSection::gravity, {.unit = "acceleration"}, "Acceleration of gravity; none if absent."),
      key("body_force", &LoadSection::body_force, {.unit = "force/volume", .variables = position_and_time},
          "Force per volume; none if absent."),
      parameters_key(),
  };
  return section;
}

Section initial_section() {
  Section section{.name = "initial", .doc = "The state at t = 0."};
  section.keys = {
      key("displacement",
          {member(&InitialSection::displacement), is_choice(&InitialSection::static_equilibrium, "static")},
          {.type = KeyType::formulas, .unit = "length", .choices = {"static"}, .variables = position},
          "Displacement at t = 0; \"static\" is the equilibrium under the loads at t = 0, including contact and "
          "friction. Where the velocity or a moving obstacle makes the body slide, friction has that direction if such "
          "an equilibrium exists, and otherwise acts only from t = 0 on. Zero if absent."),
      key("velocity", &InitialSection::velocity, {.unit = "length/time", .variables = position},
          "Velocity at t = 0. Zero if absent."),
      parameters_key(),
  };
  return section;
}

}  // namespace ricochet
