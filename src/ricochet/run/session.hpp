#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/model/model.hpp"
#include "ricochet/run/run_case.hpp"
#include "ricochet/simulation/simulation.hpp"

/// @file An open case: its model, its scheme, its simulation and its warnings, step by step.
///
///   Session session("case.toml", {"time.step=1e-4"});
///   session.write_to({.output_directory = "out/a"});      // optional: without it nothing is written
///   while (session.step()) use(session.state());
///   const RunSummary summary = session.finish();
///
/// One session at a time runs in a process, on all of its threads: warnings, signals and the ordering of matrices
/// (METIS uses one random generator) belong to the process, so that simultaneous sessions on several threads may change
/// the last bits of results. Studies run one process per case.
namespace ricochet {

class Run;

/// Calls in a wrong order (a step after finish(), write_to after steps) throw Error(usage).
class Session {
 public:
  /// Keys of snapshots: the load of set_load, and the names of the obstacles that are steered.
  static constexpr const char *load_name = "session.load", *steered_name = "session.steered";
  /// Returns true if a program has changed loads or motions during the run, so that the case alone does not determine
  /// how it continues.
  [[nodiscard]] static bool is_steered(const Snapshot& snapshot) {
    return snapshot.has(load_name) || snapshot.has(steered_name);
  }

  /// Reads a case file, with changes as --set makes them. Throws Error as read_case does.
  explicit Session(const std::string& path, const std::vector<std::string>& changes = {});
  /// Opens a case that has been read; `remarks` are the warnings issued while reading it.
  explicit Session(Case input, std::vector<std::string> remarks = {});
  ~Session();
  Session(const Session&) = delete;  // its parts keep references to each other
  Session& operator=(const Session&) = delete;

  /// Replaces build_model by a function that throws the same errors. Must be set before anything is built.
  using ModelBuilder = std::function<std::unique_ptr<Model>(const Case&, BuildTimes*)>;
  void set_model_builder(ModelBuilder builder) { builder_ = std::move(builder); }

  [[nodiscard]] const Case& input() const { return input_; }
  /// All warnings of this session, in order.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  /// Reads the mesh and builds the problem, unless that is done. All functions below do so if needed.
  void build(BuildTimes* times = nullptr);
  /// Computes the state at t = 0 and factorizes, unless that is done or a state has been resumed.
  void start();
  /// Resumes, in place of start(), the state that save() has put into a snapshot, with the same bits as without an
  /// interruption. Must precede the first step. Throws Error(invalid_input) if the case, its mesh or the version
  /// differs.
  void resume(const Snapshot& snapshot);
  /// Saves the state, other data on which the next steps depend (the load that was set last), and the identity of the
  /// case. The functions of io/checkpoint.hpp make a file of it.
  void save(Snapshot& snapshot);

  [[nodiscard]] Model& model();
  [[nodiscard]] const SemidiscreteProblem& problem() { return model().problem; }
  [[nodiscard]] Scheme& scheme();
  [[nodiscard]] Simulation& simulation();
  [[nodiscard]] const State& state() { return simulation().state(); }
  [[nodiscard]] double time() { return state().time; }
  /// End of the run, and the number of steps until then; with adaptive steps, the number if all were the longest.
  [[nodiscard]] double end() const { return input_.time.end; }
  [[nodiscard]] bool at_end();
  [[nodiscard]] long steps() const { return step_count(input_.time); }

  /// Sets a force per dof that acts from now on in addition to the loads of the case, until it is set again. It enters
  /// the energy account as load_work. Throws Error(invalid_input) if the length is wrong or entries are not finite.
  void set_load(const Vector& force);

  /// Sets the velocity (per dof, of all nodes), as an instantaneous impulse M (V − V_before) would; load_work contains
  /// the work of that impulse. Dofs that a support prescribes, and tied ones, keep following. Throws as set_load does.
  void set_velocity(const Vector& velocity);
  /// Moves this obstacle from now on with a constant velocity (d numbers) and a constant rate of its rotation vector (1
  /// or 3 numbers, only if the case gives it a rotation; if empty, it stops rotating, with a warning), starting from
  /// its present position; a `rotation_rate` of the case, which rotates its surface in place, stays in effect. The
  /// first call for an obstacle must precede start(), write_to() and any access to the state. Throws Error(usage) if it
  /// comes too late, and Error(invalid_input) if there is no such obstacle, it moves freely, or the numbers do not fit.
  void set_obstacle_velocity(const std::string& obstacle, const Vector& velocity, const Vector& rotation_rate = {});

  /// Computes one step. Returns false, without any effect, at the end of the run; further calls cause a warning. Throws
  /// Error(not_converged); the state is then the one before the step. A session that writes returns false in that case,
  /// and after a signal; finish() then states the reason.
  bool step();
  /// Computes all remaining steps, calling `each` (if any) after every one.
  void run(const std::function<void()>& each = {});

  /// Starts, before the first step, to write the files of a run (history, fields, checkpoints, summary). With `resume`
  /// among the options, the session resumes the run in the directory; if that is complete, only finish() has a result.
  /// Throws Error as run_case does.
  void write_to(RunOptions options);
  /// Writes a checkpoint of the present state of a session that writes: --resume goes on from it whatever happens to
  /// this process. Has no effect after the end of the run.
  void write_checkpoint_now();
  /// Returns true if the run that write_to was to resume was complete already, so that there is no state.
  [[nodiscard]] bool is_complete_already() const;
  /// Returns true if a program has set a load or steers obstacles.
  [[nodiscard]] bool is_steered() const;
  /// Ends the output that write_to has begun: the summary, with the expectations of the case. Before the last step the
  /// run counts as interrupted, with a checkpoint for --resume. No step can follow. Throws the error that ended the
  /// steps, if any.
  RunSummary finish();

 private:
  [[nodiscard]] bool take_step();
  [[nodiscard]] ObstacleSection& section_of_obstacle(const std::string& obstacle);
  void steer_from_start(ObstacleSection& section);
  [[nodiscard]] SteeredPath& steered_path(const std::string& obstacle);

  friend class Run;  // a resumed run restores earlier warnings

  Case input_;
  std::vector<std::string> changes_;  ///< changes with which input_ was read
  std::vector<std::string> warnings_;
  ModelBuilder builder_;  ///< null: build_model
  std::unique_ptr<Model> model_;
  std::unique_ptr<Scheme> scheme_;
  std::unique_ptr<Simulation> simulation_;
  std::shared_ptr<Vector> load_;  ///< load of set_load
  RunOptions options_;
  std::unique_ptr<Run> run_;
  bool has_finished_ = false;
  int calls_at_end_ = 0;  ///< calls of step() at the end
};

}  // namespace ricochet
