#include "ricochet/solver/iterative_stage.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <numeric>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/linear_algebra/block_jacobi.hpp"
#include "ricochet/linear_algebra/single_precision_cg.hpp"
#include "ricochet/solver/gathered/gathered_subdomains.hpp"
#include "ricochet/solver/stage/moved_product.hpp"
#include "ricochet/solver/stage/stage_operator.hpp"
#include "ricochet/solver/stage/stage_product.hpp"
#include "ricochet/solver/subdomain/subdomains.hpp"

namespace ricochet {

namespace {

/// Reduction of the residual by conjugate gradients before the subdomains are solved again.
constexpr double outer_reduction = 1e-2;
constexpr int outer_iteration_limit = 60;
constexpr int iteration_limit = 5000;
/// Reduction requested from iterations in single precision at once; their rounding is a hundredth of it.
constexpr double single_reduction = 1e-5;
/// Iterations in single precision have failed if the residual exceeds the one they report by this factor.
constexpr double astray = 10.0;

/// If a stage takes so many iterations with diagonal blocks, multigrid takes two thirds of the time
/// (docs/distributed.md).
constexpr int iterations_for_multigrid = 600;

/// Stages of one operator without a factor of it: conjugate gradients on the whole body and the contact subdomains in
/// turn. The subdomains come last: contact and friction hold to rounding, and the residual is a force of at most
/// `tolerance` times the forces of the step, in the energy norm of the preconditioner.
class IterativeStage final : public StageSolver {
 public:
  IterativeStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                 const StepSolverOptions& options, SharedContact& shared, FactoredStage* condensed,
                 GatheredContact* gathered);

  void solve(const LinearStage& stage, StageSolution& solution) override;
  void refactorize(const Vector& displacement) override;
  void show_contact() const override {
    if (touches_) subdomains_->report();
  }
  void persist(const SnapshotVisitor& visit) override;
  [[nodiscard]] IterationCounts iteration_counts() const override { return counts_; }

 private:
  void make_preconditioner();
  bool switch_to_multigrid();
  void begin(const LinearStage& stage, StageSolution& solution);
  [[nodiscard]] bool are_outside(const std::vector<Index>& points) const;
  void make_subdomains(const LinearStage& stage, const std::vector<Index>& required);
  void keep_columns() { moved_.make(product_, subdomains_->nodes(), problem_.nodes.cols(), problem_.dimension); }
  void find_residual();
  void solve_subdomains(const LinearStage& stage, StageSolution& solution);
  void find_reactions(const LinearStage& stage, const StageSolution& solution);
  void mask(Vector& values) const;
  void accumulate(Vector& force) const;
  [[nodiscard]] double forces(const LinearStage& stage);
  void solve_linear(double norm, double target);
  void watch_single_precision();
  void end(const LinearStage& stage, StageSolution& solution);

  const SemidiscreteProblem& problem_;
  OperatorCoefficients coefficients_;
  StepSolverOptions options_;
  std::vector<char> solved_;   ///< per dof
  std::vector<int> unsolved_;  ///< dofs
  StageProduct product_;       ///< with A
  std::unique_ptr<Preconditioner> preconditioner_;
  std::string kind_ = preconditioner_registry().all().front().name;  ///< of the preconditioner
  IterationCounts counts_;
  long gradients_before_ = 0;  ///< of the previous stages
  ConjugateGradients gradients_;
  std::unique_ptr<SinglePrecisionCg> single_;  ///< null if A is not stored in blocks
  bool single_is_trusted_ = true;              ///< in this stage
  double promised_ = 0.0;                      ///< norm of the residual that they reported
  ContactCandidates candidates_;               ///< points for which the subdomains were made
  ContactNeighbourhood neighbourhood_;
  std::unique_ptr<ContactRegion> subdomains_;
  MovedProduct moved_;             ///< of the motion of the subdomains
  bool may_touch_ = false;         ///< some point may touch in this stage
  bool presses_at_start_ = false;  ///< points with reactions at the start of the step are part of a mean
  bool touches_ = false;           ///< the last stage had a contact problem
  Vector displacement_;            ///< at the tangent; empty: the undeformed body
  Vector increment_, previous_;    ///< of this stage and the last one, for the initial guess
  bool has_previous_ = false;
  Vector reactions_;        ///< forces of the last reactions
  Vector right_hand_side_;  ///< accumulated over ranks
  Vector guess_, residual_, work_, motion_, prescribed_, supported_force_;
};

IterativeStage::IterativeStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                               const StepSolverOptions& options, SharedContact& shared, FactoredStage* condensed,
                               GatheredContact* gathered)
    : problem_(problem),
      coefficients_(coefficients),
      options_(options),
      gradients_(problem.dimension, *problem.ranks),
      candidates_(problem.contact.size(), *problem.ranks),
      neighbourhood_(problem) {
  if (gathered != nullptr) {
    subdomains_ = make_gathered_subdomains(problem, coefficients, solved_, product_, neighbourhood_, shared, *gathered,
                                           condensed);
  } else {
    subdomains_ =
        std::make_unique<Subdomains>(problem, coefficients, solved_, product_, neighbourhood_, shared, condensed);
  }
  const auto count = std::size_t(problem.dof_count());
  solved_.assign(count, 0);
  for (const int dof : solved_dofs(problem, coefficients.dofs)) solved_[std::size_t(dof)] = 1;
  for (std::size_t dof = 0; dof < count; ++dof) {
    if (solved_[dof] == 0) unsolved_.push_back(int(dof));
  }
  if (options.preconditioner != "auto") kind_ = options.preconditioner;
  refactorize(Vector());
  increment_.setZero(problem.dof_count());
  previous_ = increment_;
}

/// Discards the subdomains: they are made for the new operator on demand.
void IterativeStage::refactorize(const Vector& displacement) {
  displacement_ = displacement;
  single_.reset();
  preconditioner_.reset();
  product_ = StageProduct();  // released before the new one is made
  product_ = StageProduct(problem_, coefficients_, displacement);
  make_preconditioner();
  subdomains_->clear();
  moved_.clear();
  candidates_.clear();
}

void IterativeStage::make_preconditioner() {
  single_.reset();
  preconditioner_.reset();
  if (!preconditioner_registry().find(kind_).type.is_block_diagonal) {
    std::vector<Index> all(static_cast<std::size_t>(problem_.nodes.cols()));
    std::iota(all.begin(), all.end(), Index{0});
    preconditioner_ = make_named_preconditioner(kind_, product_.principal(all), solved_, problem_.nodes,
                                                *problem_.ranks, options_.preconditioners.get());
    return;
  }
  Vector blocks = product_.diagonal_blocks();
  problem_.ranks->accumulate(blocks);
  preconditioner_ = make_block_jacobi(blocks, problem_.dimension, solved_);
  const NodeMatrix* const matrix = product_.matrix();
  if (!problem_.ranks->any(matrix == nullptr || matrix->is_scalar()))
    single_ = std::make_unique<SinglePrecisionCg>(*matrix, blocks, solved_, *problem_.ranks);
}

/// Replaces diagonal blocks, which need too many iterations, by multigrid. All ranks see the same number.
bool IterativeStage::switch_to_multigrid() {
  const std::string& multigrid = fallback_preconditioner();
  if (options_.preconditioner != "auto" || !options_.preconditioners || kind_ == multigrid) return false;
  kind_ = multigrid;
  log::info("the step is long for the mesh: iterations are preconditioned by multigrid (" + kind_ + ") from now on");
  make_preconditioner();
  return true;
}

void IterativeStage::mask(Vector& values) const {
  for (const int dof : unsolved_) values[dof] = 0.0;
}

/// Returns whether some of these points are in no subdomain.
bool IterativeStage::are_outside(const std::vector<Index>& points) const {
  return std::ranges::any_of(points, [&](Index point) { return candidates_.number(point) < 0; });
}

/// Makes subdomains for these points and those near them, and for those of the last subdomains unless there are too
/// many: a body that rolls leaves them behind.
void IterativeStage::make_subdomains(const LinearStage& stage, const std::vector<Index>& required) {
  std::vector<Index> points = required;
  if (problem_.ranks->any(candidates_.are_too_many())) {
    const std::vector<Index> nearest = candidates_.nearest(stage.conditions);
    points.insert(points.end(), nearest.begin(), nearest.end());
    candidates_.clear();
  }
  points = neighbourhood_.points_around(points);
  points.insert(points.end(), candidates_.points().begin(), candidates_.points().end());
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  candidates_.clear();
  candidates_.add_candidates(points);
  try {
    subdomains_->make(points);
    keep_columns();
  } catch (const Error& problem) {
    // The tangent at a displacement that an iteration reaches is no error of the case.
    if (problem.kind() != ErrorKind::invalid_input || displacement_.size() == 0) throw;
    throw Error(ErrorKind::not_converged, problem.what());
  }
}

void IterativeStage::persist(const SnapshotVisitor& visit) {
  visit("increment", increment_, problem_.dof_count());
  visit("previous", previous_, problem_.dof_count());
  visit("has_previous", has_previous_);
  std::string kind = kind_;
  visit("preconditioner", kind);
  if (visit.loads() && kind != kind_)
    visit.require(kind == fallback_preconditioner() && switch_to_multigrid(), "preconditioner",
                  "is not the one of this run");
  bool has_subdomains = subdomains_->are_made();
  visit("has_zone", has_subdomains);
  if (has_subdomains) {
    std::vector<Index> points = candidates_.points();
    visit("near.points", points, {0, problem_.contact.size() - 1});
    if (visit.loads()) {
      candidates_.clear();
      candidates_.add_candidates(points);
    }
    subdomains_->persist(visit.part("zones"), points);
    if (visit.loads()) keep_columns();
  }
  candidates_.persist_history(visit.part("near"));
}

/// Sets the initial guess: increments of a smooth motion continue. Supports are exact.
void IterativeStage::begin(const LinearStage& stage, StageSolution& solution) {
  right_hand_side_ = stage.right_hand_side.force;
  accumulate(right_hand_side_);
  guess_ = increment_;
  if (has_previous_) guess_ += increment_ - previous_;
  for (const int dof : unsolved_) guess_[dof] = 0.0;
  prescribe(problem_, stage, guess_);
  // Nothing is loaded or prescribed: the residual of a nonzero guess would have no reference.
  const bool is_loaded = !stage.right_hand_side.force.isZero(0.0) || !stage.right_hand_side.prescribed.isZero(0.0);
  if (!problem_.ranks->any(is_loaded)) guess_.setZero();
  solution.open_all(problem_.contact.size(), problem_.contact.has_friction() ? problem_.dimension - 1 : 0);
  std::vector<Index> pressing;
  if (coefficients_.condensed_operator >= 0) pressing = pressing_at_start(coefficients_.acting, stage);
  const Ranks& ranks = *problem_.ranks;
  presses_at_start_ = ranks.any(!pressing.empty());
  candidates_.estimate_reach(stage.conditions);
  may_touch_ = ranks.any(candidates_.some_may_touch(stage.conditions));
  if (may_touch_) {
    const std::vector<Index> approaching = candidates_.approaching(stage.conditions);
    if (ranks.any(!approaching.empty())) make_subdomains(stage, approaching);
  }
  if (presses_at_start_ && ranks.any(are_outside(pressing))) make_subdomains(stage, pressing);
}

/// Accumulates a force over the ranks that hold parts of it, on the dofs that are solved for.
void IterativeStage::accumulate(Vector& force) const {
  problem_.ranks->accumulate(force);
  mask(force);
}

/// Computes b − A x. On several ranks b is accumulated once: its parts may be large where it vanishes, in an
/// equilibrium, and would leave their rounding in every residual.
void IterativeStage::find_residual() {
  product_.multiply(guess_, residual_);
  accumulate(residual_);
  residual_ = right_hand_side_ - residual_;
}

/// Solves the subdomains and updates the residual. They move few nodes, so that these columns of A suffice.
void IterativeStage::solve_subdomains(const LinearStage& stage, StageSolution& solution) {
  moved_.begin(guess_);
  subdomains_->solve(stage, residual_, guess_, solution);
  moved_.multiply(guess_, work_);
  accumulate(work_);
  residual_ -= work_;
}

void IterativeStage::find_reactions(const LinearStage& stage, const StageSolution& solution) {
  reactions_.setZero(problem_.dof_count());
  stage.rows.add_force(solution.acting_normal(), solution.acting_tangential(), reactions_);
  accumulate(reactions_);
}

/// Norm of all forces, those of moving supports included: the reference of the residual.
double IterativeStage::forces(const LinearStage& stage) {
  work_ = right_hand_side_;
  if (problem_.ranks->any(!stage.right_hand_side.prescribed.isZero(0.0))) {
    prescribed_.setZero(problem_.dof_count());
    prescribe(problem_, stage, prescribed_);
    product_.multiply(prescribed_, supported_force_);
    accumulate(supported_force_);
    work_ -= supported_force_;
  }
  const double given = gradients_.norm(*preconditioner_, work_);
  return std::max(given, gradients_.norm(*preconditioner_, reactions_));
}

/// Reduces a residual of this norm to `target`; the first digits in single precision.
void IterativeStage::solve_linear(double norm, double target) {
  const auto product = [&](const Vector& x, Vector& y) {
    product_.multiply(x, y);
    accumulate(y);
  };
  if (single_ && single_is_trusted_) {
    const auto result = single_->solve(residual_, std::max(target / norm, single_reduction), iteration_limit, guess_);
    promised_ = result.residual;
    single_is_trusted_ = result.converged;
    counts_.gradients += result.iterations;
    return;
  }
  promised_ = 0.0;
  const auto result = gradients_.solve(product, *preconditioner_, target, iteration_limit, residual_, guess_);
  counts_.gradients += result.iterations;
  if (result.converged || switch_to_multigrid()) return;
  throw Error(ErrorKind::not_converged,
              fmt::format("conjugate gradients stopped after {} iterations at {:.2g} times the requested residual; set "
                          "solver.method = \"direct\" if memory allows",
                          result.iterations, result.residual / target));
}

/// Checks the reported residual of single precision: `residual_` is b − A x without reactions.
void IterativeStage::watch_single_precision() {
  if (promised_ == 0.0) return;
  work_ = residual_ + reactions_;
  single_is_trusted_ = single_is_trusted_ && gradients_.norm(*preconditioner_, work_) <= astray * promised_;
  promised_ = 0.0;
}

void IterativeStage::solve(const LinearStage& stage, StageSolution& solution) {
  begin(stage, solution);
  single_is_trusted_ = true;
  promised_ = 0.0;
  gradients_before_ = counts_.gradients;
  reactions_.setZero(problem_.dof_count());
  double target = 0.0;
  bool must_touch = false;  // points have penetrated where none was expected to touch
  for (int outer_iteration = 0; outer_iteration < outer_iteration_limit; ++outer_iteration) {
    ++counts_.schwarz_iterations;
    find_residual();
    watch_single_precision();
    const bool touches = subdomains_->are_made() && (must_touch || presses_at_start_ || may_touch_);
    if (touches) {
      solve_subdomains(stage, solution);
      find_reactions(stage, solution);
      residual_ += reactions_;
    }
    if (target == 0.0) target = options_.tolerance * forces(stage);
    const double norm = gradients_.norm(*preconditioner_, residual_);
    if (norm <= target) {
      const bool has_condensation = coefficients_.condensed_operator >= 0;
      if (has_condensation) subdomains_->find_motion(stage.rows, solution, guess_, solution.contact_increment);
      stage.rows.normal_motion(has_condensation ? solution.contact_increment : guess_, motion_);
      const std::vector<Index> penetrating = candidates_.penetrating(stage.conditions, motion_, !touches);
      if (!problem_.ranks->any(!penetrating.empty())) {
        touches_ = touches;
        return end(stage, solution);
      }
      must_touch = true;
      if (problem_.ranks->any(are_outside(penetrating))) make_subdomains(stage, penetrating);
      target = 0.0;
      continue;
    }
    solve_linear(norm, touches ? std::max(0.3 * target, outer_reduction * norm) : 0.9 * target);
  }
  throw Error(
      ErrorKind::not_converged,
      fmt::format(
          "contact and conjugate gradients did not converge in {} iterations; the time step is long compared with the "
          "time in which a wave crosses a cell: set solver.method = \"direct\" or use a smaller time.step",
          outer_iteration_limit));
}

void IterativeStage::end(const LinearStage& stage, StageSolution& solution) {
  if (counts_.gradients - gradients_before_ > iterations_for_multigrid) switch_to_multigrid();
  candidates_.update_history(stage.conditions, motion_, std::size_t((solution.normal_reaction.array() > 0.0).count()));
  previous_ = increment_;
  increment_ = guess_;
  has_previous_ = true;
  solution.increment = guess_;
  const std::vector<Index>& supported = problem_.supports.dofs();
  solution.support_reaction.resize(problem_.supports.size());
  if (supported.empty()) return;
  product_.multiply(guess_, work_);
  work_ -= stage.right_hand_side.force;
  stage.rows.add_force(-solution.acting_normal(), -solution.acting_tangential(), work_);
  for (std::size_t i = 0; i < supported.size(); ++i) solution.support_reaction[Index(i)] = work_[supported[i]];
}

}  // namespace

std::unique_ptr<StageSolver> make_iterative_stage(const SemidiscreteProblem& problem,
                                                  const OperatorCoefficients& coefficients,
                                                  const StepSolverOptions& options, SharedContact& shared,
                                                  FactoredStage* condensed, GatheredContact* gathered) {
  return std::make_unique<IterativeStage>(problem, coefficients, options, shared, condensed, gathered);
}

}  // namespace ricochet
