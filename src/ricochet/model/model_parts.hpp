#pragma once

#include "ricochet/mesh/merge_parts.hpp"
#include "ricochet/model/model.hpp"

/// @file The pieces of build_model, one file each. Not part of the public interface.
namespace ricochet {

/// Error(invalid_input) at the place of a key of the case.
[[noreturn]] void refuse(const Case& input, const std::string& key_path, const std::string& message);

/// Refuses a vector that has not as many entries as the mesh has dimensions; none of one that is absent.
void check_length(const Case& input, const std::string& key_path, std::size_t length, int dimension);

[[nodiscard]] inline Vector vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Vector>(values.data(), static_cast<Index>(values.size()));
}

/// Checks every vector and component of the case against the dimension of the mesh.
void check_dimensions(const Case& input, int dimension);

/// The meshes of mesh_files, where they are in their files; the name of that of [mesh] is empty. Errors of parts have
/// the place of their `file`; so have parts that do not go together.
[[nodiscard]] std::vector<NamedMesh> read_mesh_files(const Case& input);
/// Checks `turn` and `move` of a file.
void check_placement(const Case& input, const CaseMeshFile& file, int dimension);
/// One mesh of them, each where the case has it. The obstacles are made.
[[nodiscard]] Mesh put_together(const Case& input, const Model& model, std::vector<NamedMesh> files);
/// Brings the mesh of a file, which is turned and moved, to where it rests on its obstacle.
void rest_on_obstacle(const Case& input, const CaseMeshFile& file, const Model& model, Mesh& mesh);

/// Adds to the mesh what the case's groups need: "all", "boundary", and the unions of lists under their text. Throws
/// Error(invalid_input) with all names at once that are no groups.
void complete_groups(const Case& input, Mesh& mesh);

/// Group of cells or facets named at a key; refuses there when it does not exist or is empty.
[[nodiscard]] const Group& group_at(const Case& input, const std::string& key_path, const Mesh& mesh,
                                    const std::string& name, int dimension);

[[nodiscard]] inline bool is_axisymmetric(const Case& input) {
  return input.mesh.plane == "axisymmetric";
}
/// Refuses what axisymmetric bodies cannot do: translations and forces of gravity across the axis, spins.
void check_axisymmetry(const Case& input, int dimension);
/// The same of an obstacle that moves.
void check_axisymmetric_obstacle(const Case& input, const ObstacleSection& section, const Obstacle& obstacle);
/// Puts the nodes of an axisymmetric body that are on the axis at exactly x = 0; refuses those beyond it.
void place_on_axis(const Case& input, Mesh& mesh);
/// Of a group of facets those that are a surface of the body, not a part of its axis.
[[nodiscard]] std::vector<Index> facets_off_axis(const Case& input, const std::string& key_path, const Mesh& mesh,
                                                 const Group& group);
/// Holds the nodes on the axis there.
void add_axis_supports(const Case& input, Model& model);

/// Facets of a boundary group, without those on an axis; refuses there when some lie inside the body.
[[nodiscard]] std::vector<Index> boundary_at(const Case& input, const std::string& key_path, const Mesh& mesh,
                                             const std::string& name);

void assign_materials(const Case& input, Model& model);
void add_supports(const Case& input, Model& model);
void make_obstacles(const Case& input, Model& model, int dimension);
/// The contacts of the case, with those of pairs of bodies in the place of entries that stand for them.
[[nodiscard]] std::vector<ModelContact> find_contacts(const Case& input, const Model& model);
/// The groups of each contact.
void collect_contacts(const Case& input, Model& model);
/// Nodes that are tied; moves them onto the surface that they follow.
void add_ties(const Case& input, Model& model);
/// Where velocities of the start differ across a tie.
void warn_of_torn_ties(const Model& model);
void add_contacts(const Case& input, Model& model);
/// The groups of a contact between bodies; that which carries the multipliers is the pair's first.
[[nodiscard]] ContactPair body_pair(const Case& input, const ModelContact& contact, const Model& model);
/// Refuses groups that do not face each other, and warns of what their contact cannot do well.
void check_facing(const Case& input, std::size_t number, const Model& model);
/// Refuses bodies that overlap where the run starts.
void check_body_overlaps(const Case& input, const Model& model);
/// Mass, and, unless they come later, the forces of cells; then checks of the scheme.
void assemble_operators(const Case& input, Model& model, bool with_forces);
/// The internal force and damping by stiffness.
void assemble_forces(const Case& input, Model& model);
void add_loads(const Case& input, Model& model);
void add_initial_conditions(const Case& input, Model& model);
/// Checks velocities and spins of bodies.
void check_motions(const Case& input, int dimension);
/// Adds them to the velocity at the start. Refuses two that move one node.
void add_motions(const Case& input, Model& model);
/// Columns of history.csv that follow from the bodies and their contacts.
void add_standing_columns(const Case& input, Model& model);
/// What each [[probe]] is about, with what is to say about that.
void find_probes(const Case& input, Model& model);
/// The sensors of what was found.
void add_sensors(const Case& input, Model& model);
/// The obstacle of a section, with its motion.
[[nodiscard]] std::unique_ptr<Obstacle> make_obstacle(const Case& input, const ObstacleSection& section, int dimension);
/// The largest distance between neighbouring nodes of these facets, to half of it where there are nodes between.
[[nodiscard]] double node_spacing(const DisplacementSpace& space, const std::vector<Index>& facets);
/// Gives obstacles with a mass their two nodes, and supports what they are held by.
void add_free_bodies(const Case& input, Model& model);
void hold_free_bodies(const Case& input, Model& model);
/// dofs × dofs, with zeros where it had nothing.
[[nodiscard]] SparseMatrix resized(SparseMatrix matrix, Index dofs);
/// The mass with that of rigid bodies.
[[nodiscard]] SparseMatrix with_free_bodies(const Model& model, SparseMatrix mass);
/// Springs and dampers of rigid bodies.
void add_ground(const Case& input, Model& model);
void add_forces_on_free_bodies(const Case& input, Model& model);
void start_free_bodies(const Case& input, Model& model);
/// Tells obstacles what touches them.
void fit_obstacles(const Case& input, Model& model);
/// Warns of loads and motions, at a place, that come and go within the longest adaptive step.
void warn_of_brief_changes(const Case& input, const Vector& centre);
/// Refuses, or warns of, obstacles that gaps to cannot be found for, or that points and steps may miss.
void check_obstacles(const Case& input, const Model& model);

}  // namespace ricochet
