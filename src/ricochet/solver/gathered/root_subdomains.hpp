#pragma once

#include <memory>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/gathered/gathered_contact.hpp"
#include "ricochet/solver/subdomain/contact_neighbourhood.hpp"
#include "ricochet/solver/subdomain/subdomains.hpp"

/// @file Contact subdomains of a body that is divided among ranks, as solved by one of them, their root.
namespace ricochet {

class FactoredStage;

/// Data of the whole body near its contact, distributed over the ranks.
struct DistributedRegion {
  const SemidiscreteProblem& problem;
  OperatorCoefficients coefficients;
  const std::vector<char>& solved;  ///< per dof: solved for
  const StageProduct& product;      ///< with A
  ContactNeighbourhood& neighbourhood;
};
/// Nodes of a rank near the contact of all ranks, and A on them.
struct RegionNodes {
  int layers = 0;
  std::vector<Index> nodes;  ///< ascending
  SparseMatrix matrix;       ///< per dof of these nodes
};

/// Share of the subdomains at one root: all roots partition the points in the same way, and each takes its share. All
/// functions are collective over the ranks; those that end in _on_root work only at the root, where several roots may
/// work at once.
class RootSubdomains {
 public:
  /// `condensed_stage` is at the root, on `contact.nodes()`. Keeps references to all arguments.
  RootSubdomains(const DistributedRegion& body, SharedContact& shared, GatheredContact& contact,
                 FactoredStage* condensed_stage)
      : body_(body), shared_(shared), contact_(contact), condensed_stage_(condensed_stage) {}

  /// Gathers these points of each rank, and the body near them, at the root.
  void gather_body(const std::vector<Index>& points, const RegionNodes& region);
  /// Partitions the points. Returns the number of subdomains at all roots; 0 elsewhere.
  std::size_t partition_on_root();
  /// Makes a share of the subdomains: every `count`-th one from `number` on.
  void make_on_root(std::size_t number, std::size_t count);
  void clear() { subdomains_.reset(); }

  /// Gather the stage and the residual at the root, solve there, and add motion and reactions to the values on the
  /// ranks.
  void gather(const LinearStage& stage, const Vector& x, const std::vector<Index>& points, const Vector& residual);
  void solve_on_root();
  void scatter(const std::vector<Index>& points, Vector& x, StageSolution& solution);
  /// Adds the contribution of the last solution to the motion of massless contact nodes.
  void add_motion(Vector& motion);

  [[nodiscard]] const GatheredContact& contact() const { return contact_; }
  /// Subdomains; null elsewhere.
  [[nodiscard]] Subdomains* subdomains() const { return subdomains_.get(); }

 private:
  [[nodiscard]] MatrixGraph gather_graph(const std::vector<Index>& nodes);
  [[nodiscard]] std::vector<Index> gather_points(const std::vector<Index>& points) const;
  void widen_rows();

  DistributedRegion body_;
  SharedContact& shared_;
  GatheredContact& contact_;
  FactoredStage* condensed_stage_;
  GatheredNodes nodes_;
  Vector correction_, contact_motion_;  ///< per dof; zero between calls
  // At the root:
  std::vector<Index> points_;
  std::unique_ptr<SemidiscreteProblem> root_problem_;
  std::vector<char> region_solved_;
  StageProduct region_product_;
  std::unique_ptr<ContactNeighbourhood> region_neighbourhood_;
  std::unique_ptr<Subdomains> subdomains_;
  Stage stage_;
  std::shared_ptr<const ContactRows> rows_, region_rows_;  ///< as received, and on all nearby nodes
  StageSolution solution_;
  Vector region_residual_, region_x_, region_motion_;
};

}  // namespace ricochet
