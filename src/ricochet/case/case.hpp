#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/expression.hpp"
#include "ricochet/base/parameters.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/mesh/place_mesh.hpp"

/// @file What a case file says, after parsing and every check that needs no mesh. Field names are the keys of the file.
/// Units are the user's own and must be consistent; nothing here has a scale.
namespace ricochet {

/// Where a value stands. `line` is 0 for values given by --set (then `file` is "--set key.path=value") or by default.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
  /// "file:line:column", or `file` alone.
  [[nodiscard]] std::string text() const;
};

/// A file with one body or several, and where they are put.
struct BodyFile {
  std::string file;  ///< as resolved: relative paths are relative to the case file's directory
  std::optional<double> size;
  double scale = 1.0;
  int refinements = 0;
  Placement placement;       ///< turns and move
  std::string rest_on;       ///< an obstacle; empty: none
  double rest_gap = 0.0;     ///< of the lowest node above it
  double drop_height = 0.0;  ///< that it has fallen through at the start; its motion has the velocity
};

/// Its file is empty where there are parts.
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
  RelaxationSection relaxation;  ///< of one length; empty: none
};

struct ObstacleSection {
  std::string name;
  std::string type;
  Parameters parameters;  ///< of the type
  // Its motion:
  std::vector<double> velocity;      ///< empty: none
  double rotation_rate = 0.0;        ///< about its own axis
  std::vector<Expression> motion;    ///< of t: a displacement; empty: none
  std::vector<Expression> rotation;  ///< of t, in rad: one number in 2D, a vector in 3D; empty: none
  std::vector<double> about;         ///< empty: its own centre
  std::string table;                 ///< a file of displacements and rotations; empty: none
  bool is_steered = false;           ///< a program changes its motion as the run goes on (Session)
  // Of a rigid body that moves by the forces on it, whose `velocity` is that at the start:
  std::optional<double> mass, density;
  std::vector<double> inertia, centre_of_mass;  ///< empty: those of its shape
  std::vector<double> spin;                     ///< at the start; empty: none
  std::vector<Expression> force, torque;        ///< of t; empty: none
  std::vector<double> spring, damper;           ///< to where it starts, per direction; empty: none
  double rotation_spring = 0.0, rotation_damper = 0.0;
  std::vector<std::string> hold;  ///< "x", "y", "z", "rotation"
  [[nodiscard]] bool is_free() const { return mass || density; }
};

struct ContactSection {
  std::string group;      ///< without obstacle and against the surfaces of bodies, each of which may touch every other
  std::string obstacle;   ///< empty: between bodies
  std::string against;    ///< the other group; empty: an obstacle
  double friction = 0.0;  ///< F of Coulomb's law
  double friction_bound = 0.0;  ///< largest friction traction, a stress; 0: no bound
  std::string multipliers = "nodal";
  std::string multipliers_on = "automatic";  ///< between bodies: "automatic", "group" or "against"
  bool slides_far = false;                   ///< sliding = "large"
  bool closed_gaps = false;                  ///< initial_gap = "closed"
  bool tied = false;
  std::vector<double> pair_at;  ///< empty: where bodies start
  bool allow_unstable_multipliers = false;

  /// Stands for the contacts of every body with every other (ModelContact).
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
  Expression value;  ///< of x, y, z, t: positive where it presses
};

struct LoadSection {
  std::vector<double> gravity;         ///< acceleration; empty: none
  std::vector<Expression> body_force;  ///< of x, y, z, t: force per volume; empty: none
};

struct InitialSection {
  bool static_equilibrium = false;       ///< displacement = "static"
  std::vector<Expression> displacement;  ///< of x, y, z; empty: zero
  std::vector<Expression> velocity;      ///< of x, y, z; empty: zero
};

/// Cells that move like a rigid body at t = 0: a [[motion]], `velocity` and `spin` of a part, or what was dropped.
struct MotionSection {
  std::string section;           ///< where it stands: "motion.0", "part.ball", "mesh"
  std::string group;             ///< of cells; empty for those of a part, or of all of the mesh
  std::string part;              ///< its name; empty for those of a group, or of all of the mesh
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
  double step = 0.0;      ///< the longest of adaptive ones
  double end = 0.0;
  bool adaptive = false;
  double tolerance = 0.0, smallest = 0.0;  ///< of adaptive steps
};

/// Number of steps to the end time; the last step ends at or after it. Of adaptive ones as if each were the longest.
[[nodiscard]] long step_count(const TimeSection& time);

/// One of: a point, a segment, a boundary, a group, a contact.
struct ProbeSection {
  std::string name;
  std::vector<double> at;        ///< a point
  std::vector<double> from, to;  ///< a segment
  std::optional<double> within;  ///< of the segment: distance of its nodes
  std::string boundary;          ///< a group of facets: force and moment
  std::vector<double> about;     ///< of the moment; empty: the origin
  std::string group;             ///< of cells or facets: averages and extrema
  std::optional<long> contact;   ///< an index of [[contact]]
  long every = 0;                ///< steps, into a file of their own; 0: with the rows of history.csv
};

struct OutputSection {
  std::optional<long> fields_every;       ///< steps; absent: chosen so that about a hundred frames are written; 0: none
  std::optional<double> fields_interval;  ///< time, instead of fields_every
  std::vector<std::string> fields;        ///< names, also "all"; empty: the usual ones
  bool vtkhdf = false;                    ///< else XDMF
  bool single_precision = false;          ///< of fields
  int compression = 0;
  std::optional<long> history_every;  ///< none: as the scheme says
  long checkpoint_every = 0;          ///< steps; 0: by time only
  double checkpoint_seconds = 300.0;  ///< of the clock on the wall; 0: by steps only
};

struct CheckSection {
  double energy_residual = 1e-8;   ///< relative to the largest energy; 0: not checked
  double momentum = 1e-8;          ///< relative to the momenta of all bodies and the sum of all impulses
  double angular_momentum = 1e-8;  ///< likewise, times the distance of the body from the origin
  bool stops = false;              ///< the run ends where an account does not close, else it warns
};

struct SolverSection {
  std::string method = "auto";
  double tolerance = 1e-10;
  std::optional<double> memory;  ///< GB
  std::string preconditioner = "auto";
  std::string contact_points = "near";
};

struct ExpectSection {
  std::string name = {};  ///< the quantity in words; may be empty
  std::string quantity = {};
  std::string over = {};  ///< a quantity by which it is divided; may be empty
  double times = 1.0;     ///< factor of the quantity
  double value = 0.0;
  std::optional<double> relative = {}, absolute = {};  ///< tolerances; at least one
  std::optional<double> minimum = {}, maximum = {};    ///< instead of value: bounds
  std::string published = {};                          ///< what others publish for it; may be empty
  std::map<std::string, std::string> when = {};  ///< key path → value as text: only checked in runs where they hold
};

struct Case {
  std::string path;  ///< of the case file
  std::string title;
  MeshSection mesh;
  std::vector<PartSection> parts;  ///< in the order of the file; none: the mesh is that of [mesh]
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
  /// Names in the lists of groups, by the text that stands in the sections' `group` (and `boundary`) for them.
  std::map<std::string, std::vector<std::string>> group_lists;
  std::vector<std::string> overridden;              ///< key paths given by --set
  std::map<std::string, SourceLocation> locations;  ///< key path ("contact.0.group") → where it stands
  std::map<std::string, std::string> values;        ///< key path → value as text, defaults included, for `when`

  /// Location of a key path, or of the nearest enclosing section, or of the file.
  [[nodiscard]] SourceLocation where(const std::string& key_path) const;
};

}  // namespace ricochet
