#pragma once

#include <memory>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/delassus/contact_basis.hpp"
#include "ricochet/solver/delassus/contact_candidates.hpp"
#include "ricochet/solver/delassus/delassus_columns.hpp"
#include "ricochet/solver/delassus/massless_contact_nodes.hpp"
#include "ricochet/solver/mean_reaction/mean_reaction.hpp"
#include "ricochet/solver/stage/shared_contact.hpp"
#include "ricochet/step/stage.hpp"

/// @file Contact conditions of a stage, condensed on its candidates for contact.
///
/// With 2ᵏA = PᵀLLᵀP, y = L⁻¹P 2ᵏb and, for the rows H = [G; B_T] of the candidates (those of a point together),
/// Y = L⁻¹PHᵀ and the Delassus operator W = YᵀY, a reaction ρ = 2ᵏ (r_N, −r_T) adds Yρ to y, and the contact problem is
///   (y/s, w/σ) = (q/s, p/σ) + Yᵀy + W ρ.
/// For a stage with massless contact nodes, with U = (1 − ℓ/2) V and Z = W − V, V = 2⁻ᵏ H A_c⁻¹ Hᵀ, it is
///   (y/s, w/σ) = (q/s, p/σ) + Yᵀy + Z ρ̄ + U ρ.
/// If rows follow the motion, columns are those of E with H = D E (contact_basis.hpp).
namespace ricochet {

class DelassusProblem {
 public:
  /// `unknown` is per dof: its number among the unknowns of the factor, or −1 if the stage does not solve for it.
  /// Keeps references to the problem, the factor and `shared`.
  DelassusProblem(const SemidiscreteProblem& problem, std::vector<int> unknown, const SparseCholesky& factor,
                  SharedContact& shared, std::unique_ptr<MasslessContactNodes> massless_nodes = nullptr);

  /// Computes the reactions on the candidates, adds Yρ to y and the iterations to those of the solution. Throws
  /// Error(not_converged), and Error(invalid_input) if no motion of linear bodies meets the conditions of contact.
  void solve(const LinearStage& stage, Vector& y, StageSolution& solution);
  /// Checks the resulting increment: returns false if no other point penetrates. True: those that do are candidates
  /// now, and the stage must be solved again. Completes the solution by m for a stage with massless contact nodes.
  bool add_penetrating(const LinearStage& stage, const Vector& increment, StageSolution& solution);

  /// Renews columns and W, with the rows of the next stage, after the factor has been made anew.
  void invalidate_columns();

  /// Saves and loads the candidates in the order in which they were added, which decides the bits of W, and the contact
  /// solver's warm start.
  void persist(const SnapshotVisitor& visit);

  /// Shows the contact problem of a solved stage, if it had one, to the observer (one that could not be solved is shown
  /// at once).
  void report() const;

 private:
  [[nodiscard]] Index rows_of(Index point) const;
  template <class Enter>
  void visit_rows(Index point, const Enter& enter) const;
  template <class Visit>
  void visit_following(const Visit& visit) const;
  void read_directions();
  [[nodiscard]] std::vector<int> missing_dofs() const;
  void append_dofs(const std::vector<int>& dofs, Matrix& w);
  void rebuild_columns(Matrix& w);
  void set_rows(const LinearStage& stage);
  void set_scale(double scale);
  void scale_warm_start(double ratio);
  void renew_columns(const std::vector<char>& is_new, Matrix& w);
  void use_condensed(Matrix w);
  void add_candidates(std::vector<Index> points);
  void append_candidates(const std::vector<Index>& points);
  void append_rows(const std::vector<Index>& points, Matrix& w);
  void append_batches(const std::vector<Index>& points, const std::vector<Index>& counts, const std::vector<int>& dofs,
                      const std::vector<Index>& batches);
  void prepare_contact(Matrix w, Vector start);
  bool choose_candidates(const LinearStage& stage);
  void start_again_with(const std::vector<Index>& points);
  void sort_by_tree_position(std::vector<Index>& points) const;
  [[nodiscard]] SparseMatrix transposed_columns(Index first, const std::vector<int>& unknown, Index unknowns) const;
  [[nodiscard]] Matrix release_column_product();
  void set_contact_operator(Matrix w);
  void use_end_weight(double theta);
  void add_initial_candidates(const LinearStage& stage);
  void solve_mean(const LinearStage& stage);
  void append_columns(Index first, Matrix& w);
  void append_supported();
  void regularize_directions_without_trace(Matrix& w) const;
  void find_offsets(const LinearStage& stage, const Vector& y);
  void choose_friction(const LinearStage& stage);
  [[nodiscard]] bool try_contact();
  void solve_contact();
  void log_iterations() const;
  [[nodiscard]] std::size_t closed_points() const;
  void write_solution(const LinearStage& stage, StageSolution& solution) const;
  void write_mean_reactions(const LinearStage& stage, StageSolution& solution) const;
  [[noreturn]] void throw_no_mean() const;
  [[noreturn]] void throw_not_solved() const;
  [[noreturn]] void throw_contradiction(const std::vector<Index>& contradiction) const;

  const SemidiscreteProblem& problem_;
  const SparseCholesky& factor_;
  std::vector<int> unknown_;
  double scale_;
  bool friction_;
  SharedContact& shared_;
  bool candidates_required_ = false;  ///< points have penetrated where none was expected to touch
  bool candidates_active_ = false;    ///< the candidates took part in the last stage
  bool has_new_factor_ = false;
  const ContactRows* rows_;     ///< of the stage being solved
  std::vector<long> revision_;  ///< of each candidate's rows in W; −1 for rows that never change
  ContactCandidates candidates_;
  std::vector<Index> candidate_counts_;  ///< number of candidates after each call of add_candidates
  DelassusColumns columns_;
  ContactBasis basis_;
  /// Unit rows of E were appended in batches: for each the number of batches of candidates before it, and that of unit
  /// rows after it.
  std::vector<Index> dof_batches_;
  Vector of_columns_;                                     ///< per row of E
  std::unique_ptr<MasslessContactNodes> massless_nodes_;  ///< null if the stage has no massless contact nodes
  Matrix column_product_;  ///< of columns, with massless contact nodes or rotating rows; else it is the contact
                           ///< operator itself
  MeanReaction mean_;
  SparseRowMatrix supported_;   ///< H on supported dofs: rows × supports
  Vector coefficient_, bound_;  ///< of friction, per candidate; the bound in units of r
  ContactProblem contact_;      ///< W, q, and the friction of the stage
  std::unique_ptr<ContactSolver> solver_;
  ContactSolution contact_solution_;
  Vector motion_;       ///< G δ, per contact point
  int iterations_ = 0;  ///< of all contact problems of the last stage: a mean may require several
};

/// Calls enter(row of the point, dof, value) for the entries of H.
template <class Enter>
void DelassusProblem::visit_rows(Index point, const Enter& enter) const {
  const Index tangents = problem_.dimension - 1;
  rows_->visit_normal(point, [&](Index dof, double value) { enter(Index{0}, dof, value); });
  for (Index k = 1; k < rows_of(point); ++k)
    rows_->visit_tangential(point * tangents + k - 1, [&](Index dof, double value) { enter(k, dof, value); });
}

}  // namespace ricochet
