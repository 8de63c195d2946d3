#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ricochet/fem/stress.hpp"
#include "support/case_run.hpp"
#include "support/viscous_block.hpp"

/// @file Viscoelastic branches, compared with closed forms of the Prony series.
namespace ricochet::test_support::relaxation_closed_forms_test {

using namespace viscous;

/// A block that is stretched along x between two walls that hold its sides: uniform strain E = e + e²/2 of the
/// engineering strain e(t), and negligible inertia.
std::string held_case(const std::string& law, const std::string& end_motion, double step, double end,
                      const std::vector<RelaxationBranch>& branches, const std::string& scheme = "reduced-kane") {
  const auto support = [](const std::string& group, const std::string& component, const std::string& value) {
    return "[[support]]\ngroup = \"" + group + "\"\ncomponents = [\"" + component + "\"]\nvalue = \"" + value + "\"\n";
  };
  return "[mesh]\nfile = \"" + block(2) + "\"\n" + material(law, branches, 1e-10) + support("left", "x", "0") +
         support("right", "x", end_motion) + support("bottom", "y", "0") + support("top", "y", "0") +
         fmt::format("[time]\nscheme = \"{}\"\nstep = {}\nend = {}\n[solver]\nnewton_tolerance = 1e-13\n", scheme, step,
                     end);
}

/// Stress σ_xx of that block: F S_xx.
double stress_along(const CaseRun& run) {
  std::vector<double> stress, energy;
  CellStress(run.model().body).evaluate(run.state().displacement, stress, energy, run.state().internal_strain);
  double spread = 0.0;
  for (std::size_t i = 0; i < stress.size(); i += tensor_components)
    spread = std::max(spread, std::abs(stress[i] - stress[0]));
  EXPECT_LT(spread, 1e-6 * std::abs(stress[0]));
  return stress[0];
}

/// Strain that grows to e in the time T, and stays: with q = E − A of each branch, S = (λ+2μ) E + Σ (4/3) g μ q.
class Relaxation {
 public:
  Relaxation(double strain, double time, std::vector<RelaxationBranch> branches)
      : strain_(strain), time_(time), branches_(std::move(branches)) {}
  [[nodiscard]] double cauchy_stress(double t) const {
    const double e = strain_ * std::min(t / time_, 1.0);
    double second = (lambda + 2.0 * shear) * (e + 0.5 * e * e);
    for (const RelaxationBranch& branch : branches_) second += 4.0 / 3.0 * branch.modulus * shear * spring(branch, t);
    return (1.0 + e) * second;
  }

 private:
  /// Solution of q' + q/τ = E' for E = a t + b t² up to T, then E' = 0.
  [[nodiscard]] double spring(const RelaxationBranch& branch, double t) const {
    const double a = strain_ / time_, b = 0.5 * a * a, tau = branch.time, upto = std::min(t, time_);
    const double at = tau * (a + 2.0 * b * (upto - tau)) - tau * (a - 2.0 * b * tau) * std::exp(-upto / tau);
    return at * std::exp(-(t - upto) / tau);
  }
  double strain_, time_;
  std::vector<RelaxationBranch> branches_;
};

/// Once the strain is constant, steps of any length relax it exactly; while it grows the rule is of second order.
TEST(RelaxationClosedForms, AStretchedBlockRelaxesAsThePronySeries) {
  const std::vector<RelaxationBranch> branches{{0.5, 0.05}, {2.0, 0.6}};
  const double strain = 0.2, ramp = 0.4;
  const Relaxation exact(strain, ramp, branches);
  std::vector<double> errors;
  for (const double step : {0.025, 0.0125, 0.00625}) {
    CaseRun run(held_case("saint-venant-kirchhoff", fmt::format("{}*min(t/{},1)", strain, ramp), step, 2.0, branches));
    double largest = 0.0;
    run.run([&] {
      if (run.state().step == 0) return;
      const double expected = exact.cauchy_stress(run.state().time);
      largest = std::max(largest, std::abs(stress_along(run) - expected) / expected);
    });
    errors.push_back(largest);
  }
  EXPECT_LT(errors[2], 1e-4);
  EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.5);
  EXPECT_NEAR(errors[1] / errors[2], 4.0, 0.5);
}

/// For E = e sin ωt a cycle dissipates π E″ e² per volume, E″ = (4/3) Σ gμ ωτ/(1+ω²τ²) for a strain along one axis.
TEST(RelaxationClosedForms, CyclesDissipateTheLossModulus) {
  const std::vector<RelaxationBranch> branches{{0.5, 0.05}, {2.0, 0.6}};
  const double omega = 2.0 * std::numbers::pi, amplitude = 1e-5, volume = 0.5;
  double loss = 0.0;
  for (const RelaxationBranch& branch : branches) {
    const double x = omega * branch.time;
    loss += 4.0 / 3.0 * branch.modulus * shear * x / (1.0 + x * x);
  }
  const double expected = std::numbers::pi * loss * amplitude * amplitude * volume;
  std::vector<double> errors;
  for (const double steps : {10.0, 20.0, 40.0}) {
    CaseRun run(held_case("saint-venant-kirchhoff", fmt::format("{}*sin({:.17g}*t)", amplitude, omega), 1.0 / steps,
                          12.0, branches));
    double before = 0.0;
    run.run([&] {
      if (std::abs(run.state().time - 11.0) < 0.25 / steps)
        before = run.simulation().account().works().viscous_dissipation;
    });
    const double cycle = run.simulation().account().works().viscous_dissipation - before;
    errors.push_back(std::abs(cycle / expected - 1.0));
  }
  EXPECT_LT(errors[2], 5e-3);
  EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.6);
  EXPECT_NEAR(errors[1] / errors[2], 4.0, 0.3);
}

}  // namespace ricochet::test_support::relaxation_closed_forms_test
