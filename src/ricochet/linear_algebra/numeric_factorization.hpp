#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "ricochet/base/timer.hpp"
#include "ricochet/linear_algebra/panel_factorization.hpp"

/// @file Supernodal Cholesky factorization, left-looking, written straight into the layout that the solves read.
///
/// Wide supernodes are cut into panels of columns. A panel receives A's entries, then the contributions of all earlier
/// supernodes, in their order, and is factorized. Unlike in a multifrontal method there are no update matrices to keep:
/// besides the factor a thread needs one panel. Subtrees of the elimination tree are independent tasks; the panels
/// above them are divided by rows. Each entry's sum is computed in the order of the columns, so that bits depend
/// neither on the number of threads nor on the division.
///
/// The form L Lᵀ, instead of L D Lᵀ, is relied on in factorize_triangle (pivots are positive), in the products of a
/// panel with itself (no D between), in the solves, and in DelassusProblem (W = YᵀY).
namespace ricochet {

class NumericFactorization {
 public:
  /// Plans a factorization. Keeps a reference to the factor, whose numbers it will write.
  explicit NumericFactorization(SupernodalFactor& factor);

  /// Factorizes L Lᵀ = scale · A. Returns the first column whose pivot is not positive, or −1. Allocates nothing from
  /// the second call on. Logs its progress from time to time.
  Index run(const LowerColumns& matrix, double scale);

 private:
  void plan_panels();
  void plan_updates();
  void plan_tasks();
  void prepare_workspaces();
  std::unique_ptr<PanelWorkspace> acquire_workspace();
  void release_workspace(std::unique_ptr<PanelWorkspace> workspace);
  void has_factorized(const FactorPanel& panel);
  Index factorize(int supernode, const LowerColumns& matrix, double scale, PanelWorkspace& workspace, bool divided);
  void factorize_subtree(std::size_t number, const LowerColumns& matrix, double scale);

  SupernodalFactor& factor_;
  std::vector<FactorPanel> panels_;
  std::vector<int> first_panel_;      ///< per supernode, and the end
  std::vector<PanelUpdate> updates_;  ///< by panel, then by source
  std::vector<Index> first_update_;   ///< per panel, and the end
  Index max_rows_ = 0;
  double all_operations_ = 0.0;

  /// A task: supernodes [begin, end).
  struct Subtree {
    int begin = 0, end = 0;
  };
  std::vector<Subtree> subtrees_;
  std::vector<Index> failed_;  ///< per subtree: the first column whose pivot is not positive, or the number of columns
  std::vector<int> top_;       ///< supernodes that are in no subtree, ascending

  std::mutex access_;  ///< guards the members below
  std::vector<std::unique_ptr<PanelWorkspace>> workspaces_;
  double done_ = 0.0;  ///< operations
  Timer since_logged_;
};

}  // namespace ricochet
