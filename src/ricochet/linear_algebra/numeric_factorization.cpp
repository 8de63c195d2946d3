#include "ricochet/linear_algebra/numeric_factorization.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/log.hpp"
#include "ricochet/base/parallel.hpp"

namespace ricochet {

namespace {

/// Subtrees hold at most this fraction of the operations.
constexpr double parts_per_factorization = 32.0;
/// Factorizations with fewer operations are not divided.
constexpr double fewest_operations = 2e7;
/// Rows of a panel that one thread assembles at a time.
constexpr Index rows_per_tile = 192;
/// Seconds between two messages about the progress.
constexpr double silence = 5.0;

/// Operations of a range of columns.
double operations(const SupernodalFactor::Supernode& node, int begin, int end) {
  double sum = 0.0;
  for (int j = begin; j < end; ++j) {
    const double rows = node.columns + node.below - j;
    sum += rows * rows;
  }
  return sum;
}

}  // namespace

NumericFactorization::NumericFactorization(SupernodalFactor& factor) : factor_(factor) {
  plan_panels();
  plan_updates();
  plan_tasks();
}

void NumericFactorization::plan_panels() {
  for (Index s = 0; s < factor_.supernode_count(); ++s) {
    const SupernodalFactor::Supernode& node = factor_.supernode(s);
    max_rows_ = std::max<Index>(max_rows_, node.columns + node.below);
    const Index head = node.columns % 8, blocks = node.columns / 8;
    const Index count = std::max<Index>(1, (8 * blocks + max_panel_columns - 1) / max_panel_columns);
    first_panel_.push_back(int(panels_.size()));
    for (Index i = 0; i < count; ++i) {
      const Index begin = i == 0 ? 0 : head + 8 * (blocks * i / count), end = head + 8 * (blocks * (i + 1) / count);
      panels_.push_back({int(s), int(begin), int(end)});
    }
  }
  first_panel_.push_back(int(panels_.size()));
}

void NumericFactorization::plan_updates() {
  std::vector<int> panel_of(static_cast<std::size_t>(factor_.size()));
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    const int first = factor_.supernode(panels_[p].supernode).first;
    std::fill(panel_of.begin() + first + panels_[p].begin, panel_of.begin() + first + panels_[p].end, int(p));
  }
  const auto visit = [&](const auto& enter) {
    for (Index s = 0; s < factor_.supernode_count(); ++s) {
      const SupernodalFactor::Supernode& node = factor_.supernode(s);
      const int size = node.columns + node.below;
      const auto panel = [&](int row) { return panel_of[std::size_t(factor_.row(node, row))]; };
      for (int begin = node.columns; begin < size;) {
        int end = begin + 1;
        while (end < size && panel(end) == panel(begin)) ++end;
        enter(std::size_t(panel(begin)), PanelUpdate{int(s), begin, end});
        begin = end;
      }
    }
  };
  first_update_.assign(panels_.size() + 1, 0);
  visit([&](std::size_t panel, const PanelUpdate&) { ++first_update_[panel + 1]; });
  for (std::size_t p = 0; p < panels_.size(); ++p) first_update_[p + 1] += first_update_[p];
  updates_.resize(std::size_t(first_update_.back()));
  std::vector<Index> next(first_update_.begin(), first_update_.end() - 1);
  visit([&](std::size_t panel, const PanelUpdate& update) { updates_[std::size_t(next[panel]++)] = update; });
}

void NumericFactorization::plan_tasks() {
  const auto count = std::size_t(factor_.supernode_count());
  std::vector<double> per_supernode(count);
  for (std::size_t s = 0; s < count; ++s) {
    const SupernodalFactor::Supernode& node = factor_.supernode(Index(s));
    per_supernode[s] = operations(node, 0, node.columns);
    all_operations_ += per_supernode[s];
  }
  const bool divided = all_operations_ >= fewest_operations;
  const std::vector<int> root =
      factor_.subtrees(per_supernode, divided ? all_operations_ / parts_per_factorization : all_operations_);
  for (std::size_t s = 0; s < count; ++s) {
    if (root[s] < 0) {
      top_.push_back(int(s));
    } else if (s == 0 || root[s] != root[s - 1]) {
      subtrees_.push_back({int(s), int(s) + 1});
    } else {
      subtrees_.back().end = int(s) + 1;
    }
  }
  failed_.resize(subtrees_.size());
}

/// Provides one workspace for the calling thread besides those of the threads that work on parts of its panel.
void NumericFactorization::prepare_workspaces() {
  while (workspaces_.size() < std::size_t(thread_count()) + 1) {
    workspaces_.push_back(std::make_unique<PanelWorkspace>());
    workspaces_.back()->allocate(factor_.size(), max_rows_);
  }
}

std::unique_ptr<PanelWorkspace> NumericFactorization::acquire_workspace() {
  const std::lock_guard lock(access_);
  std::unique_ptr<PanelWorkspace> last = std::move(workspaces_.back());
  workspaces_.pop_back();
  return last;
}

void NumericFactorization::release_workspace(std::unique_ptr<PanelWorkspace> workspace) {
  const std::lock_guard lock(access_);
  workspaces_.push_back(std::move(workspace));
}

void NumericFactorization::has_factorized(const FactorPanel& panel) {
  const std::lock_guard lock(access_);
  done_ += operations(factor_.supernode(panel.supernode), panel.begin, panel.end);
  if (since_logged_.seconds() < silence) return;
  log::info(fmt::format("factorizing: {:.0f} % of the operations are done", 100.0 * done_ / all_operations_));
  since_logged_.restart();
}

/// Factorizes one panel after the other; with `divided`, on all threads.
Index NumericFactorization::factorize(int supernode, const LowerColumns& matrix, double scale,
                                      PanelWorkspace& workspace, bool divided) {
  const auto s = std::size_t(supernode);
  for (int number = first_panel_[s]; number < first_panel_[s + 1]; ++number) {
    const auto p = std::size_t(number);
    PanelFactorization panel(factor_, panels_[p], workspace);
    const Index rows = panel.rows();
    const auto assemble = [&](Index begin, Index end, PanelWorkspace& own) {
      panel.assemble(matrix, scale, updates_.data() + first_update_[p], updates_.data() + first_update_[p + 1], begin,
                     end, own.relative_rows);
    };
    if (divided && thread_count() > 1) {
      parallel_items((rows + rows_per_tile - 1) / rows_per_tile, [&](Index tile) {
        auto own = acquire_workspace();
        assemble(tile * rows_per_tile, std::min((tile + 1) * rows_per_tile, rows), *own);
        release_workspace(std::move(own));
      });
    } else {
      assemble(0, rows, workspace);
    }
    if (const Index failed = panel.factorize_triangle(); failed >= 0) return failed;
    if (divided) {
      parallel_ranges(panel.groups(), [&](Index begin, Index end) { panel.solve_groups(begin, end); });
    } else {
      panel.solve_groups(0, panel.groups());
    }
    has_factorized(panels_[p]);
  }
  return -1;
}

void NumericFactorization::factorize_subtree(std::size_t number, const LowerColumns& matrix, double scale) {
  auto workspace = acquire_workspace();
  const Subtree& subtree = subtrees_[number];
  Index failed = -1;
  for (int s = subtree.begin; s < subtree.end && failed < 0; ++s)
    failed = factorize(s, matrix, scale, *workspace, false);
  failed_[number] = failed < 0 ? factor_.size() : failed;
  release_workspace(std::move(workspace));
}

Index NumericFactorization::run(const LowerColumns& matrix, double scale) {
  prepare_workspaces();
  done_ = 0.0;
  since_logged_.restart();
  parallel_items(Index(subtrees_.size()), [&](Index number) { factorize_subtree(std::size_t(number), matrix, scale); });
  Index first_failed = factor_.size();
  for (const Index column : failed_) first_failed = std::min(first_failed, column);
  auto workspace = acquire_workspace();
  // Panels before a failed column may fail as well: the first failure of all is where one thread would have stopped.
  for (std::size_t k = 0; k < top_.size() && factor_.supernode(top_[k]).first < first_failed; ++k) {
    const Index failed = factorize(top_[k], matrix, scale, *workspace, true);
    if (failed >= 0) first_failed = failed;
  }
  release_workspace(std::move(workspace));
  return first_failed < factor_.size() ? first_failed : -1;
}

}  // namespace ricochet
