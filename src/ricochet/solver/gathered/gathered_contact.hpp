#pragma once

#include <memory>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/gathered/gathered_nodes.hpp"
#include "ricochet/step/stage.hpp"

/// @file Contact points of a body that is divided among ranks, gathered on one of them, their root, which solves the
/// contact problems. All functions are collective over the ranks.
namespace ricochet {

class GatheredContact {
 public:
  /// `root_index` selects the root: 0 is the rank with most contact points, 1 the next one, and so on. Keeps a
  /// reference to the problem.
  explicit GatheredContact(const SemidiscreteProblem& problem, std::size_t root_index = 0);

  [[nodiscard]] bool is_root() const { return nodes_.is_root(); }
  /// Gathered contact nodes.
  [[nodiscard]] const GatheredNodes& nodes() const { return nodes_; }
  /// Nodes that some rank names, extended to all ranks that have them; ascending.
  [[nodiscard]] std::vector<Index> named_by_all(const std::vector<Index>& nodes) const;

  /// Makes, at the root, a problem of gathered nodes (contact nodes come first), with all contact points and no forces.
  /// Supported dofs are not among its contact dofs. Its rows are those of the last gathered stage.
  [[nodiscard]] std::unique_ptr<SemidiscreteProblem> make_problem(const GatheredNodes& nodes) const;
  /// Rows of a stage at the root, on so many dofs of such a problem instead of those of the contact nodes.
  [[nodiscard]] static std::shared_ptr<const ContactRows> rows_on(const ContactRows& rows, Index dofs);

  /// Gathers a stage at the root, with these points of this rank; others are not eligible there. The root solves for
  /// the correction of an increment x: its offsets are q + sGx and p + σB_T x. Offsets, their rounding, eligibility and
  /// start values are transferred; forces, motion and obstacles are not. `points` is the same as that of scatter().
  void gather(const LinearStage& stage, const Vector& x, const std::vector<Index>& points, Stage& at_root);
  /// Adds the reactions and iterations of the solution at the root on these points; the status of a point becomes the
  /// larger one. Mean reactions and their weight are those of the root, which also has the works of the path: the
  /// ranks' works are summed.
  void scatter(const StageSolution& at_root, const std::vector<Index>& points, StageSolution& solution);

  /// Number, at the root, of a point of a rank.
  [[nodiscard]] Index number(int rank, Index point) const { return first_[std::size_t(rank)] + point; }
  [[nodiscard]] Index point_count() const { return first_.back(); }

 private:
  void gather_boundary();
  void gather_rows(const ContactRows& rows);
  /// Sends the values of these points of each rank to the root, where they are entered in `at_root`; those of other
  /// points are kept there, or zero.
  template <class Values>
  void gather_values(const std::vector<Index>& points, const Values& values, bool keeps, Values& at_root) const;

  const SemidiscreteProblem& problem_;
  int d_;
  std::vector<Index> first_;  ///< number at the root of the first point of each rank, and of all
  GatheredNodes nodes_;
  ContactBoundary boundary_;           ///< at the root, on the contact nodes
  std::vector<Index> contact_dofs_;    ///< at the root
  std::shared_ptr<ContactRows> rows_;  ///< at the root: those of the last stage
  std::vector<long> revision_;         ///< of rows of this rank when they were sent
  long changes_ = 0;                   ///< of rows; different rows have different revisions at the root
  Stage sent_stage_;                   ///< conditions and start values of this rank, about x
  StageSolution received_solution_;    ///< reactions of points of this rank
  Vector motion_;
};

}  // namespace ricochet
