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

/// @file Summary of a run, in summary.json. docs/summary-file.md explains the entries with the texts of
/// summary_description.cpp and summary_results.cpp; comments here add what only the program knows.
namespace ricochet {

/// Result of one [[expect]] entry.
struct ExpectationResult {
  std::string name = {}, quantity = {}, published = {};
  double value = 0.0;
  std::string expected = {};
  std::optional<double> expected_value = {}, tolerance = {};  ///< both or none
  std::optional<double> minimum = {}, maximum = {};
  std::string location = {};
  bool checked = true, holds = true;
  std::string note = {};

  /// Name in lists.
  [[nodiscard]] const std::string& label() const { return name.empty() ? quantity : name; }
};

/// Balance that a run must satisfy.
struct CheckResult {
  std::string name;
  double limit = 0.0, largest = 0.0;
};

/// Initial pairing of the two groups of a contact between bodies.
struct PairingDescription {
  std::string multipliers_on, reason;
  long points = 0;
  double covered = 0.0, smallest_gap = 0.0, largest_gap = 0.0;
};

/// [[contact]] entry of a run, or one of the pairs of bodies that it represents.
struct ContactDescription {
  std::string group, opponent, multipliers;  ///< the opponent: an obstacle, or a group of another body
  double friction = 0.0, friction_bound = 0.0;
  std::vector<double> obstacle_velocity = {};
  double obstacle_rotation_rate = 0.0;
  bool between_bodies = false, tied = false;
  std::optional<PairingDescription> facing = {};  ///< null for an obstacle
  std::string all_pairs_group = {};               ///< empty unless the entry is for every body against every other
  bool obstacle_moves_freely = false;
};

/// Body of the mesh, and the time for which its contact must be lost for an impact to end.
struct BodyDescription {
  RigidBody rigid;
  double separation = 0.0;
  std::string name = {};
};

/// Rotations of cells, from the rows of the history.
struct RotationReport {
  double limit = 0.0;                                            ///< infinite: the laws hold for any rotation
  double time_beyond = std::numeric_limits<double>::infinity();  ///< infinite if none
  std::vector<double> until_impact_end;

  /// Returns whether the limit holds up to the end of an impact. Impacts that are not listed are later ones.
  [[nodiscard]] bool holds_in_impact(std::size_t impact) const {
    return impact < until_impact_end.size() ? until_impact_end[impact] <= limit : !std::isfinite(time_beyond);
  }
};

/// Distribution on several processes; communication per step is the maximum over processes.
struct ProcessReport {
  int count = 0;
  long least_dofs = 0, most_dofs = 0;
  double messages_per_step = 0.0, bytes_per_step = 0.0, reductions_per_step = 0.0;
};

/// Costs of the iterative method per step.
struct IterationReport {
  double schwarz_iterations_per_step = 0.0, gradients_per_step = 0.0;
};

/// Largest von Mises stress of a run and its location.
struct PeakStressDescription {
  PeakStressResult peak;
  std::vector<double> position;
  std::int64_t element = 0;
  std::string material;
};

/// Energy that the time discretization, and nothing in the model, has created: contact_work less numerical_dissipation
/// and the change of algorithmic_energy, of every step. Relative to energy_scale().
struct MethodEnergy {
  double lost = 0.0, created = 0.0, at_end = 0.0;
};

/// Reactions that acted over the steps, for schemes with a choice.
struct ActingReactions {
  std::string kind;
  /// Weights of the end reactions in the means that acted; least_weight exceeds largest_weight if no mean acted.
  double least_weight = std::numeric_limits<double>::infinity(), largest_weight = -least_weight;
  long mean_steps = 0, end_steps = 0;
};

/// Corrections of the velocities that close the balance of energy of steps at finite strain. Shares are kinetic
/// energies that they add or remove in a step, relative to kinetic and elastic energy at its end.
struct VelocityCorrections {
  /// Share above which they are reported: twice the largest one of the cases of the collection.
  static constexpr double noticeable = 1e-4;
  long steps = 0;                                               ///< with a share above it
  double first_time = std::numeric_limits<double>::infinity();  ///< of the first one; infinite if there is none
  double largest = 0.0, time = 0.0;                             ///< largest share of all steps
};

/// Adaptive steps.
struct AdaptiveSteps {
  double tolerance = 0.0, time = 0.0;
  StepCounts counts = {};
};

/// Node of a probe.
struct ProbeDescription {
  Probe probe;
  std::vector<double> position;  ///< reference configuration
};

struct RunSummary {
  std::string status = "done", message;
  bool steered = false;
  std::string case_file, title, version, scheme, mass, mass_built, libraries;
  std::vector<std::string> overrides;
  std::string case_path;
  std::vector<std::string> settings;
  std::map<std::string, std::string> parameters = {};
  int dimension = 2, degree = 1;
  Index nodes = 0, cells = 0, dofs = 0, contact_points = 0, supported_dofs = 0;
  std::size_t factor_entries = 0;
  std::string solver = "direct", solver_reason;
  std::optional<ProcessReport> processes = {};     ///< null for a single process
  std::optional<IterationReport> iterations = {};  ///< null if steps are solved directly
  double step = 0.0, end_time = 0.0;
  double critical_step = std::numeric_limits<double>::infinity();  ///< infinite if any step is stable
  std::optional<AdaptiveSteps> adaptive = {};                      ///< null if all steps have the same length, `step`
  long steps = 0, all_steps = 0;
  std::vector<long> resumed_at = {};
  long checkpoint_step = -1;                         ///< −1 if there is none
  double energy_instant = 0.0, force_instant = 0.0;  ///< relative to a row's time, in steps
  long history_every = 1, frames = 0;
  std::vector<ContactDescription> contacts;
  std::vector<ProbeDescription> probes;
  std::vector<std::pair<std::string, std::string>> probe_sums = {};  ///< names, and forces in words
  std::vector<std::pair<std::string, double>> timings;
  double time_per_step = 0.0, processor_seconds = 0.0, peak_memory = 0.0;
  std::vector<std::string> columns;
  std::vector<ColumnDigest> digests;  ///< per column
  std::vector<CheckResult> checks = {};
  std::vector<BodyDescription> bodies = {};
  std::vector<Impact> impacts = {};
  long impacts_left_out = 0;
  std::optional<PeakStressDescription> peak_stress;
  MethodEnergy method_energy = {};
  std::optional<ActingReactions> reactions = {};                 ///< null: scheme without a choice
  double distortion_energy = 0.0;                                ///< largest energy of the control of distorted cells
  std::optional<VelocityCorrections> velocity_corrections = {};  ///< null: scheme or law without them
  RotationReport rotation = {};
  std::vector<PairSliding> sliding = {};         ///< per contact between bodies
  std::vector<UnsettledContact> unsettled = {};  ///< contacts with large sliding in which frozen steps have left gaps
  /// Penetration without contact; that of contact points is a column of the history.
  PenetrationReport penetration = {.not_watched = {"everything except contact nodes"}};
  std::vector<std::string> warnings;
  std::vector<ExpectationResult> expectations;
  std::string contact_export;  ///< on the export of contact problems, in words; not in the file

  /// "equivalent", or "equivalent, built as equivalent-cellwise".
  [[nodiscard]] std::string mass_text() const;
  /// Digest of a column; zeros if there is no such column.
  [[nodiscard]] ColumnDigest digest(const std::string& column) const;
  /// Whether the history has a row. Before, nothing is known of energies, rotations and penetration.
  [[nodiscard]] bool is_recorded() const { return !columns.empty(); }
  /// Time that the run has reached.
  [[nodiscard]] double time() const { return adaptive ? adaptive->time : double(steps) * step; }
  /// Completed fraction of the run, 0 to 1.
  [[nodiscard]] double part_done() const;
  /// Offset of the values of this column from the time of their row: energies and forces are those at the scheme's own
  /// instants.
  [[nodiscard]] double delay_of(const std::string& column) const;
  /// First impact with a restitution, and the one with the largest force; null if there is none.
  [[nodiscard]] const Impact* first_restitution() const;
  [[nodiscard]] const Impact* hardest_impact() const;
  [[nodiscard]] std::size_t number_of(const Impact& impact) const { return std::size_t(&impact - impacts.data()); }
  /// Scale of the energy account: maximum of |first|, |minimum|, |maximum| of total, kinetic and elastic energy.
  [[nodiscard]] double energy_scale() const;
  /// Returns false if, when an impact (numbered from 0) ended, cells had rotated too far for small strain, or the
  /// rotation of the whole body had changed the impact (rotation_growth.hpp).
  [[nodiscard]] bool small_strain_holds_in(std::size_t impact) const;
  /// The first condition, or both, for all impacts; in a run without impacts at all times.
  [[nodiscard]] bool cells_turn_little_in_impacts() const;
  [[nodiscard]] bool small_strain_holds_in_impacts() const;
  /// Deepest penetration, at contact points and elsewhere; unless the checks are complete (penetration.is_complete),
  /// the actual one may be deeper.
  [[nodiscard]] double deepest_penetration() const;
  /// Largest |work| of any kind. Works that cancel may be far larger than all energies.
  [[nodiscard]] double work_scale() const;
};

[[nodiscard]] std::string to_json(const RunSummary& summary);
/// JSON Schema of summary.json, with a description of each entry.
[[nodiscard]] std::string summary_schema();
/// Writes to a temporary name and renames the file. Throws Error(file_access).
void write_summary(const std::string& path, const RunSummary& summary);
/// Throws Error(file_access) or Error(invalid_input), also for a file of another version (file_version.hpp).
[[nodiscard]] RunSummary read_summary(const std::string& path);
/// Parses a summary; `path` is for messages.
[[nodiscard]] RunSummary summary_from_json(const std::string& text, const std::string& path);
/// Returns the summary in a directory, or none if it is missing or damaged: unlike checkpoints it is not synced to the
/// disk. Throws Error(invalid_input) for one of another version.
[[nodiscard]] std::optional<RunSummary> find_intact_summary(const std::string& directory);
/// Reads the summary of the run in a directory. Throws likewise; messages describe the content of the directory.
[[nodiscard]] RunSummary read_summary_of_run(const std::string& directory);
/// Reads its text. Throws Error(file_access) likewise.
[[nodiscard]] std::string summary_text_of_run(const std::string& directory);
/// Returns the reason why no summary.json has a number at a dotted path, with the path that was probably meant; "" if
/// one may have it.
[[nodiscard]] std::string summary_path_problem(const std::string& path);
/// Returns a number of a summary by its dotted path ("extrema.total_energy.maximum", "steps"). Throws
/// Error(invalid_input).
[[nodiscard]] double summary_value(const std::string& json_text, const std::string& path);

}  // namespace ricochet
