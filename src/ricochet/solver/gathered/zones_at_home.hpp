#pragma once

#include <memory>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/gathered/gathered_contact.hpp"
#include "ricochet/solver/subdomain/contact_zones.hpp"
#include "ricochet/solver/subdomain/points_nearby.hpp"

/// @file Contact zones of a body that is divided among ranks, as one of them, their home, solves them.
namespace ricochet {

class FactoredStage;

/// What there is of the whole body near its contact, part by part on the ranks.
struct NearBody {
  const SemidiscreteProblem& problem;
  OperatorCoefficients coefficients;
  const std::vector<char>& solved;  ///< per dof
  const StageProduct& product;      ///< with A
  PointsNearby& nearby;
};
/// Nodes of a rank near the contact of all ranks, and what A has on them.
struct NearNodes {
  int layers = 0;
  std::vector<Index> nodes;  ///< ascending
  SparseMatrix matrix;       ///< per dof of these nodes
};

/// Some of the zones: all homes divide the points in the same way, and each takes its share. All ranks call all
/// functions together; those that end in _here do something at home only, where several homes may do it at once.
class ZonesAtHome {
 public:
  /// `layer`: at home, of `contact.nodes()`. Keeps references to all.
  ZonesAtHome(const NearBody& body, bool all_points, GatheredContact& contact, FactoredStage* layer)
      : body_(body), all_points_(all_points), contact_(contact), layer_(layer) {}

  /// Brings these points of each rank home and what is near them, divides them, and makes a share of the zones: every
  /// `count`-th one from `number` on.
  void gather_body(const std::vector<Index>& points, const NearNodes& near);
  /// How many zones there are at all homes; 0 elsewhere.
  std::size_t divide_here();
  void make_here(std::size_t number, std::size_t count);
  void clear();

  /// Brings the stage and the residual home, solves there, and brings motion and reactions back, each added to what is
  /// there.
  void gather(const Stage& stage, const Vector& x, const std::vector<Index>& points, const Vector& residual);
  void solve_here();
  void spread(const std::vector<Index>& points, Vector& x, StageSolution& solution);
  /// Adds to the motion of contact nodes what the last solution gives the layer.
  void add_motion(Vector& motion);

  [[nodiscard]] const GatheredContact& contact() const { return contact_; }
  /// Null elsewhere.
  [[nodiscard]] ContactZones* zones() const { return zones_.get(); }
  /// Of zones that there were before.
  [[nodiscard]] double earlier_seconds() const { return earlier_seconds_; }

 private:
  [[nodiscard]] MatrixGraph gather_graph(const std::vector<Index>& nodes);
  [[nodiscard]] std::vector<Index> gather_points(const std::vector<Index>& points) const;
  void widen_rows();

  NearBody body_;
  bool all_points_;
  GatheredContact& contact_;
  FactoredStage* layer_;
  double earlier_seconds_ = 0.0;
  GatheredNodes nodes_;
  Vector correction_, layer_motion_;  ///< per dof; zero between calls
  // At home:
  std::vector<Index> points_;
  std::unique_ptr<SemidiscreteProblem> near_;
  std::vector<char> near_solved_;
  StageProduct near_product_;
  std::unique_ptr<PointsNearby> near_nearby_;
  std::unique_ptr<ContactZones> zones_;
  Stage stage_;
  std::shared_ptr<const ContactRows> rows_, near_rows_;  ///< as they came, and on all nodes that are near
  StageSolution solution_;
  Vector near_residual_, near_x_, near_motion_;
};

}  // namespace ricochet
