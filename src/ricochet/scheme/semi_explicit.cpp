#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/scheme/contact_conditions.hpp"
#include "ricochet/scheme/critical_step.hpp"
#include "ricochet/scheme/scheme.hpp"

namespace ricochet {

namespace {

/// Warned of above this fraction of the critical step.
constexpr double safe_fraction = 0.9;

/// What a step leaves for the next one: K U at the state, and what supports prescribe at the end of the next step.
constexpr const char* internal_force = "internal_force";
constexpr const char* supported_next = "supported_next";

/// Central differences inside, contact nodes without inertia at the end of the step (D. Doyen, A. Ern, S. Piperno, SIAM
/// J. Sci. Comput. 33 (2011) 223–249). The mass is diagonal and zero on the contact nodes (index c; i: all others):
///   M_ii A + C_ii V + K_ii u_i + K_ic u_c = L_i   and   K_cc u_c + K_ci u_i = L_c + Gᵀr_N − B_Tᵀr_T   at every t_n,
///   V^{n+½} = (U^{n+1}−Uⁿ)/h,   V^{n±½} = Vⁿ ± (h/2)Aⁿ,   0 ≤ r_N ⟂ g(U^{n+1}) ≥ 0,   friction on B_T (U^{n+1}−Uⁿ)/h.
/// So u_i^{n+1} needs no system, and then u_c^{n+1} and the reactions come from the stage on the contact dofs alone.
///
/// In terms of Uⁿ, Vⁿ, Aⁿ this is Newmark's scheme with β = 0, γ = ½, and its account holds: J − (h²/8)AᵀMA changes in
/// a step by ½ΔUᵀ(F₀+F₁), F the forces outside J. The same balance at half steps, for V^{n+½} and the elastic energy
/// ½(Uⁿ)ᵀKU^{n+1}, gains ½r_Nⁿ·(g^{n+1}−g^{n−1}) from contact.
///
/// Stable for h < 2/√λ, λ the largest eigenvalue of M_ii⁻¹K_ii; see critical_step.hpp.
///
/// One product with K in a step, and one with its contact rows. K Uⁿ⁺¹ on these is (K Uⁿ)_c + K_c ΔU: the increments
/// are small, no digits are lost to a rigid motion.
class SemiExplicit final : public Scheme {
 public:
  explicit SemiExplicit(const SchemeParameters& parameters)
      : Scheme(parameters), check_critical_step_(parameters.check_critical_step) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    if (problem.contact_dofs.empty()) return {};
    return {{0.0, 1.0, 0.0, StageDofs::contact}};
  }
  [[nodiscard]] WorkRule work_rule() const override { return {0.5, 0.5}; }
  [[nodiscard]] double critical_step() const override { return critical_step_; }

  void analyse(const SemidiscreteProblem& problem) override {
    refuse_other_masses(problem);
    critical_step_ = central_difference_limit(problem);
    if (check_critical_step_) check_step();
    mass_ = problem.mass.diagonal();
    find_inverse_mass(problem);
    gather_contact_rows(problem);
  }

  void start(const SemidiscreteProblem& problem, State& state) override {
    problem.internal_force->evaluate(state.displacement, state.memory[internal_force]);
    start_supports(problem, state);
  }

  void prepare(const SemidiscreteProblem& problem, const State& state, int, Stage& stage) override {
    const double h = step();
    const double time = state.time + h;
    predict(problem, state);
    evaluate_loads(problem, time);
    row_force_.noalias() = contact_rows_ * predicted_;
    const Vector& force = state.memory.at(internal_force);
    if (stage.right_hand_side.size() != problem.dof_count()) stage.right_hand_side.setZero(problem.dof_count());
    for (std::size_t i = 0; i < problem.contact_dofs.size(); ++i) {
      const Index dof = problem.contact_dofs[i];
      stage.right_hand_side[dof] = load(problem)[dof] - force[dof] - row_force_[static_cast<Index>(i)];
    }
    stage.prescribed.setZero(problem.supports.size());  // what supports prescribe is in the base
    require_no_penetration(problem, base_, time, stage);
    if (problem.has_moving_obstacles()) {
      problem.obstacle_velocity(middle_, state.time + 0.5 * h, obstacle_velocity_);
    }
    require_friction(problem, rate_, obstacle_velocity_, 1.0 / h, stage);
  }

  void finish(const SemidiscreteProblem& problem, const std::vector<StageSolution>& solutions, State& state,
              Vector& increment) override {
    if (solutions.empty()) evaluate_loads(problem, state.time + step());
    move(problem, solutions, state, increment);
    problem.internal_force->evaluate(state.displacement, state.memory.at(internal_force));
    accelerate(problem, state);
    if (!solutions.empty()) take_contact(solutions.front(), obstacle_velocity_, step(), state);
    advance_supports(problem, increment, state);
    for (const Index dof : problem.massless_dofs) state.velocity[dof] = increment[dof] / step();
    if (problem.loads.varies()) state.forces.varying_load = varying_;
    if (problem.has_damping()) state.forces.damping_force = damping_.cwiseProduct(state.velocity);
  }

  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem&, const State& state) const override {
    return -0.125 * step() * step() * state.acceleration.dot(mass_.cwiseProduct(state.acceleration));
  }

 private:
  static void refuse_other_masses(const SemidiscreteProblem& problem) {
    const char* const advice = "set mass.type = \"equivalent-lumped\", or use scheme \"newmark\", which takes any mass";
    if (!problem.mass.is_diagonal()) {
      throw Error(
          ErrorKind::invalid_input,
          fmt::format("scheme \"semi-explicit\" needs a diagonal mass without inertia on the contact nodes, and "
                      "this one is not diagonal; {}",
                      advice));
    }
    const auto has_inertia = [&](Index dof) { return problem.is_massless[static_cast<std::size_t>(dof)] == 0; };
    if (std::any_of(problem.contact_dofs.begin(), problem.contact_dofs.end(), has_inertia)) {
      throw Error(
          ErrorKind::invalid_input,
          fmt::format("scheme \"semi-explicit\" needs a mass without inertia on the contact nodes: their motion "
                      "is that of their own equilibrium, contact included; {}",
                      advice));
    }
    if (problem.has_damping() && !is_diagonal(problem.damping)) {
      throw Error(ErrorKind::invalid_input,
                  "scheme \"semi-explicit\" takes no damping proportional to the stiffness: it would make the stable "
                  "step shorter and need a second product with K; set material damping.stiffness = 0 (damping.mass is "
                  "possible), or use scheme \"newmark\"");
    }
  }

  void check_step() const {
    const double fraction = step() / critical_step_;
    if (fraction >= 1.0) {
      throw Error(ErrorKind::invalid_input,
                  fmt::format("scheme \"semi-explicit\": time.step = {:.6g} is {:.3g} times the critical step, "
                              "{:.6g}: the motion would grow without bound; set time.step = {:.3g} or less, or use "
                              "scheme \"newmark\", which is stable for any step",
                              step(), fraction, critical_step_, safe_fraction * critical_step_));
    }
    if (fraction <= safe_fraction) return;
    log::warning(
        fmt::format("scheme \"semi-explicit\": time.step = {:.6g} is {:.3g} of the critical step, {:.6g}; near to it "
                    "changes of contact leave high frequencies of large amplitude, take {:.3g} or less",
                    step(), fraction, critical_step_, safe_fraction * critical_step_));
  }

  /// (M + (h/2)C)⁻¹ where there is mass and no support, else 0: M Aⁿ + C (V^{n−½} + (h/2)Aⁿ) = L − K U.
  void find_inverse_mass(const SemidiscreteProblem& problem) {
    damping_ = problem.has_damping() ? Vector(problem.damping.diagonal()) : Vector();
    inverse_mass_ = mass_;
    if (problem.has_damping()) inverse_mass_ += (0.5 * step()) * damping_;
    for (const Index dof : problem.supports.dofs()) inverse_mass_[dof] = 0.0;
    for (double& m : inverse_mass_) m = m > 0.0 ? 1.0 / m : 0.0;
  }

  /// The rows of K of the contact dofs, the dofs that they see, and the vectors that are only filled there.
  void gather_contact_rows(const SemidiscreteProblem& problem) {
    const SparseMatrix& stiffness = problem.internal_force->tangent();
    const Index dofs = problem.dof_count();
    std::vector<char> is_near(static_cast<std::size_t>(dofs), 0);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < problem.contact_dofs.size(); ++i) {
      for (SparseMatrix::InnerIterator entry(stiffness, problem.contact_dofs[i]); entry; ++entry) {
        entries.emplace_back(static_cast<int>(i), static_cast<int>(entry.row()), entry.value());
        is_near[static_cast<std::size_t>(entry.row())] = 1;
      }
    }
    contact_rows_.resize(static_cast<Index>(problem.contact_dofs.size()), dofs);
    contact_rows_.setFromTriplets(entries.begin(), entries.end());
    contact_node_dofs_.clear();
    for (const Index node : problem.contact.unique_nodes()) {
      for (int k = 0; k < problem.dimension; ++k) contact_node_dofs_.push_back(node * problem.dimension + k);
    }
    for (const Index dof : contact_node_dofs_) is_near[static_cast<std::size_t>(dof)] = 1;
    near_dofs_.clear();
    for (Index dof = 0; dof < dofs; ++dof) {
      if (is_near[static_cast<std::size_t>(dof)] != 0) near_dofs_.push_back(dof);
    }
    for (Vector* values : {&predicted_, &base_, &middle_, &rate_, &reaction_}) values->setZero(dofs);
  }

  /// Supported dofs move through their prescribed values: their acceleration is a second difference of these.
  void start_supports(const SemidiscreteProblem& problem, State& state) {
    const double h = step();
    Vector& next = state.memory[supported_next];
    problem.supports.values(h, next);
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
      if (problem.is_massless[static_cast<std::size_t>(dof)] != 0) continue;
      const double half = (next[i] - state.displacement[dof]) / h;
      const double acceleration = 2.0 * (half - state.velocity[dof]) / h;
      state.forces.support_reaction[i] += mass_[dof] * (acceleration - state.acceleration[dof]);
      state.acceleration[dof] = acceleration;
    }
  }

  void evaluate_loads(const SemidiscreteProblem& problem, double time) {
    if (!problem.loads.varies()) return;
    problem.loads.varying(time, varying_);
    load_ = problem.loads.constant() + varying_;
  }
  [[nodiscard]] const Vector& load(const SemidiscreteProblem& problem) const {
    return problem.loads.varies() ? load_ : problem.loads.constant();
  }

  /// The increment of the step on the dofs that contact rows see; contact nodes repeat that of the step before.
  void predict(const SemidiscreteProblem& problem, const State& state) {
    const double h = step();
    for (const Index dof : near_dofs_) {
      predicted_[dof] = h * (state.velocity[dof] + (0.5 * h) * state.acceleration[dof]);
    }
    const Vector& next = state.memory.at(supported_next);
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
      predicted_[dof] = next[i] - state.displacement[dof];
    }
    for (const Index dof : contact_node_dofs_) {
      base_[dof] = state.displacement[dof] + predicted_[dof];
      middle_[dof] = state.displacement[dof] + 0.5 * predicted_[dof];
      rate_[dof] = predicted_[dof] / h;
    }
  }

  /// U^{n+1}, and V^{n+½} in the place of the velocity: one pass.
  void move(const SemidiscreteProblem& problem, const std::vector<StageSolution>& solutions, State& state,
            Vector& increment) {
    const double h = step();
    const Index count = state.displacement.size();
    const Vector& next = state.memory.at(supported_next);
    support_increment_.resize(problem.supports.size());
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
      support_increment_[i] = next[i] - state.displacement[dof];
    }
    increment.resize(count);
    double* const u = state.displacement.data();
    double* const v = state.velocity.data();
    double* const du = increment.data();
    const double* const a = state.acceleration.data();
    parallel_ranges(count, [=](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        v[i] += 0.5 * h * a[i];
        du[i] = h * v[i];
        u[i] += du[i];
      }
    });
    for (const Index dof : problem.contact_dofs) {
      const double more = solutions.front().increment[dof];
      du[dof] += more;
      u[dof] += more;
    }
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
      u[dof] = next[i];
      du[dof] = support_increment_[i];
    }
  }

  /// A^{n+1} and V^{n+1} from the force at U^{n+1}: one pass.
  void accelerate(const SemidiscreteProblem& problem, State& state) {
    const double half = 0.5 * step();
    const Vector& force = state.memory.at(internal_force);
    const Index count = force.size();
    const double* const l = load(problem).data();
    const double* const f = force.data();
    const double* const inverse = inverse_mass_.data();
    double* const a = state.acceleration.data();
    double* const v = state.velocity.data();
    const double* const c = damping_.size() > 0 ? damping_.data() : nullptr;
    parallel_ranges(count, [=](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        const double damping_force = c != nullptr ? c[i] * v[i] : 0.0;
        a[i] = inverse[i] * (l[i] - f[i] - damping_force);
        v[i] += half * a[i];
      }
    });
  }

  /// Motion of the supported dofs, and their reaction M A + C V + K U − L − (Gᵀr_N − B_Tᵀr_T).
  void advance_supports(const SemidiscreteProblem& problem, const Vector& increment, State& state) {
    if (problem.supports.size() == 0) return;
    const double h = step();
    const Vector& force = state.memory.at(internal_force);
    Vector& next = state.memory.at(supported_next);
    problem.supports.values(state.time + 2.0 * h, next);
    for (const Index dof : contact_node_dofs_) reaction_[dof] = 0.0;
    problem.add_contact_force(state.forces.normal_reaction, state.forces.tangential_reaction, reaction_);
    state.forces.support_reaction.resize(problem.supports.size());
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
      const double before = increment[dof] / h;
      const double after = (next[i] - state.displacement[dof]) / h;
      const bool massless = problem.is_massless[static_cast<std::size_t>(dof)] != 0;
      state.acceleration[dof] = massless ? 0.0 : (after - before) / h;
      state.velocity[dof] = 0.5 * (before + after);
      state.forces.support_reaction[i] =
          mass_[dof] * state.acceleration[dof] + force[dof] - load(problem)[dof] - reaction_[dof];
      if (damping_.size() > 0) state.forces.support_reaction[i] += damping_[dof] * state.velocity[dof];
    }
  }

  bool check_critical_step_;
  double critical_step_ = std::numeric_limits<double>::infinity();
  Vector mass_, inverse_mass_, damping_;
  SparseRowMatrix contact_rows_;          ///< K_c: contact dofs × dofs
  std::vector<Index> near_dofs_;          ///< those that have an entry in K_c
  std::vector<Index> contact_node_dofs_;  ///< of contact nodes, supported ones too
  Vector predicted_;                      ///< ΔU on near dofs
  Vector base_, middle_, rate_;           ///< U + ΔU, U + ΔU/2, ΔU/h on contact nodes
  Vector row_force_, support_increment_, varying_, load_, reaction_;
  ObstacleMotion obstacle_velocity_;
};

}  // namespace

std::unique_ptr<Scheme> make_semi_explicit(const SchemeParameters& parameters) {
  return std::make_unique<SemiExplicit>(parameters);
}

}  // namespace ricochet
