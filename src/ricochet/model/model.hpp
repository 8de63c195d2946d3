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
#include "ricochet/simulation/statics/starting_state.hpp"
#include "ricochet/simulation/step_control.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file A case together with its mesh: everything a run needs, built and checked.
namespace ricochet {

/// What a [[probe]] has found in the mesh.
struct WatchedPlaces {
  std::vector<Probe> probes;      ///< nodes, those of segments too
  std::vector<Vector> positions;  ///< of each
  std::vector<Columns> columns;   ///< of the sensor of each
  std::vector<Index> nodes;       ///< of a boundary
  std::string sums;               ///< of which forces its columns are sums, in words; empty: of none
};

/// A contact of two surfaces: a [[contact]] of the case, or one of the pairs of bodies that such an entry stands for.
struct ModelContact : ContactSection {
  std::size_t entry = 0;  ///< number of the [[contact]]
  std::vector<Index> facets, opposite_facets;
  std::string pair_of = {};  ///< the entry's `group`, where it stands for every body against every other; else empty
};

/// Of the whole body, whatever part of it is here.
struct ModelSizes {
  Index nodes = 0, cells = 0, dofs = 0, contact_points = 0, supported_dofs = 0;
  double diameter = 0.0;  ///< of the smallest ball around the mesh
};

struct Model {
  Mesh mesh;
  DisplacementSpace space;
  Body body;
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  std::vector<ContactScale> contact_scales;  ///< of each obstacle, what it is fitted to
  std::vector<ModelContact> contacts;        ///< in the order of the case
  std::vector<ContactPair> contact_pairs;    ///< of each contact
  TiedNodes tied;                            ///< nodes of surfaces that are glued to others
  std::vector<PairFacing> pair_facings;      ///< of each; nothing of those with obstacles
  SemidiscreteProblem problem;
  ModelSizes sizes;
  std::string mass_built;  ///< the name of the construction; for "equivalent" the one that it chose
  InitialConditions initial;
  bool contains_rotations = true;  ///< false: degree 1 on curved cells, or axisymmetric
  BodiesOfMesh bodies;
  std::vector<WatchedPlaces> watched;            ///< of each [[probe]]
  std::vector<std::shared_ptr<Sensor>> sensors;  ///< with a column in history.csv
  HistoryBodies history_bodies;                  ///< with columns of their own
  /// Those with a file of their own, by the steps between its rows.
  std::map<long, std::vector<std::shared_ptr<Sensor>>> sampled_sensors;
  std::unique_ptr<RotationGauge> rotation;
  std::shared_ptr<const PreconditionerMaker> preconditioners;  ///< of other libraries; null: none
  std::shared_ptr<const void> kept;                            ///< what its ranks are, where the body is divided
  /// Of a divided body: where its nodes and cells are in what is written, and on the first rank the whole.
  struct Written {
    std::vector<Index> node_rows, cell_rows;
    DisplacementSpace space;
    Body body;
    SemidiscreteProblem problem;  ///< nodes, obstacles and the facets of contact
  };
  std::unique_ptr<const Written> written;

  Model() = default;
  Model(const Model&) = delete;  // body points into this
  Model& operator=(const Model&) = delete;
};

/// Throws Error(invalid_input) where contact points begin deeper inside of an obstacle than facets may be off a curved
/// surface: to push them out creates energy. Not where the start is a static one. For programs that run cases as they
/// are; a model may begin anywhere. All ranks call it.
void refuse_bodies_inside_obstacles(const Case& input, const Model& model);

/// The scheme that [time] asks for.
[[nodiscard]] std::unique_ptr<Scheme> make_scheme(const TimeSection& time);
/// What it says of adaptive steps; none where all are of one length.
[[nodiscard]] std::optional<StepControlOptions> step_control_options(const TimeSection& time);
/// "1,500 steps of 0.0001", "adaptive steps of at most 0.01".
[[nodiscard]] std::string steps_text(const TimeSection& time);
/// What [solver] asks for.
[[nodiscard]] StepSolverOptions step_solver_options(const Case& input);
/// The scheme with its parameters: "newmark (beta 0.25, gamma 0.5)".
[[nodiscard]] std::string scheme_text(const TimeSection& time);

/// A file that the mesh comes from, as the case asks for it.
struct CaseMeshFile {
  std::string section;  ///< of the case: "mesh", "part.ball"
  std::string part;     ///< its name; empty for the file of [mesh]
  MeshFile file;
  int refinements = 0;  ///< once it is read (refine_mesh.hpp)
  Placement placement;
  std::string rest_on;  ///< an obstacle; empty: none
  double rest_gap = 0.0;
};

/// The columns of the histories of its runs.
[[nodiscard]] Columns history_columns(const Model& model);

/// That of [mesh], or those of the parts in their order.
[[nodiscard]] std::vector<CaseMeshFile> mesh_files(const Case& input);

/// Throws Error(file_access), at their places in the case, where files are not there.
void require_mesh_files(const Case& input);

/// Seconds spent in the phases of building a model.
struct BuildTimes {
  double read_mesh = 0.0;
  double model = 0.0;     ///< numbering, groups, contact boundary, loads, initial conditions, checks
  double assembly = 0.0;  ///< mass and stiffness, the mass construction included
};

/// Reads the mesh and builds the semi-discrete problem. Throws Error(invalid_input) with file:line:column of the entry
/// of the case that does not fit the mesh, and what there is instead.
[[nodiscard]] std::unique_ptr<Model> build_model(const Case& input, BuildTimes* times = nullptr);

/// The same without the forces that cells make (K, and damping by it): of a body that is divided before these are
/// assembled.
[[nodiscard]] std::unique_ptr<Model> build_model_without_forces(const Case& input, BuildTimes* times = nullptr);

}  // namespace ricochet
