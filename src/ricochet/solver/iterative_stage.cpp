#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/linear_algebra/block_jacobi.hpp"
#include "ricochet/solver/contact_zone.hpp"
#include "ricochet/solver/stage_operator.hpp"
#include "ricochet/solver/stage_product.hpp"
#include "ricochet/solver/stage_solver.hpp"

namespace ricochet {

namespace {

/// Layers of nodes around the contact points of a zone, and around those that asked for it.
constexpr int zone_layers = 6;
constexpr int reserve_layers = 3;
/// A round of conjugate gradients goes on to this part of what it began with: the zone has its say before the end.
constexpr double round_reduction = 1e-3;
constexpr int round_limit = 60;
constexpr int iteration_limit = 5000;

/// The stages of one operator without a factor of it: conjugate gradients on the whole body and the contact zone in
/// turn. The zone comes last: contact and friction hold to rounding, and what is left over is a force of at most
/// `tolerance` times the forces of the step, in the energy norm as the preconditioner sees it.
class IterativeStage final : public StageSolver {
 public:
  IterativeStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                 const StepSolverOptions& options, FactoredStage* layer);

  void solve(const Stage& stage, StageSolution& solution) override;
  void refactorize(const Vector& displacement) override;
  void show_contact() const override {
    if (touches_) zone_->report();
  }
  void observe_contact(const ContactObserver& observer) override {
    observer_ = observer;
    if (zone_) zone_->observe(observer);
  }
  void save(Snapshot& snapshot, const std::string& name) const override;
  void load(const Snapshot& snapshot, const std::string& name) override;
  [[nodiscard]] double contact_seconds() const override {
    return earlier_contact_seconds_ + (zone_ ? zone_->contact_seconds() : 0.0);
  }
  [[nodiscard]] std::size_t factor_entries() const override { return zone_ ? zone_->factor_entries() : 0; }

 private:
  void begin(const Stage& stage, StageSolution& solution);
  void make_zone(const Stage& stage, const std::vector<Index>& points);
  void make_zone_of(const std::vector<Index>& points, const std::vector<Index>& nodes);
  [[nodiscard]] std::vector<Index> with_neighbours(const std::vector<Index>& nodes) const;
  void find_residual(const Stage& stage);
  void add_reactions(const Stage& stage, const StageSolution& solution, Vector& force) const;
  void mask(Vector& values) const;
  [[nodiscard]] double forces(const Stage& stage, const StageSolution& solution);
  void solve_linear(double target);
  void end(const Stage& stage, StageSolution& solution);

  const SemidiscreteProblem& problem_;
  OperatorCoefficients coefficients_;
  StepSolverOptions options_;
  FactoredStage* layer_stage_;           ///< of A_c; null: none
  std::unique_ptr<ContactLayer> layer_;  ///< likewise
  std::vector<char> solved_;             ///< per dof
  std::vector<int> unsolved_;            ///< dofs
  StageProduct product_;                 ///< with A
  std::unique_ptr<Preconditioner> preconditioner_;
  ConjugateGradients gradients_;
  ContactCandidates near_;  ///< the points that the zone is made for
  std::unique_ptr<ContactZone> zone_;
  ContactObserver observer_;
  bool presses_at_start_ = false;  ///< points whose reactions at the start of the step are part of a mean
  bool touches_ = false;           ///< the last stage had a contact problem
  double earlier_contact_seconds_ = 0.0;
  Vector displacement_;          ///< of the tangent; empty: the undeformed body
  Vector increment_, previous_;  ///< of this stage and the last one, for the guess
  bool has_previous_ = false;
  Vector guess_, residual_, work_, motion_, prescribed_, supported_force_;
};

IterativeStage::IterativeStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                               const StepSolverOptions& options, FactoredStage* layer)
    : problem_(problem),
      coefficients_(coefficients),
      options_(options),
      layer_stage_(layer),
      near_(problem.contact.size(), *problem.ranks) {
  if (layer != nullptr) layer_ = std::make_unique<ContactLayer>(problem, coefficients, *layer);
  const auto count = static_cast<std::size_t>(problem.dof_count());
  solved_.assign(count, 0);
  for (const int dof : solved_dofs(problem, coefficients.dofs)) solved_[static_cast<std::size_t>(dof)] = 1;
  for (std::size_t dof = 0; dof < count; ++dof) {
    if (solved_[dof] == 0) unsolved_.push_back(static_cast<int>(dof));
  }
  refactorize(Vector());
  increment_.setZero(problem.dof_count());
  previous_ = increment_;
}

/// The zone is made for the new operator when it is needed next.
void IterativeStage::refactorize(const Vector& displacement) {
  displacement_ = displacement;
  const SparseMatrix matrix = combine_operator(problem_, coefficients_, displacement);
  product_ = StageProduct(problem_, coefficients_, matrix, displacement);
  preconditioner_ = make_block_jacobi(matrix, problem_.dimension, solved_);
  if (zone_) earlier_contact_seconds_ += zone_->contact_seconds();
  zone_.reset();
  near_.clear();
}

void IterativeStage::mask(Vector& values) const {
  for (const int dof : unsolved_) values[dof] = 0.0;
}

/// Points whose nodes are within some layers of those of the given ones come along, so that a contact that grows does
/// not ask for another zone in every step.
std::vector<Index> IterativeStage::with_neighbours(const std::vector<Index>& nodes) const {
  std::vector<char> reached(static_cast<std::size_t>(problem_.nodes.cols()), 0);
  for (const Index node : nodes) reached[static_cast<std::size_t>(node)] = 1;
  std::vector<Index> result;
  for (Index point = 0; point < problem_.contact.size(); ++point) {
    bool inside = near_.number(point) >= 0;
    problem_.contact.visit_nodes(
        point, [&](Index node, double) { inside = inside || reached[static_cast<std::size_t>(node)] != 0; });
    if (inside) result.push_back(point);
  }
  return result;
}

/// For these points and those near them, and those of the last zone unless it has become too large: a body that rolls
/// leaves them behind.
void IterativeStage::make_zone(const Stage& stage, const std::vector<Index>& wanted) {
  std::vector<Index> points = wanted;
  if (near_.are_too_many()) {
    const std::vector<Index> nearest = near_.nearest(stage);
    points.insert(points.end(), nearest.begin(), nearest.end());
    near_.clear();
  }
  std::vector<Index> nodes, all;
  {
    // Layers of cells: an equivalent mass has neighbours farther away.
    const SparseMatrix stiffness = problem_.internal_force->tangent();
    all = with_neighbours(nodes_near(problem_, stiffness, points, reserve_layers));
    nodes = nodes_near(problem_, stiffness, all, zone_layers);
  }
  make_zone_of(all, nodes);
}

void IterativeStage::make_zone_of(const std::vector<Index>& points, const std::vector<Index>& nodes) {
  if (zone_) earlier_contact_seconds_ += zone_->contact_seconds();
  zone_.reset();
  near_.clear();
  near_.take_up(points);
  try {
    zone_ = std::make_unique<ContactZone>(problem_, coefficients_, solved_, nodes, points, options_.all_points,
                                          displacement_, layer_stage_);
  } catch (const Error& problem) {
    // The tangent of a place that an iteration leads to is no fault of the case.
    if (problem.kind() != ErrorKind::invalid_input || displacement_.size() == 0) throw;
    throw Error(ErrorKind::not_converged, problem.what());
  }
  zone_->observe(observer_);
}

void IterativeStage::save(Snapshot& snapshot, const std::string& name) const {
  snapshot.save(name + ".increment", increment_);
  snapshot.save(name + ".previous", previous_);
  snapshot.save(name + ".has_previous", has_previous_);
  near_.save_history(snapshot, name + ".near");
  snapshot.save(name + ".has_zone", zone_ != nullptr);
  if (zone_ == nullptr) return;
  snapshot.save(name + ".near.points", near_.points());
  zone_->save(snapshot, name + ".zone");
}

void IterativeStage::load(const Snapshot& snapshot, const std::string& name) {
  increment_ = snapshot.reals(name + ".increment", problem_.dof_count());
  previous_ = snapshot.reals(name + ".previous", problem_.dof_count());
  has_previous_ = snapshot.flag(name + ".has_previous");
  if (snapshot.flag(name + ".has_zone")) {
    const std::vector<Index>& points = snapshot.integers(name + ".near.points", 0, problem_.contact.size() - 1);
    make_zone_of(points, nodes_near(problem_, problem_.internal_force->tangent(), points, zone_layers));
    zone_->load(snapshot, name + ".zone");
  }
  near_.load_history(snapshot, name + ".near");
}

/// The guess: increments of a smooth motion go on as they did. Supports are exact.
void IterativeStage::begin(const Stage& stage, StageSolution& solution) {
  guess_ = increment_;
  if (has_previous_) guess_ += increment_ - previous_;
  for (const int dof : unsolved_) guess_[dof] = 0.0;
  prescribe(problem_, stage, guess_);
  // Nothing that acts or is given: the residual of another guess would have nothing to be small beside.
  if (stage.right_hand_side.isZero(0.0) && stage.prescribed.isZero(0.0)) guess_.setZero();
  const Index points = problem_.contact.size();
  solution.normal_reaction.setZero(points);
  if (problem_.contact.has_friction()) solution.tangential_reaction.setZero(points * (problem_.dimension - 1));
  solution.contact_status.assign(static_cast<std::size_t>(points), ContactStatus::open);
  solution.clear_mean();
  solution.iterations = 0;
  const std::vector<Index> pressing = pressing_at_start(layer_.get(), stage);
  presses_at_start_ = !pressing.empty();
  if (near_.some_may_touch(stage)) {
    if (const std::vector<Index> approaching = near_.approaching(stage); !approaching.empty())
      make_zone(stage, approaching);
  }
  const auto is_outside = [&](Index point) { return near_.number(point) < 0; };
  if (std::any_of(pressing.begin(), pressing.end(), is_outside)) make_zone(stage, pressing);
}

/// b − A x, on the dofs that are solved for.
void IterativeStage::find_residual(const Stage& stage) {
  product_.multiply(guess_, residual_);
  residual_ = stage.right_hand_side - residual_;
  mask(residual_);
}

void IterativeStage::add_reactions(const Stage& stage, const StageSolution& solution, Vector& force) const {
  stage.rows->add_force(solution.acting_normal(), solution.acting_tangential(), force);
  mask(force);
}

/// The norm of all that acts, what moving supports exert among it: what the residual is small beside.
double IterativeStage::forces(const Stage& stage, const StageSolution& solution) {
  work_ = stage.right_hand_side;
  if (problem_.supports.size() > 0 && !stage.prescribed.isZero(0.0)) {
    prescribed_.setZero(problem_.dof_count());
    prescribe(problem_, stage, prescribed_);
    product_.multiply(prescribed_, supported_force_);
    work_ -= supported_force_;
  }
  mask(work_);
  const double given = gradients_.norm(*preconditioner_, work_);
  work_.setZero();
  add_reactions(stage, solution, work_);
  return std::max(given, gradients_.norm(*preconditioner_, work_));
}

void IterativeStage::solve_linear(double target) {
  const auto product = [&](const Vector& x, Vector& y) {
    product_.multiply(x, y);
    mask(y);
  };
  const auto result = gradients_.solve(product, *preconditioner_, target, iteration_limit, residual_, guess_);
  if (result.converged) return;
  throw Error(ErrorKind::not_converged,
              fmt::format("conjugate gradients stopped after {} iterations at {:.2g} of the residual asked for; "
                          "set solver.method = \"direct\" if memory allows",
                          result.iterations, result.residual / target));
}

void IterativeStage::solve(const Stage& stage, StageSolution& solution) {
  begin(stage, solution);
  double target = 0.0;
  bool must_touch = false;  // points have penetrated where none was thought to touch
  for (int round = 0; round < round_limit; ++round) {
    find_residual(stage);
    const bool touches = zone_ != nullptr && (must_touch || presses_at_start_ || near_.some_may_touch(stage));
    if (touches) {
      zone_->solve(stage, residual_, guess_, solution);
      find_residual(stage);
      add_reactions(stage, solution, residual_);
    }
    if (target == 0.0) target = options_.tolerance * forces(stage, solution);
    const double norm = gradients_.norm(*preconditioner_, residual_);
    if (norm <= target) {
      if (layer_) layer_->find_motion(*stage.rows, solution, guess_, solution.contact_increment);
      stage.rows->normal_motion(layer_ ? solution.contact_increment : guess_, motion_);
      const std::vector<Index> penetrating = near_.penetrating(stage, motion_, !touches);
      if (penetrating.empty()) {
        touches_ = touches;
        return end(stage, solution);
      }
      must_touch = true;
      if (std::any_of(penetrating.begin(), penetrating.end(), [&](Index p) { return near_.number(p) < 0; }))
        make_zone(stage, penetrating);
      target = 0.0;
      continue;
    }
    solve_linear(touches ? std::max(0.3 * target, round_reduction * norm) : 0.9 * target);
  }
  throw Error(
      ErrorKind::not_converged,
      fmt::format("contact and conjugate gradients did not converge in {} rounds; the time step is long compared "
                  "with the time in which a wave crosses {} cells: set solver.method = \"direct\" or take a "
                  "smaller time.step",
                  round_limit, zone_layers));
}

void IterativeStage::end(const Stage& stage, StageSolution& solution) {
  near_.learn(stage, motion_, static_cast<std::size_t>((solution.normal_reaction.array() > 0.0).count()));
  previous_ = increment_;
  increment_ = guess_;
  has_previous_ = true;
  solution.increment = guess_;
  const std::vector<Index>& supported = problem_.supports.dofs();
  solution.support_reaction.resize(problem_.supports.size());
  if (supported.empty()) return;
  product_.multiply(guess_, work_);
  work_ -= stage.right_hand_side;
  stage.rows->add_force(-solution.acting_normal(), -solution.acting_tangential(), work_);
  for (std::size_t i = 0; i < supported.size(); ++i)
    solution.support_reaction[static_cast<Index>(i)] = work_[supported[i]];
}

}  // namespace

std::unique_ptr<StageSolver> make_iterative_stage(const SemidiscreteProblem& problem,
                                                  const OperatorCoefficients& coefficients,
                                                  const StepSolverOptions& options, FactoredStage* layer) {
  return std::make_unique<IterativeStage>(problem, coefficients, options, layer);
}

}  // namespace ricochet
