#pragma once

#include <string>
#include <vector>

#include "ricochet/io/summary.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/simulation/history/momentum_account.hpp"

/// @file Balances that a run must satisfy: energy, momentum and angular momentum. Section [check] of a case.
namespace ricochet {

class RunChecks {
 public:
  /// Opens the balances at a starting state. `columns` are those of history.csv.
  RunChecks(const Case& input, const Model& model, const Scheme& scheme, const State& state,
            const std::vector<std::string>& columns);
  void persist(const SnapshotVisitor& visit);

  /// Enters a part of a step that was cut, or the whole step.
  void enter_part(const State& state) { momentum_.enter_step(state); }
  void enter_impulse(const State& state, const Vector& impulse) { momentum_.enter_impulse(state, impulse); }
  /// Enters a row of history.csv. Warns the first time that a balance is violated, or throws Error(not_converged) if
  /// the case demands it.
  void watch(const std::vector<double>& row, const State& state);
  [[nodiscard]] std::vector<CheckResult> results() const;

 private:
  struct Account {
    CheckResult result;
    std::string advice;
    bool warned = false;
  };
  void judge(Account& account, double residual, double scale, const std::vector<double>& row, const State& state);
  [[nodiscard]] Resultant momentum(const std::vector<double>& row) const;
  /// Returns Σ |P| over the bodies.
  [[nodiscard]] double size_of_momenta(const std::vector<double>& row, const Resultant& all) const;
  [[nodiscard]] double largest_limit() const;

  const Model& model_;
  bool stops_;
  MomentumAccount momentum_;
  double mass_ = 0.0;                                    ///< of all bodies
  std::size_t body_momenta_ = 0, body_momenta_end_ = 0;  ///< columns momentum.BODY_x, …
  std::size_t kinetic_, elastic_, total_, residual_, momentum_column_, angular_column_;
  Resultant start_;
  bool has_start_ = false;
  std::vector<std::size_t> works_;  ///< columns
  double work_scale_ = 0.0, energy_scale_ = 0.0, momentum_scale_ = 0.0, ignored_scale_ = 0.0;
  Account energy_, linear_, angular_;
};

}  // namespace ricochet
