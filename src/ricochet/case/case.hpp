#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/expression.hpp"
#include "ricochet/base/parameters.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/mesh/place_mesh.hpp"

/// @file Content of a case file, after parsing and every check that needs no mesh. Field names are the keys of the
/// file. Units are the user's own and must be consistent; nothing here has a scale.
namespace ricochet {

/// Position of a value. `line` is 0 for values given by --set (then `file` is "--set key.path=value") or by default.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
  /// "file:line:column", or `file` alone.
  [[nodiscard]] std::string text() const;
};

/// Mesh file with one or several bodies, and its placement.
struct BodyFile {
  std::string file;  ///< resolved: relative paths are relative to the case file's directory
  std::optional<double> size;
  double scale = 1.0;
  int refinements = 0;
  Placement placement;       ///< rotations and translation
  std::string rest_on;       ///< an obstacle; may be empty
  double rest_gap = 0.0;     ///< distance of the lowest node from it
  double drop_height = 0.0;  ///< height of the free fall before the start; the velocity is in its motion
};

/// `file` is empty if there are parts.
struct MeshSection : BodyFile {
  int degree = 1;                ///< of the displacement
  std::string plane = "strain";  ///< "strain" or "stress"
};

struct PartSection : BodyFile {
  std::string name;
};

struct DampingSection {
  double mass = 0.0;       ///< 1/time
  double stiffness = 0.0;  ///< time
};

struct RelaxationSection {
  std::vector<double> modulus;  ///< per branch, relative to the law's shear modulus
  std::vector<double> time;     ///< per branch
};

struct MaterialSection {
  std::string dilatation = "automatic";
  std::string group;
  double density = 0.0;
  std::string law = "linear";
  Parameters parameters;  ///< of the law
  DampingSection damping;
  RelaxationSection relaxation;  ///< lists of equal length; may be empty
};

/// Keys of an obstacle that is a free rigid body, whose `velocity` is the initial one.
struct FreeBodySection {
  std::optional<double> mass, density;
  std::vector<double> inertia, centre_of_mass;  ///< empty: those of its shape
  std::vector<double> spin;                     ///< initial; may be empty
  std::vector<Expression> force, torque;        ///< of t; may be empty
  std::vector<double> spring, damper;           ///< to the initial position, per direction; may be empty
  double rotation_spring = 0.0, rotation_damper = 0.0;
  std::vector<std::string> hold;  ///< "x", "y", "z", "rotation"
};

struct ObstacleSection : FreeBodySection {
  std::string name;
  std::string type;
  Parameters parameters;  ///< of the type
  // Prescribed motion:
  std::vector<double> velocity;      ///< may be empty
  double rotation_rate = 0.0;        ///< about its own axis
  std::vector<Expression> motion;    ///< displacement as a function of t; may be empty
  std::vector<Expression> rotation;  ///< of t, in rad: one number in 2D, a vector in 3D; may be empty
  std::vector<double> about;         ///< empty: its own centre
  std::string table;                 ///< file of displacements and rotations; may be empty
  bool is_steered = false;           ///< a program changes its motion during the run (Session)
  [[nodiscard]] bool is_free() const { return mass || density; }
};

struct ContactSection {
  std::string group;            ///< without obstacle and `against`: surfaces of bodies that may all touch each other
  std::string obstacle;         ///< empty: between bodies
  std::string against;          ///< the other group; empty: an obstacle
  double friction = 0.0;        ///< F of Coulomb's law
  double friction_bound = 0.0;  ///< largest friction traction, a stress; 0: no bound
  std::string multipliers = "nodal";
  std::string multipliers_on = "automatic";  ///< between bodies: "automatic", "group" or "against"
  bool large_sliding = false;                ///< sliding = "large"
  bool closed_gaps = false;                  ///< initial_gap = "closed"
  bool tied = false;
  std::vector<double> pair_at;  ///< empty: initial positions of the bodies
  bool allow_unstable_multipliers = false;

  /// Returns whether the entry represents the contacts of every body with every other (ModelContact).
  [[nodiscard]] bool is_of_all_pairs() const { return obstacle.empty() && against.empty(); }
  [[nodiscard]] bool between_bodies() const { return obstacle.empty(); }
};

struct SupportSection {
  std::string group;
  std::vector<int> components;  ///< 0, 1, 2 for "x", "y", "z"
  Expression value;             ///< of t (a displacement)
};

struct TractionSection {
  std::string group;
  std::vector<Expression> value;  ///< of x, y, z, t: force per area of the undeformed boundary
};

struct PressureSection {
  std::string group;
  Expression value;  ///< of x, y, z, t: positive in compression
};

struct LoadSection {
  std::vector<double> gravity;         ///< acceleration; may be empty
  std::vector<Expression> body_force;  ///< of x, y, z, t: force per volume; may be empty
};

struct InitialSection {
  bool static_equilibrium = false;       ///< displacement = "static"
  std::vector<Expression> displacement;  ///< of x, y, z; empty: zero
  std::vector<Expression> velocity;      ///< of x, y, z; empty: zero
};

/// Cells with a rigid-body motion at t = 0: from [[motion]], `velocity` and `spin` of a part, or drop_height.
struct MotionSection {
  std::string section;           ///< its section: "motion.0", "part.ball", "mesh"
  std::string group;             ///< group of cells; empty for a part or the whole mesh
  std::string part;              ///< name of the part; empty for a group or the whole mesh
  std::vector<double> velocity;  ///< empty: zero
  std::vector<double> spin;      ///< rad per time; one number in two dimensions, three in three; empty: zero
  std::vector<double> about;     ///< empty: the centre of mass of the cells
};

struct MassSection {
  std::string type = "equivalent";
  Parameters parameters;  ///< of the type
};

struct TimeSection {
  std::string scheme;
  Parameters parameters;  ///< of the scheme
  double step = 0.0;      ///< the longest one if adaptive
  double end = 0.0;
  bool adaptive = false;
  double tolerance = 0.0, smallest = 0.0;  ///< of adaptive steps
};

/// Number of steps to the end time; the last step ends at or after it. Adaptive steps count as if all were the longest.
[[nodiscard]] long step_count(const TimeSection& time);
/// Returns the time at which a run ends, after a whole number of steps of a fixed length.
[[nodiscard]] double run_end(const TimeSection& time);

struct ProbeSection {
  std::string name;
  std::string kind;   ///< of probe_registry()
  Parameters values;  ///< of the keys of this kind
  long every = 0;     ///< steps, in a separate file; 0: with the rows of history.csv
};

struct OutputSection {
  std::optional<long> fields_every;       ///< steps; null: chosen for about a hundred frames; 0: no frames
  std::optional<double> fields_interval;  ///< time, instead of fields_every
  std::vector<std::string> fields;        ///< names, also "all"; empty: the default ones
  std::string format = "xdmf";            ///< of the files of fields
  bool single_precision = false;          ///< of fields
  int compression = 0;
  std::optional<long> history_every;  ///< null: chosen by the scheme
  long checkpoint_every = 0;          ///< steps; 0: by time only
  double checkpoint_seconds = 300.0;  ///< wall-clock time; 0: by steps only
};

struct CheckSection {
  double energy_residual = 1e-8;   ///< relative to the largest energy; 0: not checked
  double momentum = 1e-8;          ///< relative to the momenta of all bodies and the sum of all impulses
  double angular_momentum = 1e-8;  ///< likewise, times the distance of the body from the origin
  bool stops = false;              ///< the run ends if a balance is violated, otherwise it warns
};

struct SolverSection {
  std::string method = "auto";
  double tolerance = 1e-10;
  double newton_tolerance = 1e-8;
  std::optional<double> memory;  ///< GB
  std::string preconditioner = "auto";
  std::string contact_points = "near";
};

struct ExpectSection {
  std::string name = {};  ///< the quantity in words; may be empty
  std::string quantity = {};
  std::string over = {};  ///< divisor, a quantity; may be empty
  double times = 1.0;     ///< factor of the quantity
  double value = 0.0;
  std::optional<double> relative = {}, absolute = {};  ///< tolerances; at least one
  std::optional<double> minimum = {}, maximum = {};    ///< instead of value: bounds
  std::string published = {};                          ///< published value, in words; may be empty
  std::map<std::string, std::string> when = {};  ///< key path → value as text: checked only in runs where they hold
};

struct Case {
  std::string path;  ///< of the case file
  std::string title;
  MeshSection mesh;
  std::vector<PartSection> parts;  ///< in the order of the file; if empty the mesh is that of [mesh]
  std::vector<MaterialSection> materials;
  std::vector<ObstacleSection> obstacles;
  std::vector<ContactSection> contacts;
  std::vector<SupportSection> supports;
  std::vector<TractionSection> tractions;
  std::vector<PressureSection> pressures;
  LoadSection load;
  InitialSection initial;
  std::vector<MotionSection> motions;  ///< those of parts first
  MassSection mass;
  TimeSection time;
  std::vector<ProbeSection> probes;
  SolverSection solver;
  OutputSection output;
  CheckSection check;
  std::vector<ExpectSection> expectations;
  /// Names in the lists of groups, by the text that represents the list in the sections' `group` (and `boundary`).
  std::map<std::string, std::vector<std::string>> group_lists;
  std::vector<std::string> overridden;              ///< key paths given by --set
  std::map<std::string, SourceLocation> locations;  ///< key path ("contact.0.group") → position
  std::map<std::string, std::string> values;        ///< key path → value as text, defaults included, for `when`

  /// Location of a key path, or of the nearest enclosing section, or of the file.
  [[nodiscard]] SourceLocation where(const std::string& key_path) const;
};

}  // namespace ricochet
