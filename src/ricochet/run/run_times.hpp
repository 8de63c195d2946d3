#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file Time spent in the phases of a run, in seconds, over all of its sessions.
namespace ricochet {

struct RunTimes {
  double read_mesh = 0.0, model = 0.0, assembly = 0.0, ordering = 0.0, factorization = 0.0;
  double start = 0.0;    ///< the starting state and constant data, without the factorization
  double steps = 0.0;    ///< without output
  double contact = 0.0;  ///< part of `steps` spent in contact solvers
  double output = 0.0, checkpoints = 0.0;
  double watch = 0.0;  ///< part of `output` spent in the watches of contact

  void add_build(const BuildTimes& build);
  void add_start(double seconds, const std::vector<ChosenMethod>& methods);
  /// Returns the times by name, in the order of a run, with "total".
  [[nodiscard]] std::vector<std::pair<std::string, double>> phases() const;
  /// Returns the processor time; steps that an interruption has lost are not included.
  [[nodiscard]] double processor() const { return earlier_processor_ + processor_.seconds(); }
  /// Saves the times, or adds those of earlier sessions.
  void persist(const SnapshotVisitor& visit);

 private:
  double earlier_total_ = 0.0, earlier_processor_ = 0.0;
  Timer session_;
  ProcessorTimer processor_;
};

}  // namespace ricochet
