#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/model/model.hpp"
#include "ricochet/run/run_case.hpp"
#include "ricochet/simulation/simulation.hpp"

/// @file A case that is open: its model, its scheme, its simulation and its warnings, step by step.
///
///   Session session("case.toml", {"time.step=1e-4"});
///   session.write_to({.output_directory = "out/a"});      // leave this out, and nothing is written
///   while (session.step()) look(session.state());
///   const RunSummary summary = session.finish();
///
/// One session at a time runs in a process, on all of its threads: warnings, signals and the ordering of matrices
/// (METIS draws from one generator) belong to the process, so that sessions on several threads at once may give other
/// bits. Studies run one process per case.
namespace ricochet {

class Run;

/// What does not fit together (a step after finish(), write_to after steps) throws Error(usage).
class Session {
 public:
  /// In snapshots: what set_load has set, and the names of the obstacles that are steered.
  static constexpr const char *load_name = "session.load", *steered_name = "session.steered";
  /// Whether a program has changed loads or motions on the way, so that the case alone does not say how it goes on.
  [[nodiscard]] static bool is_steered(const Snapshot& snapshot) {
    return snapshot.has(load_name) || snapshot.has(steered_name);
  }

  /// Reads a case file, with changes as --set makes them. Throws Error as read_case does.
  explicit Session(const std::string& path, const std::vector<std::string>& changes = {});
  /// Of a case that was read: `remarks` are the warnings that reading it said.
  explicit Session(Case input, std::vector<std::string> remarks = {});
  ~Session();
  Session(const Session&) = delete;  // its parts keep references to each other
  Session& operator=(const Session&) = delete;

  /// Builds models in another way than build_model, with the same errors. Before anything is built.
  using ModelBuilder = std::function<std::unique_ptr<Model>(const Case&, BuildTimes*)>;
  void set_model_builder(ModelBuilder builder) { builder_ = std::move(builder); }

  [[nodiscard]] const Case& input() const { return input_; }
  /// All that were said for this session, in order.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  /// Reads the mesh and builds the problem, unless that is done. Everything below does so when it is needed.
  void build(BuildTimes* times = nullptr);
  /// Finds the state at t = 0 and factorizes, unless that is done or a state was taken up.
  void start();
  /// Instead: goes on from what save() has put into a snapshot, with the same bits as without an interruption. Before
  /// the first step. Throws Error(invalid_input) where it does not fit: the case, its mesh or the version are others.
  void resume(const Snapshot& snapshot);
  /// The state, what the next steps depend on besides (the load that was set last), and of which case it is. The
  /// functions of io/checkpoint.hpp make a file of it.
  void save(Snapshot& snapshot);

  [[nodiscard]] Model& model();
  [[nodiscard]] const SemidiscreteProblem& problem() { return model().problem; }
  [[nodiscard]] Scheme& scheme();
  [[nodiscard]] Simulation& simulation();
  [[nodiscard]] const State& state() { return simulation().state(); }
  [[nodiscard]] double time() { return state().time; }
  /// Of the run, and the number of steps until there; of adaptive steps, if all were the longest.
  [[nodiscard]] double end() const { return input_.time.end; }
  [[nodiscard]] bool at_end();
  [[nodiscard]] long steps() const { return step_count(input_.time); }

  /// A force per dof that acts from now on besides the loads of the case, until it is set again. It enters the energy
  /// account as load_work. Throws Error(invalid_input) for another length and for what is not finite.
  void set_load(const Vector& force);

  /// Another velocity from now on (per dof, of all nodes), as an impulse M (V − V_before) at once would give: load_work
  /// contains the work of that. Dofs that a support prescribes, and tied ones, keep to what they follow. Throws as
  /// set_load does.
  void set_velocity(const Vector& velocity);
  /// From now on this obstacle moves with a constant velocity (d numbers) and a constant rate of its rotation vector
  /// (1 or 3 numbers, only where the case gives it a rotation; empty: none, and what was turning then stops, with a
  /// warning), from where it is; a `rotation_rate` of the case, of its surface in place, stays. The first call for an
  /// obstacle comes before start(), write_to() and any look at the state. Throws Error(usage) where it comes too late,
  /// and Error(invalid_input) where there is no such obstacle, it moves by the forces on it, or the numbers do not fit.
  void set_obstacle_velocity(const std::string& obstacle, const Vector& velocity, const Vector& rotation_rate = {});

  /// One step. False, and nothing done: the run is at its end; further calls are warned of. Throws
  /// Error(not_converged); the state is then that before the step. A session that writes says false there, and where a
  /// signal stopped it; finish() then says why.
  bool step();
  /// All steps that are left, calling `each` (if there is one) after every one.
  void run(const std::function<void()>& each = {});

  /// Before the first step: from here on the session writes what a run writes (history, fields, checkpoints, summary).
  /// With `resume` among the options it goes on with the run that is there; where that is complete, only finish() has
  /// something to say. Throws Error as run_case does.
  void write_to(RunOptions options);
  /// Writes a checkpoint of the present state of a session that writes: --resume goes on from it whatever becomes of
  /// this process. Nothing happens where the run has ended.
  void keep();
  /// The run that write_to was to go on with had come to its end before: there is no state to look at.
  [[nodiscard]] bool is_complete_already() const;
  /// Has a program set its load, or said that it moves obstacles?
  [[nodiscard]] bool is_steered() const;
  /// Ends what write_to has begun: the summary, with the expectations of the case. Before the last step the run is an
  /// interrupted one, with a checkpoint that --resume goes on from. No step can follow. Throws the error
  /// that has ended the steps, if one has.
  RunSummary finish();

 private:
  [[nodiscard]] bool take_step();
  [[nodiscard]] ObstacleSection& section_of_obstacle(const std::string& obstacle);
  void steer_from_start(ObstacleSection& section);
  [[nodiscard]] SteeredPath& steered_path(const std::string& obstacle);

  friend class Run;  // a run that goes on takes up the warnings that were said before

  Case input_;
  std::vector<std::string> changes_;  ///< that input_ was read with
  std::vector<std::string> warnings_;
  ModelBuilder builder_;  ///< none: build_model
  std::unique_ptr<Model> model_;
  std::unique_ptr<Scheme> scheme_;
  std::unique_ptr<Simulation> simulation_;
  std::shared_ptr<Vector> load_;  ///< set_load's
  RunOptions options_;
  std::unique_ptr<Run> run_;
  bool has_finished_ = false;
  int calls_at_end_ = 0;  ///< of step()
};

}  // namespace ricochet
