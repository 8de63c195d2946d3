#pragma once

#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"

/// @file Central-difference schemes in displacements, which balance forces at each t_n. They differ in their contact
/// conditions.
namespace ricochet {

/// Base class of the schemes with the balance of forces
///   M (Uⁿ⁺¹−2Uⁿ+Uⁿ⁻¹)/h² + C Vⁿ + K [Uⁿ + κ(Uⁿ⁺¹−2Uⁿ+Uⁿ⁻¹)] = Lⁿ + Gᵀ r_Nⁿ − B_Tᵀ r_Tⁿ,   Vⁿ = (Uⁿ⁺¹−Uⁿ⁻¹)/2h,
/// κ = ¼ (implicit, unconditionally stable) or 0 (explicit, for a diagonal mass). Unknown x = Uⁿ⁺¹, base 2Uⁿ−Uⁿ⁻¹, so
/// that M (…)/h² = M δ/h². The memory holds Uⁿ⁺¹−Uⁿ, not Uⁿ⁺¹: small steps lose no digits.
/// A row of the history at tₙ has Uⁿ, Vⁿ and rⁿ, and the energy at n+½. For the mean (Uⁿ+Uⁿ⁺¹)/2 and (Uⁿ⁺¹−Uⁿ)/h,
///   J + ½(κ−¼)(Uⁿ⁺¹−Uⁿ)ᵀK(Uⁿ⁺¹−Uⁿ) changes from n−½ to n+½ by the works of the forces at n on (Uⁿ⁺¹−Uⁿ⁻¹)/2.
class CentralScheme : public Scheme {
 public:
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override {
    const double h = step();
    return {{1.0 / (h * h), stiffness_, 0.5 / h}};
  }
  [[nodiscard]] double critical_step() const override { return critical_step_; }
  [[nodiscard]] std::optional<double> stability_limit(const SemidiscreteProblem& problem) const override;

  void analyse(const SemidiscreteProblem& problem) override;
  /// Starts with U¹ = U⁰ + hV⁰ + (h²/2)A⁰; the source requires U¹ = U⁰ + hV⁰ + h z(h) with z → 0.
  void start(const SemidiscreteProblem& problem, State& state, StageSolve& stages) override;
  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override;
  void change_velocity(State& state, const Vector& change) const override;
  void energy_state(const State& state, Vector& displacement, Vector& velocity) const override;
  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const override;

 protected:
  /// `stiffness` is κ. `without_inertia` describes how contact nodes without inertia would move, for their refusal.
  CentralScheme(std::string name, double step, double stiffness, std::string without_inertia)
      : Scheme(step, {.energy_instant = 0.5}),
        name_(std::move(name)),
        stiffness_(stiffness),
        without_inertia_(std::move(without_inertia)) {}

  /// Data of a step that contact conditions may refer to.
  struct Instant {
    double time;             ///< t_n
    const State& before;     ///< at n−1
    const Vector& now;       ///< Uⁿ
    const Vector& ahead;     ///< Uⁿ − Uⁿ⁻¹
    const Vector& velocity;  ///< (Uⁿ − Uⁿ⁻¹)/h
  };
  StepEquations& equations() { return equations_; }

 private:
  /// Fills the contact conditions of the stage, whose δ is Uⁿ⁺¹ − (2Uⁿ−Uⁿ⁻¹). The obstacles have been observed at Uⁿ.
  virtual void require_contact(const SemidiscreteProblem& problem, const Instant& instant, Stage& stage) = 0;

  std::string name_;
  double stiffness_;
  std::string without_inertia_;
  double critical_step_ = std::numeric_limits<double>::infinity();
  Vector now_, velocity_, supported_;
  mutable Vector force_;  ///< work space
  StepEquations equations_;
};

}  // namespace ricochet
