#pragma once

#include <string>
#include <vector>

#include "ricochet/io/summary.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/simulation/history/momentum_account.hpp"

/// @file What a run must keep: its accounts of energy, momentum and angular momentum. Section [check] of a case.
namespace ricochet {

class RunChecks {
 public:
  /// Opens the accounts on a starting state, or on the state of the snapshot. `columns` are those of history.csv.
  RunChecks(const Case& input, const Model& model, const Scheme& scheme, const State& state,
            const std::vector<std::string>& columns, const Snapshot* snapshot);
  void save(Snapshot& snapshot, const std::string& name) const;

  /// After every step, and after the parts of one that was cut.
  void enter_part(const State& state) { momentum_.enter_step(state); }
  void enter_impulse(const State& state, const Vector& impulse) { momentum_.enter_impulse(state, impulse); }
  /// A row of history.csv. Warns the first time that an account does not balance, or throws Error(not_converged) where
  /// the case asks for that.
  void watch(const std::vector<double>& row, const State& state);
  [[nodiscard]] std::vector<CheckResult> results() const;

 private:
  struct Account {
    CheckResult result;
    std::string advice;
    bool told = false;
  };
  void judge(Account& account, double residual, double scale, const std::vector<double>& row, const State& state);
  [[nodiscard]] Resultant momentum(const std::vector<double>& row) const;
  /// Σ |P| over the bodies.
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
