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

/// @file summary.json: what ran, sizes, timings, extrema, warnings.
namespace ricochet {

/// Outcome of one [[expect]] entry.
struct ExpectationResult {
  std::string name = {};                                    ///< the quantity in words; may be empty
  std::string quantity = {};                                ///< as the case has it, with its factor and its divisor
  std::string published = {};                               ///< what others publish for it; may be empty
  double value = 0.0;                                       ///< found; 0 where it was not checked, or could not be
  std::string wanted = {};                                  ///< in words, and in numbers:
  std::optional<double> wanted_value = {}, tolerance = {};  ///< absolute; both or none
  std::optional<double> minimum = {}, maximum = {};
  std::string location = {};  ///< in the case file
  bool checked = true;        ///< false: does not apply to this run, see `note`
  bool holds = true;
  std::string note = {};  ///< why it was not checked, or could not be

  /// What lists call it.
  [[nodiscard]] const std::string& label() const { return name.empty() ? quantity : name; }
};

/// An account that a run must keep.
struct CheckResult {
  std::string name;
  double limit = 0.0;    ///< relative; 0: not checked
  double largest = 0.0;  ///< what was missing, relative
};

/// How the two groups of a contact between bodies face each other at the start.
struct FacingDescription {
  std::string multipliers_on;  ///< the group that carries the multipliers
  std::string reason;          ///< why that one; empty: the case says so
  long points = 0;
  double covered = 0.0;  ///< part of that group's area that faces the other one
  double smallest_gap = 0.0, largest_gap = 0.0;
};

/// A [[contact]] entry as it ran, or one of the pairs of bodies that it stands for.
struct ContactDescription {
  std::string group, opponent, multipliers;  ///< the opponent: an obstacle, or a group of another body
  double friction = 0.0, friction_bound = 0.0;
  std::vector<double> obstacle_velocity = {};  ///< empty: at rest
  double obstacle_rotation_rate = 0.0;
  bool between_bodies = false;
  bool tied = false;                             ///< glued: no multipliers, no friction
  std::optional<FacingDescription> facing = {};  ///< none: an obstacle, or it is not known
  std::string pair_of = {};  ///< the group of an entry that stands for every body against every other; else empty
};

/// A body of the mesh, and how long its contact must be lost for an impact to have ended.
struct BodyDescription {
  RigidBody rigid;
  double separation = 0.0;
  std::string name = {};  ///< what messages call it; empty: results of a version that did not name bodies
};

/// How far cells have turned, by the rows of the history.
struct RotationReport {
  double limit = 0.0;  ///< above it small strain does not hold; infinite: the laws hold for any rotation
  double time_beyond = std::numeric_limits<double>::infinity();  ///< of the first row above it; infinite: there is none
  std::vector<double> until_impact_end;  ///< the largest so far when each impact ended, or so far

  /// Whether it holds up to the end of an impact. Impacts that are not listed are later ones.
  [[nodiscard]] bool holds_in_impact(std::size_t impact) const {
    return impact < until_impact_end.size() ? until_impact_end[impact] <= limit : !std::isfinite(time_beyond);
  }
};

/// Of several processes, and of what they send in a step the most that one of them does.
struct ProcessReport {
  int count = 0;
  long least_dofs = 0, most_dofs = 0;  ///< of each, shared ones too
  double messages_per_step = 0.0, bytes_per_step = 0.0, reductions_per_step = 0.0;
};

/// Of the iterative method, in a step.
struct IterationReport {
  double rounds_per_step = 0.0;     ///< of contact zones and conjugate gradients in turn
  double gradients_per_step = 0.0;  ///< iterations of conjugate gradients
};

/// The largest von Mises stress of a run, and where it was.
struct PeakStressDescription {
  PeakStressResult peak;
  std::vector<double> place;  ///< centre of the cell, reference configuration
  std::int64_t element = 0;   ///< the cell's number in the mesh file
  std::string material;
};

/// What the discretization of time, and nothing of the model, has done to the energy: contact_work less
/// numerical_dissipation and the change of algorithmic_energy, of every step. As parts of energy_scale().
struct MethodEnergy {
  double lost = 0.0, created = 0.0;  ///< the most that was missing, and the most that was too much, since the start
  double at_end = 0.0;               ///< negative: missing
};

/// Which reactions acted over the steps, where the scheme has a choice.
struct ActingReactions {
  std::string kind;  ///< "end", "mean" or "adaptive"
  /// Of the reactions at the end in the means that acted; the least is above the largest where none did.
  double least_weight = std::numeric_limits<double>::infinity(), largest_weight = -least_weight;
  long mean_steps = 0;  ///< with contact, in which a mean acted
  long end_steps = 0;   ///< in which the end reactions had to, as no mean was found
};

/// Steps whose length follows the motion.
struct AdaptiveSteps {
  double tolerance = 0.0;
  double time = 0.0;  ///< reached
  StepCounts counts = {};
};

struct RunSummary {
  std::string status = "done";  ///< "running", "done", "failed" or "interrupted"
  std::string message;          ///< of the failure or the interruption
  bool steered = false;         ///< by a program that loads it or moves its obstacles: no other can go on with it
  std::string case_file, title, version, scheme, mass;
  std::string mass_built;  ///< the construction that was used for `mass`; empty in results that do not say it
  std::string libraries;
  std::vector<std::string> overrides;                  ///< key paths given by --set
  std::string case_path;                               ///< absolute: with `settings` what --resume needs to know
  std::vector<std::string> settings;                   ///< as given to --set
  std::map<std::string, std::string> parameters = {};  ///< all entries of the case: key path → value as text
  int dimension = 2;
  int degree = 1;
  Index nodes = 0, cells = 0, dofs = 0, contact_points = 0, supported_dofs = 0;
  std::size_t factor_entries = 0;
  std::string solver = "direct";                   ///< or "iterative"
  std::string solver_reason;                       ///< why that one
  std::optional<ProcessReport> processes = {};     ///< none where there is one
  std::optional<IterationReport> iterations = {};  ///< none where steps are solved directly
  double step = 0.0, end_time = 0.0;               ///< of adaptive steps the longest possible
  double critical_step =
      std::numeric_limits<double>::infinity();  ///< above it the scheme is unstable; none if infinite
  std::optional<AdaptiveSteps> adaptive = {};   ///< none where all steps are of one length, `step`
  long steps = 0;
  long all_steps = 0;                                ///< that were asked for
  std::vector<long> resumed_at = {};                 ///< steps after which the run was resumed
  long checkpoint_step = -1;                         ///< of the newest checkpoint; −1: none
  double energy_instant = 0.0, force_instant = 0.0;  ///< relative to a row's time, in steps
  long history_every = 1;                            ///< steps between rows, of which extrema and total variations are
  long frames = 0;
  std::vector<ContactDescription> contacts;
  std::vector<Probe> probes;
  std::vector<std::vector<double>> probe_positions;
  /// Names of probes of boundaries and contacts, and which forces they sum, in words.
  std::vector<std::pair<std::string, std::string>> probe_sums = {};
  std::vector<std::pair<std::string, double>> timings;  ///< seconds by phase
  double time_per_step = 0.0;                           ///< seconds
  double processor_seconds = 0.0;                       ///< of all threads; 0: results of a version that did not tell
  double peak_memory = 0.0;                             ///< in bytes, of the process that had most; 0: likewise
  std::vector<std::string> columns;
  std::vector<ColumnDigest> digests;  ///< per column, over the rows written
  std::vector<CheckResult> checks = {};
  std::vector<BodyDescription> bodies = {};
  std::vector<Impact> impacts = {};
  long impacts_left_out = 0;  ///< that were only counted
  std::optional<PeakStressDescription> peak_stress;
  std::optional<MethodEnergy> method_energy = {};  ///< none: results of a version that did not tell
  std::optional<ActingReactions> reactions = {};   ///< none: the scheme has no choice, or likewise
  std::optional<RotationReport> rotation = {};     ///< none: results of a version that did not tell
  std::vector<PairSliding> sliding = {};           ///< of each contact between bodies
  std::vector<UnsettledContact> unsettled = {};    ///< contacts that slide far, where held steps have left gaps
  PenetrationReport penetration = {};  ///< where no contact is; what the contact points do is a column of the history
  std::vector<std::string> warnings;
  std::vector<ExpectationResult> expectations;
  std::string contact_export;  ///< what became of contact problems to be exported, in words; not in the file

  /// "equivalent", or "equivalent, built as equivalent-cellwise".
  [[nodiscard]] std::string mass_text() const;
  /// Digest of a column; zeros when there is no such column.
  [[nodiscard]] ColumnDigest digest(const std::string& column) const;
  /// That the run has reached.
  [[nodiscard]] double time() const { return adaptive ? adaptive->time : static_cast<double>(steps) * step; }
  /// Of the run, 0 to 1.
  [[nodiscard]] double part_done() const;
  /// How much later than its row's time a value of this column is: energies and forces are those of the scheme's own
  /// instants.
  [[nodiscard]] double delay_of(const std::string& column) const;
  /// Largest |total_energy| + |algorithmic_energy| bound, the scale of the energy account: max of |first|, |min|, |max|
  /// of total energy and of kinetic and elastic energy.
  [[nodiscard]] double energy_scale() const;
  /// What contact forces and the scheme itself have taken away (and put in), over energy_scale(): no real body loses
  /// it. 0 where there is no energy. Of older results by the rows of the history.
  [[nodiscard]] double loss_by_method() const;
  [[nodiscard]] double creation_by_method() const;
  /// False where cells had turned too far for small strain when an impact (numbered from 0) ended.
  [[nodiscard]] bool cells_turn_little_in(std::size_t impact) const;
  /// Moreover false where the turn of the whole body has changed the impact (turn_growth.hpp).
  [[nodiscard]] bool small_strain_holds_in(std::size_t impact) const;
  /// That the laws of this run allow; infinite at finite strain.
  [[nodiscard]] double largest_rotation() const;
  /// The same of all impacts; of a run without any at all times.
  [[nodiscard]] bool cells_turn_little_in_impacts() const;
  [[nodiscard]] bool small_strain_holds_in_impacts() const;
  /// The deepest interpenetration of all, at contact points and elsewhere; of results that did not look elsewhere
  /// (penetration.checked) it may be deeper.
  [[nodiscard]] double deepest_penetration() const;
  /// Largest |work| of any kind. Works that cancel may be far larger than all energies.
  [[nodiscard]] double work_scale() const;
};

[[nodiscard]] std::string to_json(const RunSummary& summary);
/// Written to a temporary name and moved into place. Throws Error(file_access).
void write_summary(const std::string& path, const RunSummary& summary);
/// Throws Error(file_access) or Error(invalid_input).
[[nodiscard]] RunSummary read_summary(const std::string& path);
/// The same of a text; `path` is for messages.
[[nodiscard]] RunSummary summary_from_json(const std::string& text, const std::string& path);
/// That of the run in a directory. Throws likewise; messages say what is in the directory.
[[nodiscard]] RunSummary read_summary_of_run(const std::string& directory);
/// A number of a summary by its dotted path ("extrema.total_energy.maximum", "steps"). Throws Error(invalid_input).
[[nodiscard]] double summary_value(const std::string& json_text, const std::string& path);

}  // namespace ricochet
