#include "ricochet/simulation/statics/equilibrium_equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/linear_algebra/indefinite_factor.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/problem/distortion_force.hpp"
#include "ricochet/simulation/statics/held_bodies.hpp"
#include "ricochet/simulation/statics/starting_stage.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// ε relative to the smallest K_ii/M_ii. Bodies that supports hold do not need it. For bodies that contact helps to
/// hold, ε is the only resistance of the operator to the motion that supports leave free, whose rounding is that of
/// forces over ε: with too small a value Newton's method does not settle; a larger one requires more iterations at the
/// end.
constexpr double proximal_fraction = 1e-10, proximal_fraction_of_unheld = 1e-4;
/// Tolerated residual, relative to the largest force, and largest effect of the rounding of positions beside it.
constexpr double left_of_forces = 1e-10, most_rounding = 1e-8;
/// Factor of corrections from which on they no longer shrink.
constexpr double stalled = 0.9;
/// Iterations that may follow where corrections no longer shrink but forces are not balanced.
constexpr int most_refusals = 20;
/// Stiffness of closed contact in the tangent whose stability is examined, relative to that of the body.
constexpr double contact_stiffness = 1e3;

double proximal_coefficient(const SemidiscreteProblem& problem) {
  const Vector stiffness = problem.internal_force->stiffness_diagonal(), mass = problem.mass.diagonal();
  double lowest = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < mass.size(); ++i) {
    if (mass[i] > 0.0 && stiffness[i] > 0.0) lowest = std::min(lowest, stiffness[i] / mass[i]);
  }
  return (all_are_fixed_by_supports(problem) ? proximal_fraction : proximal_fraction_of_unheld) * lowest;
}

}  // namespace

EquilibriumIterate::EquilibriumIterate(const SemidiscreteProblem& problem, const Vector& guess)
    : problem_(problem),
      epsilon_(proximal_coefficient(problem)),
      size_(extent(problem.nodes)),
      stiffness_(problem.internal_force->stiffness_diagonal().maxCoeff()),
      displacement_(guess),
      last_(guess),
      origin_(guess) {
  if (problem.internal_force->distortion() != nullptr) problem.internal_force->distortion()->control_distortion(true);
  problem.loads.total(0.0, load_);
  problem.supports.values(0.0, supported_);
  reactions_.normal_reaction.setZero(problem.contact.size());
  if (problem.contact.has_friction())
    reactions_.tangential_reaction.setZero(problem.contact.size() * (problem.dimension - 1));
  if (problem.contact.size() == 0) return;
  problem.gaps(guess, 0.0, overlap_);
  overlap_ = (-overlap_).cwiseMax(0.0);
}

void EquilibriumIterate::start(double part) {
  part_ = part;
  origin_ = last_ = displacement_;
}

void EquilibriumIterate::evaluate() {
  problem_.internal_force->evaluate(displacement_, force_);
  right_hand_side_ = part_ * load_ - force_;
  if (problem_.pressure) problem_.pressure->add_force(displacement_, 0.0, right_hand_side_, part_);
}

Stage EquilibriumIterate::stage() const {
  Stage stage = contact_stage(problem_, displacement_, right_hand_side_);
  stage.linearization.displacement.resize(0);  // one linear stage
  for (Index i = 0; i < problem_.supports.size(); ++i)
    stage.right_hand_side.prescribed[i] =
        part_ * supported_[i] - displacement_[problem_.supports.dofs()[std::size_t(i)]];
  if (overlap_.size() > 0) stage.conditions.gap.offset += (1.0 - part_) * overlap_;
  require_friction(problem_, displacement_ - origin_, 1.0, stage);
  stage.motion.reset();  // an iteration has the rows of its start
  return stage;
}

void EquilibriumIterate::store(const Stage& stage, const StageSolution& solution) {
  rows_ = stage.rows;
  reactions_ = solution;
}

bool EquilibriumIterate::is_balanced() const {
  if (!rows_) return false;
  const double size = largest(problem_, force_) + largest(problem_, part_ * load_);
  Vector residual = right_hand_side_;
  rows_->add_force(reactions_.normal_reaction, reactions_.tangential_reaction, residual);
  for (const Index dof : problem_.supports.dofs()) residual[dof] = 0.0;
  return largest(problem_, residual) <= left_of_forces * size + std::min(stiffness_ * rounding(), most_rounding * size);
}

NewtonEquations::Iteration EquilibriumIterate::sizes() const {
  return {largest(problem_, displacement_ - last_), largest(problem_, displacement_ - origin_)};
}

double EquilibriumIterate::rounding() const {
  return 4.0 * std::numeric_limits<double>::epsilon() * (size_ + largest(problem_, displacement_));
}

NewtonEquations::Iteration EquilibriumEquations::iterate() {
  const bool was_balanced = settles_ && iterate_.is_balanced();
  const Reactions reactions = iterate_.reactions();
  iterate_.begin_correction();
  correct();
  Iteration sizes = iterate_.sizes();
  const bool shrinks = sizes.correction < stalled * last_correction_;
  last_correction_ = sizes.correction;
  if (was_balanced && !shrinks) {
    iterate_.take_correction_back();
    iterate_.set_reactions(reactions);
    sizes.correction = 0.0;
  }
  return sizes;
}

bool EquilibriumEquations::accept(const Iteration& /*iteration*/, bool /*may_refuse*/) {
  if (iterate_.is_balanced()) return true;
  if (++refusals_ < most_refusals) return false;
  throw Error(ErrorKind::not_converged, "forces are not balanced where its motion ends");
}

KeptFactorEquilibrium::KeptFactorEquilibrium(EquilibriumIterate& iterate, const StepSolverOptions& options)
    : EquilibriumEquations(iterate),
      solver_(make_step_solver(iterate.problem(), {{iterate.epsilon(), 1.0, 0.0, StageDofs::all}}, options)) {}

void KeptFactorEquilibrium::correct() {
  Stage stage = iterate_.stage();
  solver_->solve(0, stage, solution_);
  iterate_.store(stage, solution_);
  iterate_.displacement() += solution_.increment;
}

void KeptFactorEquilibrium::accelerate() {
  point_ = iterate_.displacement() - solution_.increment;
  acceleration_.advance(point_, iterate_.displacement(), iterate_.displacement());
}

ExactEquilibrium::ExactEquilibrium(EquilibriumIterate& iterate)
    : EquilibriumEquations(iterate), exact_stage_(iterate.problem()) {
  const SemidiscreteProblem& problem = iterate.problem();
  for (Index dof = 0; dof < problem.dof_count(); ++dof) {
    const bool is_unknown = !problem.supports.contains(dof) && !problem.is_tied_dof(dof);
    equation_.push_back(is_unknown ? int(unknowns_++) : -1);
    motions_.push_back({equation_.back(), 1.0});
  }
}

/// Linearizes the equations about the iterate.
void ExactEquilibrium::assemble(const Stage& stage) {
  const SemidiscreteProblem& problem = iterate_.problem();
  const Vector& displacement = iterate_.displacement();
  assembly_.start(unknowns_, problem.dof_count());
  for (std::size_t k = 0; k < equation_.size(); ++k)
    if (equation_[k] >= 0) assembly_.right_hand_side(equation_[k]) = stage.right_hand_side.force[Index(k)];
  for (Index i = 0; i < problem.supports.size(); ++i)
    assembly_.set_known(problem.supports.dofs()[std::size_t(i)], stage.right_hand_side.prescribed[i]);
  assembly_.add(problem.internal_force->tangent(displacement), 1.0, equation_, motions_);
  assembly_.add(problem.mass.to_sparse(), iterate_.epsilon(), equation_, motions_);
  if (problem.pressure)
    assembly_.add(problem.pressure->mean_stiffness(displacement, 0.0, 0.0), iterate_.part(), equation_, motions_);
  if (proximal_weight_ > 0.0) {
    if (undeformed_.rows() == 0) undeformed_ = problem.internal_force->tangent(Vector::Zero(problem.dof_count()));
    assembly_.add(undeformed_, proximal_weight_, equation_, motions_);
  }
  if (problem.contact.size() > 0) {
    contact_.differentiate(problem, {iterate_.origin(), displacement, 0.0}, *stage.rows, iterate_.reactions());
    assembly_.add_contact(contact_, stage.conditions, 1.0, {&equation_}, motions_, tangent_);
  }
  assembly_.write(tangent_);
}

void ExactEquilibrium::correct() {
  last_reactions_ = iterate_.reactions();
  const Stage stage = iterate_.stage();
  assemble(stage);
  static_cast<Reactions&>(solution_) = last_reactions_;
  exact_stage_.solve(tangent_, stage.conditions.eligible, solution_, solved_);
  iterate_.store(stage, solution_);
  Vector& displacement = iterate_.displacement();
  for (Index dof = 0; dof < displacement.size(); ++dof) displacement[dof] += assembly_.value(solved_, motions_, dof);
}

void ExactEquilibrium::take_back() {
  iterate_.take_correction_back();
  iterate_.set_reactions(last_reactions_);
  iterate_.evaluate();
}

/// Computes the symmetric part of the tangent, with the stiffness of closed contact and, where there is friction, of
/// closed points along the surface.
void ExactEquilibrium::make_held_tangent(SparseMatrix& matrix) {
  assemble(iterate_.stage());
  const double stiffness = contact_stiffness * tangent_.matrix.diagonal().cwiseAbs().maxCoeff();
  std::vector<Eigen::Triplet<double>> entries;
  const auto hold = [&](const SparseRowMatrix& rows, Index row) {
    for (SparseRowMatrix::InnerIterator one(rows, row); one; ++one)
      for (SparseRowMatrix::InnerIterator other(rows, row); other; ++other)
        entries.emplace_back(int(one.col()), int(other.col()), stiffness * one.value() * other.value());
  };
  const Reactions& reactions = iterate_.reactions();
  const Index tangents = iterate_.problem().dimension - 1;
  for (Index point = 0; point < reactions.normal_reaction.size(); ++point) {
    if (!(reactions.normal_reaction[point] > 0.0)) continue;
    hold(tangent_.normal_motion, point);
    if (!iterate_.problem().contact.has_friction(point)) continue;
    for (Index k = 0; k < tangents; ++k) hold(tangent_.tangential_motion, point * tangents + k);
  }
  matrix.resize(unknowns_, unknowns_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  matrix += 0.5 * (tangent_.matrix + SparseMatrix(tangent_.matrix.transpose()));
}

Index ExactEquilibrium::unstable_directions(Vector& direction) {
  SparseMatrix matrix;
  proximal_weight_ = 0.0;
  make_held_tangent(matrix);
  if (SparseCholesky(matrix).positive_definite()) return 0;
  IndefiniteFactor factor;
  if (!factor.factorize(matrix) || factor.negative_eigenvalues() == 0) return 0;
  factor.find_negative_direction(matrix, solved_);
  const Index dofs = iterate_.problem().dof_count();
  assembly_.start(unknowns_, dofs);  // supports do not move
  direction.resize(dofs);
  for (Index dof = 0; dof < dofs; ++dof) direction[dof] = assembly_.value(solved_, motions_, dof);
  return factor.negative_eigenvalues();
}

double ExactEquilibrium::least_definite_weight() {
  SparseMatrix matrix;
  for (const double weight : {0.0, 0.01, 0.03, 0.1, 0.3, 1.0}) {
    proximal_weight_ = weight;
    make_held_tangent(matrix);
    if (SparseCholesky(matrix).positive_definite()) return weight;
  }
  return 3.0;
}

}  // namespace ricochet
