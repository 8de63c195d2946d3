#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/case/case.hpp"
#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/mesh/read_mesh.hpp"
#include "ricochet/simulation/history/history.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"
#include "ricochet/simulation/statics/starting_state.hpp"
#include "ricochet/simulation/step_control.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file A case together with its mesh: everything a run needs, built and checked.
namespace ricochet {

/// Contact between two surfaces or with an obstacle: a [[contact]] of the case, or one of the pairs of bodies that such
/// an entry expands to.
struct ModelContact : ContactSection {
  std::size_t entry = 0;  ///< index of the [[contact]] entry
  std::vector<Index> facets, opposite_facets;
  std::string all_pairs_group = {};  ///< the `group` of an entry that pairs every body with every other; else empty
};

/// Sizes of the whole body, also on a rank that holds only a part of it.
struct ModelSizes {
  Index nodes = 0, cells = 0, dofs = 0, contact_points = 0, supported_dofs = 0;
  double diameter = 0.0;  ///< diameter of the smallest ball around the mesh
};

struct Model {
  Mesh mesh;
  DisplacementSpace space;
  Body body;
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  std::vector<ContactScale> contact_scales;  ///< per obstacle, the sizes that it is fitted to
  std::vector<ModelContact> contacts;        ///< in the order of the case
  std::vector<ContactPair> contact_pairs;    ///< per contact
  TiedNodes tied;                            ///< nodes of surfaces that are glued to other surfaces
  std::vector<PairingSummary> pair_facings;  ///< per contact; empty for contacts with obstacles
  SemidiscreteProblem problem;
  ModelSizes sizes;
  std::string mass_built;  ///< name of the mass construction; for "equivalent", of the one that it chose
  InitialConditions initial;
  bool contains_rotations = true;  ///< false for degree 1 on curved cells and for axisymmetric bodies
  BodiesOfMesh bodies;
  std::vector<ProbeTargets> probe_targets;       ///< per [[probe]]
  std::vector<std::shared_ptr<Sensor>> sensors;  ///< sensors with a column in history.csv
  HistoryBodies history_bodies;                  ///< bodies with columns of their own
  /// Sensors with a file of their own, by the number of steps between its rows.
  std::map<long, std::vector<std::shared_ptr<Sensor>>> sampled_sensors;
  std::unique_ptr<CellRotations> rotation;
  std::shared_ptr<const PreconditionerFactory> preconditioners;  ///< those of PETSc; null without it
  std::shared_ptr<const void> rank_data;                         ///< data of the ranks, if the body is divided
  /// Positions of a divided body's nodes and cells in the output files and, on the first rank, the whole body.
  struct GlobalOutput {
    std::vector<Index> node_rows, cell_rows;
    DisplacementSpace space;
    Body body;
    SemidiscreteProblem problem;  ///< nodes, obstacles and contact facets only
  };
  std::unique_ptr<const GlobalOutput> global_output;

  Model() = default;
  Model(const Model&) = delete;  // body points into this
  Model& operator=(const Model&) = delete;
};

/// Throws Error(invalid_input) if contact points start deeper inside an obstacle than straight facets can deviate from
/// a curved surface: pushing them out would create energy. A static start is exempt. For programs that run cases
/// unchanged; a model itself may start anywhere. Collective over all ranks.
void refuse_bodies_inside_obstacles(const Case& input, const Model& model);
/// Returns the names of the bodies of the mesh and then of the rigid bodies that move freely, as RigidBodies has them.
[[nodiscard]] std::vector<std::string> names_of_all_bodies(const Case& input, const Model& model);

/// Returns the scheme selected by [time].
[[nodiscard]] std::unique_ptr<Scheme> make_scheme(const TimeSection& time);
/// Returns the options of adaptive steps; none if all steps have the same length.
[[nodiscard]] std::optional<StepControlOptions> step_control_options(const TimeSection& time);
/// Returns a text such as "1,500 steps of 0.0001" or "adaptive steps of at most 0.01".
[[nodiscard]] std::string steps_text(const TimeSection& time);
/// Returns the options selected by [solver].
[[nodiscard]] StepSolverOptions step_solver_options(const Case& input);
/// Returns the name of the scheme with its parameters, such as "newmark (beta 0.25, gamma 0.5)".
[[nodiscard]] std::string scheme_text(const TimeSection& time);

/// Mesh file of a case, with its refinement and placement.
struct CaseMeshFile {
  std::string section;  ///< section of the case: "mesh", "part.ball"
  std::string part;     ///< name of the part; empty for the file of [mesh]
  MeshFile file;
  int refinements = 0;  ///< applied after reading (refine_mesh.hpp)
  Placement placement;
  std::string rest_on;  ///< name of an obstacle; empty if none
  double rest_gap = 0.0;
};

/// Returns the columns of history.csv of a run of this model.
[[nodiscard]] Columns history_columns(const Model& model);

/// Returns the file of [mesh], or those of the parts in their order.
[[nodiscard]] std::vector<CaseMeshFile> mesh_files(const Case& input);

/// Throws Error(file_access), with the location in the case, if mesh files do not exist.
void require_mesh_files(const Case& input);

/// Seconds spent in each phase of building a model.
struct BuildTimes {
  double read_mesh = 0.0;
  double model = 0.0;     ///< numbering, groups, contact boundary, loads, initial conditions, checks
  double assembly = 0.0;  ///< mass and stiffness, including the mass construction
};

/// Reads the mesh and builds the semidiscrete problem. Throws Error(invalid_input) with file:line:column of the entry
/// of the case that does not fit the mesh, and states what the mesh has instead.
[[nodiscard]] std::unique_ptr<Model> build_model(const Case& input, BuildTimes* times = nullptr);
/// Makes those checks of an axisymmetric case that need no mesh, for a mesh that is not there yet.
void check_without_mesh(const Case& input);

/// Builds the model without the forces of cells (K, and damping proportional to it), for a body that is divided among
/// ranks before these are assembled.
[[nodiscard]] std::unique_ptr<Model> build_model_without_forces(const Case& input, BuildTimes* times = nullptr);

}  // namespace ricochet
