#include "ricochet/case/keys_table.hpp"

#include <algorithm>

#include "ricochet/case/toml_tree.hpp"
#include "ricochet/mesh/derived_groups.hpp"

// Keys on bodies: their files and positions, and their initial motion.
namespace ricochet {

namespace {

Key rotation_key() {
  return {
      .name = "turn",
      .type = KeyType::tables,
      .keys = {{.name = "angle",
                .type = KeyType::number,
                .unit = "degrees",
                .required = true,
                .doc = "Angle of the rotation, right-handed about the axis; counter-clockwise in two dimensions."},
               {.name = "axis",
                .type = KeyType::vector,
                .unit = "1",
                .doc = "Direction of the axis, of any nonzero length; only in three dimensions, where it is required."},
               {.name = "about",
                .type = KeyType::vector,
                .unit = "length",
                .doc = "A point on the axis, in the coordinates after `scale` and the preceding rotations. Default: "
                       "the origin."}},
      .doc =
          "Rotates the mesh, after `scale` and before `move`; the rotations of a list are applied in order. Obstacles, "
          "probes and expressions refer to the mesh in its final position."};
}

/// Mesh file and its placement: for [mesh] and every part.
std::vector<Key> file_keys() {
  return {
      {.name = "file",
       .required = true,
       .doc = "Mesh file (.msh, .inp, .vtu, .med, …; see docs/meshes.md), or geometry for the gmsh program (.geo, "
              ".step, …). A relative path is relative to the folder of the case file, also when given by --set."},
      {.name = "size",
       .type = KeyType::number,
       .unit = "length",
       .range = positive,
       .doc = "Target size of the cells, in the unit of the file; only for geometry that the gmsh program meshes."},
      {.name = "scale",
       .type = KeyType::number,
       .unit = "1",
       .default_value = "1",
       .range = positive,
       .doc = "Multiplies all coordinates of the mesh."},
      {.name = "refine",
       .type = KeyType::integer,
       .unit = "1",
       .default_value = "0",
       .range = {.at_least = 0, .at_most = 8},
       .doc = "Number of uniform refinements of the mesh after it is read; each divides every cell into four cells, in "
              "three dimensions into eight. New nodes lie on the edges of straight cells, even where these approximate "
              "a curve, and on the curved geometry of a second-order mesh."},
      rotation_key(),
      {.name = "move",
       .type = KeyType::vector,
       .unit = "length",
       .doc = "Translation that is added to all coordinates, after `scale` and `turn`."},
      {.name = "rest_on",
       .doc = "Name of an obstacle, a section [obstacle.NAME]. After `move` the mesh is shifted until its lowest node "
              "is at the distance `rest_gap` above this obstacle at t = 0: along the normal of a plane; with other "
              "obstacles along gravity or, without gravity, along the obstacle's normal at the nearest node."},
      {.name = "rest_gap",
       .type = KeyType::number,
       .unit = "length",
       .range = nonnegative,
       .doc = "Distance of the lowest node from the obstacle of `rest_on`. Default: 0, so that they touch."},
      {.name = "drop_height",
       .type = KeyType::number,
       .unit = "length",
       .range = positive,
       .doc = "Height through which the body has fallen from rest when the run starts: adds the velocity √(2gH) along "
              "`load.gravity`, which is then required."},
  };
}

Key velocity_key(const char* what) {
  return {.name = "velocity",
          .type = KeyType::vector,
          .unit = "length/time",
          .doc = std::string("Velocity at t = 0 of ") + what + ", added to the velocity of [initial]. Zero if absent."};
}

Key spin_key(const char* about) {
  return {.name = "spin",
          .type = KeyType::axial,
          .unit = "1/time",
          .doc = std::string("Angular velocity at t = 0, in rad per time, about ") + about +
                 "; counter-clockwise in two dimensions. Zero if absent."};
}

}  // namespace

bool names_bodies(const TomlNode& contact) {
  const TomlNode* const group = contact.find("group");
  const auto is_name = [](const TomlNode& name) {
    return name.text == all_cells_name || name.text.find('*') != std::string::npos;
  };
  return group != nullptr && (is_name(*group) || std::any_of(group->children.begin(), group->children.end(), is_name));
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
  section.keys.push_back({.name = "degree",
                          .type = KeyType::integer,
                          .unit = "1",
                          .default_value = "1",
                          .choices = {"1", "2"},
                          .doc = "Polynomial degree of the displacement."});
  section.keys.push_back({.name = "plane",
                          .type = KeyType::choice,
                          .default_value = "strain",
                          .choices = {"strain", "stress", "axisymmetric"},
                          .doc = "In two dimensions: plane strain, plane stress, or the half x ≥ 0 of a section "
                                 "through bodies that are symmetric about the axis x = 0 (docs/axisymmetric.md)."});
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
  return {.name = "motion",
          .kind = SectionKind::list,
          .doc =
              "Cells that move like a rigid body at t = 0. Corresponds to a part's `velocity` and `spin`, for bodies "
              "in one file.",
          .keys = {
              group_key("cells", "all"),
              velocity_key("the nodes of these cells"),
              spin_key("`about`"),
              {.name = "about",
               .type = KeyType::vector,
               .unit = "length",
               .doc = "A point on the axis of `spin`. Default: the centre of mass of these cells."},
          }};
}

}  // namespace ricochet
