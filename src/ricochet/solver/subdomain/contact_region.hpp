#pragma once

#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/step/stage.hpp"

/// @file Part of a stage solved by iterations that is solved directly: the body near its contact.
namespace ricochet {

/// All functions are collective over the ranks, each with its own contact points.
class ContactRegion {
 public:
  virtual ~ContactRegion() = default;
  /// Makes subdomains for these points only. Throws Error(invalid_input) if A is not positive definite.
  virtual void make(const std::vector<Index>& points) = 0;
  virtual void clear() = 0;
  [[nodiscard]] virtual bool are_made() const = 0;
  /// Nodes of this rank that solve() may move, ascending.
  [[nodiscard]] virtual const std::vector<Index>& nodes() const = 0;

  /// Solves, from the residual b − A x of the whole body without reactions, for x near the contact and the reactions.
  virtual void solve(const LinearStage& stage, const Vector& residual, Vector& x, StageSolution& solution) = 0;
  /// For a stage with massless contact nodes: computes the contact motion m of the last solution (stage.hpp) on contact
  /// nodes, from δ per dof.
  virtual void find_motion(const ContactRows& rows, const StageSolution& solution, const Vector& increment,
                           Vector& motion) = 0;

  /// Saves and loads the subdomains of these points; loading makes them.
  virtual void persist(const SnapshotVisitor& visit, const std::vector<Index>& points) = 0;
  virtual void report() const = 0;
};

}  // namespace ricochet
