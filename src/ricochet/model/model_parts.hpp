#pragma once

#include "ricochet/base/error.hpp"
#include "ricochet/mesh/merge_parts.hpp"
#include "ricochet/model/model.hpp"

/// @file The pieces of build_model, one file each. Not part of the public interface.
namespace ricochet {

/// Throws Error(invalid_input) with the location of a key of the case.
[[noreturn]] void refuse(const Case& input, const std::string& key_path, const std::string& message);
/// Returns work(), with its errors at the location of a key.
template <class Work>
decltype(auto) located(const Case& input, const std::string& key_path, const Work& work) {
  try {
    return work();
  } catch (const Error& problem) {
    refuse(input, key_path, problem.what());
  }
}

/// Refuses a vector whose number of entries differs from the dimension of the mesh, unless it is absent.
void check_length(const Case& input, const std::string& key_path, std::size_t length, int dimension);

[[nodiscard]] inline Vector vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Vector>(values.data(), Index(values.size()));
}

/// Checks every vector and component of the case against the dimension of the mesh.
void check_dimensions(const Case& input, int dimension);

/// Reads the meshes of mesh_files, before they are placed; the mesh of [mesh] has an empty name. Errors of parts, and
/// parts that do not fit together, are reported at the location of their `file`.
[[nodiscard]] std::vector<NamedMesh> read_mesh_files(const Case& input);
/// Checks `turn` and `move` of a file.
void check_placement(const Case& input, const CaseMeshFile& file, int dimension);
/// Places each mesh as the case demands and merges them into one. The obstacles must exist.
[[nodiscard]] Mesh merge_meshes(const Case& input, const Model& model, std::vector<NamedMesh> files);
/// Moves the mesh of a file, which is already turned and moved, to where it rests on its obstacle.
void rest_on_obstacle(const Case& input, const CaseMeshFile& file, const Model& model, Mesh& mesh);

/// Adds to the mesh the groups that the case needs: "all", "boundary", and the unions of lists under their text. Throws
/// Error(invalid_input) that lists all missing groups at once.
void complete_groups(const Case& input, Mesh& mesh);

/// Returns the group of cells or facets named at a key; refuses it there if it does not exist or is empty.
[[nodiscard]] const Group& group_at(const Case& input, const std::string& key_path, const Mesh& mesh,
                                    const std::string& name, int dimension);

[[nodiscard]] inline bool is_axisymmetric(const Case& input) { return input.mesh.plane == "axisymmetric"; }
/// Refuses what axisymmetric bodies do not support: translations and gravity across the axis, and spins.
void check_axisymmetry(const Case& input, int dimension);
/// Makes the same checks for an obstacle that moves.
void check_axisymmetric_obstacle(const Case& input, const ObstacleSection& section, const Obstacle& obstacle);
/// Sets x = 0 exactly for the nodes of an axisymmetric body that lie on the axis; refuses nodes beyond it.
void place_on_axis(const Case& input, Mesh& mesh);
/// Returns the facets of a group that are a surface of the body rather than a part of its axis.
[[nodiscard]] std::vector<Index> facets_off_axis(const Case& input, const std::string& key_path, const Mesh& mesh,
                                                 const Group& group);
/// Supports the nodes on the axis in the radial direction.
void add_axis_supports(const Case& input, Model& model);

/// Returns the facets of a boundary group, without those on an axis; refuses the group if some lie inside the body.
[[nodiscard]] std::vector<Index> boundary_at(const Case& input, const std::string& key_path, const Mesh& mesh,
                                             const std::string& name);

void assign_materials(const Case& input, Model& model);
void add_supports(const Case& input, Model& model);
void make_obstacles(const Case& input, Model& model, int dimension);
/// Returns the contacts of the case; entries that stand for all pairs of bodies are replaced by these pairs.
[[nodiscard]] std::vector<ModelContact> find_contacts(const Case& input, const Model& model);
/// Collects the groups of each contact.
void collect_contacts(const Case& input, Model& model);
/// Ties nodes, and moves them onto the surface that they follow.
void add_ties(const Case& input, Model& model);
/// Warns of initial velocities that differ across a tie.
void warn_of_torn_ties(const Model& model);
void add_contacts(const Case& input, Model& model);
/// Returns the groups of a contact between bodies; the pair's first group carries the multipliers.
[[nodiscard]] ContactPair body_pair(const Case& input, const ModelContact& contact, const Model& model);
/// Refuses groups that do not face each other, and warns of features that their contact resolves poorly.
void check_facing(const Case& input, std::size_t number, const Model& model);
/// Refuses bodies that overlap at the start of the run.
void check_body_overlaps(const Case& input, const Model& model);
/// Assembles the mass and, unless they follow later, the forces of cells; then checks the scheme.
void assemble_operators(const Case& input, Model& model, bool with_forces);
/// Assembles the internal force and the stiffness-proportional damping.
void assemble_forces(const Case& input, Model& model);
void add_loads(const Case& input, Model& model);
void add_initial_conditions(const Case& input, Model& model);
/// Checks initial velocities and spins of bodies.
void check_motions(const Case& input, int dimension);
/// Adds them to the initial velocity. Refuses two motions of one node.
void add_motions(const Case& input, Model& model);
/// Adds the columns of history.csv that follow from the bodies and their contacts.
void add_standing_columns(const Case& input, Model& model);
/// Finds the nodes and columns of each [[probe]], and reports them.
void find_probes(const Case& input, Model& model);
/// Makes the sensors of the probes that were found.
void add_sensors(const Case& input, Model& model);
/// Makes the obstacle of a section, with its motion.
[[nodiscard]] std::unique_ptr<Obstacle> make_obstacle(const Case& input, const ObstacleSection& section, int dimension);
/// Returns the largest distance between neighbouring nodes of these facets; halved if there are midside nodes.
[[nodiscard]] double node_spacing(const DisplacementSpace& space, const std::vector<Index>& facets);
/// Gives obstacles with a mass their two nodes; support_free_bodies supports the motions that are held.
void add_free_bodies(const Case& input, Model& model);
void support_free_bodies(const Case& input, Model& model);
/// Returns the matrix enlarged to dofs × dofs by zeros.
[[nodiscard]] SparseMatrix resized(SparseMatrix matrix, Index dofs);
/// Returns the mass including that of rigid bodies.
[[nodiscard]] SparseMatrix with_free_bodies(const Model& model, SparseMatrix mass);
/// Adds springs and dampers of rigid bodies.
void add_ground(const Case& input, Model& model);
void add_forces_on_free_bodies(const Case& input, Model& model);
void start_free_bodies(const Case& input, Model& model);
/// Fits obstacles to the sizes of the bodies that touch them.
void fit_obstacles(const Case& input, Model& model);
/// Warns of loads and motions, evaluated at one point, that come and go within the longest adaptive step.
void warn_of_brief_changes(const Case& input, const Vector& centre);
/// Refuses, or warns of, obstacles to which gaps cannot be computed, or that points and steps may miss.
void check_obstacles(const Case& input, const Model& model);

}  // namespace ricochet
