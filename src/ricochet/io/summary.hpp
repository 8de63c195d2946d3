#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/simulation/history/column_digest.hpp"
#include "ricochet/simulation/history/probe.hpp"
#include "ricochet/simulation/impact/impact.hpp"
#include "ricochet/simulation/monitor/peak_stress_result.hpp"
#include "ricochet/simulation/monitor/penetration_report.hpp"
#include "ricochet/simulation/monitor/sliding_report.hpp"
#include "ricochet/simulation/step_counts.hpp"

/// @file summary.json: description of the run, sizes, timings, extrema, warnings.
namespace ricochet {

/// Result of one [[expect]] entry.
struct ExpectationResult {
  std::string name = {};                                      ///< the quantity in words; may be empty
  std::string quantity = {};                                  ///< as in the case, with its factor and its divisor
  std::string published = {};                                 ///< published value, in words; may be empty
  double value = 0.0;                                         ///< computed; 0 if it was not or could not be checked
  std::string expected = {};                                  ///< in words, and in numbers:
  std::optional<double> expected_value = {}, tolerance = {};  ///< absolute; both or none
  std::optional<double> minimum = {}, maximum = {};
  std::string location = {};  ///< in the case file
  bool checked = true;        ///< false: does not apply to this run, see `note`
  bool holds = true;
  std::string note = {};  ///< reason why it was not or could not be checked

  /// Name in lists.
  [[nodiscard]] const std::string& label() const { return name.empty() ? quantity : name; }
};

/// Balance that a run must satisfy.
struct CheckResult {
  std::string name;
  double limit = 0.0;    ///< relative; 0: not checked
  double largest = 0.0;  ///< largest error, relative
};

/// Initial pairing of the two groups of a contact between bodies.
struct PairingDescription {
  std::string multipliers_on;  ///< the group that carries the multipliers
  std::string reason;          ///< reason for this choice; empty: prescribed by the case
  long points = 0;
  double covered = 0.0;  ///< fraction of that group's area that faces the other one
  double smallest_gap = 0.0, largest_gap = 0.0;
};

/// [[contact]] entry of a run, or one of the pairs of bodies that it represents.
struct ContactDescription {
  std::string group, opponent, multipliers;  ///< the opponent: an obstacle, or a group of another body
  double friction = 0.0, friction_bound = 0.0;
  std::vector<double> obstacle_velocity = {};  ///< empty: at rest
  double obstacle_rotation_rate = 0.0;
  bool between_bodies = false;
  bool tied = false;                              ///< no multipliers, no friction
  std::optional<PairingDescription> facing = {};  ///< null for an obstacle, or if unknown
  std::string all_pairs_group = {};               ///< group of an entry for every body against every other; else empty
  bool obstacle_moves_freely = false;             ///< rigid body under forces, whose velocity is that of its start
};

/// Body of the mesh, and the time for which its contact must be lost for an impact to end.
struct BodyDescription {
  RigidBody rigid;
  double separation = 0.0;
  std::string name = {};  ///< name in messages; empty: results of a version without names of bodies
};

/// Rotations of cells, from the rows of the history.
struct RotationReport {
  double limit = 0.0;  ///< above it small strain does not hold; infinite: the laws hold for any rotation
  double time_beyond = std::numeric_limits<double>::infinity();  ///< of the first row above it; infinite if none
  std::vector<double> until_impact_end;  ///< largest rotation up to the end of each impact, or so far

  /// Returns whether the limit holds up to the end of an impact. Impacts that are not listed are later ones.
  [[nodiscard]] bool holds_in_impact(std::size_t impact) const {
    return impact < until_impact_end.size() ? until_impact_end[impact] <= limit : !std::isfinite(time_beyond);
  }
};

/// Distribution on several processes; communication per step is the maximum over processes.
struct ProcessReport {
  int count = 0;
  long least_dofs = 0, most_dofs = 0;  ///< per process, including shared ones
  double messages_per_step = 0.0, bytes_per_step = 0.0, reductions_per_step = 0.0;
};

/// Costs of the iterative method per step.
struct IterationReport {
  double schwarz_iterations_per_step = 0.0;  ///< alternating iterations of subdomains and conjugate gradients
  double gradients_per_step = 0.0;           ///< iterations of conjugate gradients
};

/// Largest von Mises stress of a run and its location.
struct PeakStressDescription {
  PeakStressResult peak;
  std::vector<double> position;  ///< centre of the cell, reference configuration
  std::int64_t element = 0;      ///< number of the cell in the mesh file
  std::string material;
};

/// Energy that the time discretization, and nothing in the model, has created: contact_work less numerical_dissipation
/// and the change of algorithmic_energy, of every step. Relative to energy_scale().
struct MethodEnergy {
  double lost = 0.0, created = 0.0;  ///< largest deficit and largest excess since the start
  double at_end = 0.0;               ///< negative: deficit
};

/// Reactions that acted over the steps, for schemes with a choice.
struct ActingReactions {
  std::string kind;  ///< "end", "mean" or "adaptive"
  /// Weights of the end reactions in the means that acted; least_weight exceeds largest_weight if no mean acted.
  double least_weight = std::numeric_limits<double>::infinity(), largest_weight = -least_weight;
  long mean_steps = 0;  ///< number of steps with contact in which a mean acted
  long end_steps = 0;   ///< likewise, in which the end reactions acted, as no mean was found
};

/// Adaptive steps.
struct AdaptiveSteps {
  double tolerance = 0.0;
  double time = 0.0;  ///< reached
  StepCounts counts = {};
};

struct RunSummary {
  std::string status = "done";  ///< "running", "done", "failed" or "interrupted"
  std::string message;          ///< of the failure or the interruption
  bool steered = false;         ///< by a program that applies loads or moves obstacles: other programs cannot resume it
  std::string case_file, title, version, scheme, mass;
  std::string mass_built;  ///< construction used for `mass`; empty in results without this entry
  std::string libraries;
  std::vector<std::string> overrides;                  ///< key paths given by --set
  std::string case_path;                               ///< absolute: required, with `settings`, by --resume
  std::vector<std::string> settings;                   ///< as given to --set
  std::map<std::string, std::string> parameters = {};  ///< all entries of the case: key path → value as text
  int dimension = 2;
  int degree = 1;
  Index nodes = 0, cells = 0, dofs = 0, contact_points = 0, supported_dofs = 0;
  std::size_t factor_entries = 0;
  std::string solver = "direct";                   ///< or "iterative"
  std::string solver_reason;                       ///< reason for this choice
  std::optional<ProcessReport> processes = {};     ///< null for a single process
  std::optional<IterationReport> iterations = {};  ///< null if steps are solved directly
  double step = 0.0, end_time = 0.0;               ///< for adaptive steps the longest possible
  double critical_step =
      std::numeric_limits<double>::infinity();  ///< the scheme is unstable above it; infinite if none
  std::optional<AdaptiveSteps> adaptive = {};   ///< null if all steps have the same length, `step`
  long steps = 0;
  long all_steps = 0;                                ///< requested
  std::vector<long> resumed_at = {};                 ///< steps after which the run was resumed
  long checkpoint_step = -1;                         ///< of the newest checkpoint; −1 if none
  double energy_instant = 0.0, force_instant = 0.0;  ///< relative to a row's time, in steps
  long history_every = 1;                            ///< steps between rows; extrema and total variations are over rows
  long frames = 0;
  std::vector<ContactDescription> contacts;
  std::vector<Probe> probes;
  std::vector<std::vector<double>> probe_positions;
  /// Names of probes of boundaries and contacts, and the forces that they sum, in words.
  std::vector<std::pair<std::string, std::string>> probe_sums = {};
  std::vector<std::pair<std::string, double>> timings;  ///< seconds by phase
  double time_per_step = 0.0;                           ///< seconds
  double processor_seconds = 0.0;                       ///< of all threads; 0: results of a version without it
  double peak_memory = 0.0;                             ///< bytes, of the process with the largest one; 0: likewise
  std::vector<std::string> columns;
  std::vector<ColumnDigest> digests;  ///< per column, over the written rows
  std::vector<CheckResult> checks = {};
  std::vector<BodyDescription> bodies = {};
  std::vector<Impact> impacts = {};
  long impacts_left_out = 0;  ///< only counted
  std::optional<PeakStressDescription> peak_stress;
  std::optional<MethodEnergy> method_energy = {};  ///< null: results of a version without it
  std::optional<ActingReactions> reactions = {};   ///< null: scheme without a choice, or likewise
  std::optional<RotationReport> rotation = {};     ///< null: results of a version without it
  std::vector<PairSliding> sliding = {};           ///< per contact between bodies
  std::vector<UnsettledContact> unsettled = {};    ///< contacts with large sliding in which frozen steps have left gaps
  PenetrationReport penetration = {};  ///< without contact; that of contact points is a column of the history
  std::vector<std::string> warnings;
  std::vector<ExpectationResult> expectations;
  std::string contact_export;  ///< on the export of contact problems, in words; not in the file

  /// "equivalent", or "equivalent, built as equivalent-cellwise".
  [[nodiscard]] std::string mass_text() const;
  /// Digest of a column; zeros if there is no such column.
  [[nodiscard]] ColumnDigest digest(const std::string& column) const;
  /// Time that the run has reached.
  [[nodiscard]] double time() const { return adaptive ? adaptive->time : static_cast<double>(steps) * step; }
  /// Completed fraction of the run, 0 to 1.
  [[nodiscard]] double part_done() const;
  /// Offset of the values of this column from the time of their row: energies and forces are those at the scheme's own
  /// instants.
  [[nodiscard]] double delay_of(const std::string& column) const;
  /// Scale of the energy account: maximum of |first|, |minimum|, |maximum| of total, kinetic and elastic energy.
  [[nodiscard]] double energy_scale() const;
  /// Energy that contact forces and the scheme have removed or created, relative to energy_scale(); no real body loses
  /// it. 0 if there is no energy. For older results computed from the rows of the history.
  [[nodiscard]] double loss_by_method() const;
  [[nodiscard]] double creation_by_method() const;
  /// Returns false if cells had rotated too far for small strain when an impact (numbered from 0) ended.
  [[nodiscard]] bool cells_turn_little_in(std::size_t impact) const;
  /// Also returns false if the rotation of the whole body has changed the impact (rotation_growth.hpp).
  [[nodiscard]] bool small_strain_holds_in(std::size_t impact) const;
  /// Largest rotation for which the laws of this run hold; infinite at finite strain.
  [[nodiscard]] double largest_rotation() const;
  /// As above for all impacts; in a run without impacts at all times.
  [[nodiscard]] bool cells_turn_little_in_impacts() const;
  [[nodiscard]] bool small_strain_holds_in_impacts() const;
  /// Deepest penetration, at contact points and elsewhere; if the results contain no check elsewhere
  /// (penetration.checked), the actual one may be deeper.
  [[nodiscard]] double deepest_penetration() const;
  /// Largest |work| of any kind. Works that cancel may be far larger than all energies.
  [[nodiscard]] double work_scale() const;
};

[[nodiscard]] std::string to_json(const RunSummary& summary);
/// Writes to a temporary name and renames the file. Throws Error(file_access).
void write_summary(const std::string& path, const RunSummary& summary);
/// Throws Error(file_access) or Error(invalid_input).
[[nodiscard]] RunSummary read_summary(const std::string& path);
/// Parses a summary; `path` is for messages.
[[nodiscard]] RunSummary summary_from_json(const std::string& text, const std::string& path);
/// Reads the summary of the run in a directory. Throws likewise; messages describe the content of the directory.
[[nodiscard]] RunSummary read_summary_of_run(const std::string& directory);
/// Reads its text. Throws Error(file_access) likewise.
[[nodiscard]] std::string summary_text_of_run(const std::string& directory);
/// Returns a number of a summary by its dotted path ("extrema.total_energy.maximum", "steps"). Throws
/// Error(invalid_input).
[[nodiscard]] double summary_value(const std::string& json_text, const std::string& path);

}  // namespace ricochet
