#include <algorithm>

#include "ricochet/case/keys_table.hpp"
#include "ricochet/mesh/derived_groups.hpp"

// Keys on bodies: their files and positions, and their initial motion.
namespace ricochet {

namespace {

std::vector<Key> rotation_keys() {
  return {
      key("angle", &MeshRotation::angle, {.unit = "degrees", .required = true},
          "Angle of the rotation, right-handed about the axis; counter-clockwise in two dimensions."),
      key("axis", &MeshRotation::axis, {.unit = "1"},
          "Direction of the axis, of any nonzero length; only in three dimensions, where it is required."),
      key("about", &MeshRotation::about, {.unit = "length"},
          "A point on the axis, in the coordinates after `scale` and the preceding rotations. Default: the origin."),
  };
}

/// Mesh file and its placement: for [mesh] and every part.
std::vector<Key> file_keys() {
  return {
      key("file", {path(&BodyFile::file)}, {.required = true},
          "Mesh file (.msh, .inp, .vtu, .med, …; see docs/meshes.md), or geometry for the gmsh program (.geo, .step, "
          "…). A relative path is relative to the folder of the case file, also when given by --set."),
      key("size", &BodyFile::size, {.unit = "length", .range = positive},
          "Target size of the cells, in the unit of the file; only for geometry that the gmsh program meshes."),
      key("scale", &BodyFile::scale, {.unit = "1", .default_value = "1", .range = positive},
          "Multiplies all coordinates of the mesh."),
      key("refine", &BodyFile::refinements, {.unit = "1", .default_value = "0", .range = {.at_least = 0, .at_most = 8}},
          "Number of uniform refinements of the mesh after it is read; each divides every cell into four cells, in "
          "three dimensions into eight. New nodes lie on the edges of straight cells, even where these approximate a "
          "curve, and on the curved geometry of a second-order mesh."),
      key("turn", &Placement::rotations, {.keys = rotation_keys()},
          "Rotates the mesh, after `scale` and before `move`; the rotations of a list are applied in order. Obstacles, "
          "probes and expressions refer to the mesh in its final position."),
      key("move", &Placement::move, {.unit = "length"},
          "Translation that is added to all coordinates, after `scale` and `turn`."),
      key("rest_on", &BodyFile::rest_on, {},
          "Name of an obstacle, a section [obstacle.NAME]. After `move` the mesh is shifted until its lowest node is "
          "at the distance `rest_gap` above this obstacle at t = 0: along the normal of a plane; with other obstacles "
          "along gravity or, without gravity, along the obstacle's normal at the nearest node."),
      key("rest_gap", &BodyFile::rest_gap, {.unit = "length", .range = nonnegative},
          "Distance of the lowest node from the obstacle of `rest_on`. Default: 0, so that they touch."),
      key("drop_height", &BodyFile::drop_height, {.unit = "length", .range = positive},
          "Height through which the body has fallen from rest when the run starts: adds the velocity √(2gH) along "
          "`load.gravity`, which is then required."),
  };
}

Key velocity_key(const std::string& what) {
  return key("velocity", &MotionSection::velocity, {.unit = "length/time"},
             "Velocity at t = 0 of " + what + ", added to the velocity of [initial]. Zero if absent.");
}

Key spin_key(const std::string& about) {
  return key("spin", &MotionSection::spin, {.type = KeyType::axial, .unit = "1/time"},
             "Angular velocity at t = 0, in rad per time, about " + about +
                 "; counter-clockwise in two dimensions. Zero if absent.");
}

}  // namespace

bool names_bodies(const TomlNode& contact) {
  const TomlNode* const group = contact.find("group");
  const auto is_name = [](const TomlNode& name) {
    return name.text == all_cells_name || name.text.find('*') != std::string::npos;
  };
  return group != nullptr && (is_name(*group) || std::ranges::any_of(group->children, is_name));
}

Section mesh_section() {
  Section section{.name = "mesh",
                  .required = true,
                  .replaced_by = "part",
                  .doc =
                      "The body and its discretization. With sections [part.NAME], this section contains only `degree` "
                      "and `plane`, which apply to all parts.",
                  .keys = file_keys()};
  for (Key& key : section.keys) key.replaced_by = "part";
  section.keys.push_back(key("degree", &MeshSection::degree, {.unit = "1", .default_value = "1", .choices = {"1", "2"}},
                             "Polynomial degree of the displacement."));
  section.keys.push_back(key("plane", &MeshSection::plane,
                             {.default_value = "strain", .choices = {"strain", "stress", "axisymmetric"}},
                             "In two dimensions: plane strain, plane stress, or the half x ≥ 0 of a section through "
                             "bodies that are symmetric about the axis x = 0 (docs/axisymmetric.md)."));
  return section;
}

Section part_section() {
  Section section{
      .name = "part",
      .kind = SectionKind::named,
      .doc =
          "One or more bodies from a separate file. The groups of a part are called \"NAME.group\"; \"NAME.all\" "
          "contains all of its cells, \"NAME.boundary\" all of its boundary facets. Parts share no nodes.",
      .keys = file_keys()};
  section.keys.push_back(velocity_key("the part as a rigid body"));
  section.keys.push_back(spin_key("the part's centre of mass"));
  return section;
}

Section motion_section() {
  Section section{.name = "motion",
                  .kind = SectionKind::list,
                  .doc =
                      "Cells that move like a rigid body at t = 0. Corresponds to a part's `velocity` and `spin`, for "
                      "bodies in one file."};
  section.keys = {
      group_key(member(&MotionSection::group), "cells", "all"),
      velocity_key("the nodes of these cells"),
      spin_key("`about`"),
      key("about", &MotionSection::about, {.unit = "length"},
          "A point on the axis of `spin`. Default: the centre of mass of these cells."),
  };
  return section;
}

}  // namespace ricochet
