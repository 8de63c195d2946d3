#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/log.hpp"
#include "ricochet/solver/delassus/delassus_problem.hpp"

// Rows H of the candidates, their basis E, and its columns.

namespace ricochet {

/// Superfluous unit rows of E up to which it is kept, and the part of all rows up to which it is.
constexpr Index most_unused_dofs = 60, most_unused_part = 2;

/// Takes the rows of the stage, and renews what depends on rows that have changed.
void DelassusProblem::set_rows(const LinearStage& stage) {
  rows_ = &stage.rows;
  const bool all_new = has_new_factor_;
  has_new_factor_ = false;
  if (all_new) set_scale(factor_.scale());
  if (candidates_.points().empty() || (rows_->revision.empty() && !all_new)) return;
  std::vector<char> is_new(static_cast<std::size_t>(basis_.size()), all_new ? 1 : 0);
  bool any = all_new, any_column = all_new;
  for (std::size_t i = 0; i < revision_.size() && !rows_->revision.empty(); ++i) {
    const long revision = rows_->revision[std::size_t(candidates_.points()[i])];
    if (revision == revision_[i]) continue;
    revision_[i] = revision;
    any = true;
    if (basis_.follows(i)) continue;
    any_column = true;
    std::fill_n(is_new.begin() + basis_.first(i), contact_.row_offset[i + 1] - contact_.row_offset[i], char{1});
  }
  if (!any) return;
  Matrix w = release_column_product();
  if (any_column) renew_columns(is_new, w);
  append_dofs(missing_dofs(), w);
  read_directions();
  if (basis_.unused_dofs() > most_unused_dofs && most_unused_part * basis_.unused_dofs() > basis_.size())
    rebuild_columns(w);
  use_condensed(std::move(w));
}

void DelassusProblem::renew_columns(const std::vector<char>& is_new, Matrix& w) {
  columns_.renew(transposed_columns(0, unknown_, factor_.size()), is_new, w);
  if (massless_nodes_)
    massless_nodes_->renew(transposed_columns(0, massless_nodes_->unknown(), massless_nodes_->size()), is_new);
}

/// Makes E anew, of the same candidates.
void DelassusProblem::rebuild_columns(Matrix& w) {
  if (log::enabled(log::Level::debug))
    log::debug(fmt::format("contact: of {} columns {} belong to dofs that are reached no more", basis_.size(),
                           basis_.unused_dofs()));
  basis_.clear();
  dof_batches_.clear();
  columns_.clear();
  if (massless_nodes_) massless_nodes_->clear();
  w.resize(0, 0);
  for (const Index point : candidates_.points())
    basis_.append_candidate(rows_of(point), problem_.contact.follows_motion(point));
  candidate_counts_.assign(1, Index(candidates_.points().size()));
  append_columns(0, w);
  append_dofs(missing_dofs(), w);
  read_directions();
}

/// Returns the rows of E from `first` on as columns: unknowns × rows.
SparseMatrix DelassusProblem::transposed_columns(Index first, const std::vector<int>& number, Index unknowns) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = first; i < basis_.size(); ++i) {
    const auto enter = [&](Index dof, double value) {
      const int unknown = number[std::size_t(dof)];
      if (unknown >= 0) entries.emplace_back(unknown, int(i - first), value);
    };
    const ContactBasis::Row& row = basis_.rows()[std::size_t(i)];
    if (row.dof >= 0) {
      enter(row.dof, 1.0);
      continue;
    }
    const Index point = candidates_.points()[std::size_t(row.candidate)];
    if (row.row == 0) {
      rows_->visit_normal(point, enter);
    } else {
      rows_->visit_tangential(point * (problem_.dimension - 1) + row.row - 1, enter);
    }
  }
  SparseMatrix transposed(unknowns, basis_.size() - first);
  transposed.setFromTriplets(entries.begin(), entries.end());
  return transposed;
}

void DelassusProblem::append_columns(Index first, Matrix& w) {
  if (first == basis_.size()) return;
  columns_.append(transposed_columns(first, unknown_, factor_.size()), w);
  if (massless_nodes_)
    massless_nodes_->append(transposed_columns(first, massless_nodes_->unknown(), massless_nodes_->size()));
}

void DelassusProblem::append_dofs(const std::vector<int>& dofs, Matrix& w) {
  if (dofs.empty()) return;
  const Index first = basis_.size();
  basis_.append_dofs(dofs);
  dof_batches_.push_back(Index(candidate_counts_.size()));
  dof_batches_.push_back((dof_batches_.size() > 1 ? dof_batches_[dof_batches_.size() - 2] : 0) + Index(dofs.size()));
  append_columns(first, w);
}

/// Calls visit(candidate, row of it, dof, value) for the entries of rows that follow the motion, where they act on
/// unknowns of the factors.
template <class Visit>
void DelassusProblem::visit_following(const Visit& visit) const {
  const std::vector<int>* const massless = massless_nodes_ ? &massless_nodes_->unknown() : nullptr;
  for (std::size_t i = 0; i < candidates_.points().size(); ++i) {
    if (!basis_.follows(i)) continue;
    visit_rows(candidates_.points()[i], [&](Index k, Index dof, double value) {
      const auto at = std::size_t(dof);
      if (value != 0.0 && (unknown_[at] >= 0 || (massless != nullptr && (*massless)[at] >= 0))) visit(i, k, dof, value);
    });
  }
}

/// Returns the dofs that have no row in E yet, by their position in the elimination tree: those that are close there
/// have nearly the same columns.
std::vector<int> DelassusProblem::missing_dofs() const {
  std::vector<std::pair<Index, int>> found;
  visit_following([&](std::size_t, Index, Index dof, double) {
    if (basis_.has_dof(dof)) return;
    const int unknown = unknown_[std::size_t(dof)];
    found.emplace_back(unknown >= 0 ? factor_.factor_index(unknown) : -1, int(dof));
  });
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::vector<int> result;
  for (const auto& [position, dof] : found) result.push_back(dof);
  return result;
}

void DelassusProblem::read_directions() {
  if (!basis_.any_follows()) return;
  basis_.begin_directions();
  visit_following([&](std::size_t i, Index k, Index dof, double value) { basis_.add(i, k, dof, value); });
  basis_.finish_directions();
}

/// Returns K = EA⁻¹Eᵀ of the present candidates.
Matrix DelassusProblem::release_column_product() {
  if (massless_nodes_ || basis_.any_follows()) return std::move(column_product_);
  return contact_.contact_operator != nullptr ? *contact_.contact_operator->dense() : Matrix();
}

void DelassusProblem::append_supported() {
  std::vector<Eigen::Triplet<double>> entries;
  const std::vector<Index>& dofs = problem_.supports.dofs();
  for (std::size_t i = 0; i < candidates_.points().size(); ++i) {
    visit_rows(candidates_.points()[i], [&](Index k, Index dof, double value) {
      const auto support = std::ranges::lower_bound(dofs, dof);
      if (support == dofs.end() || *support != dof) return;
      entries.emplace_back(int(contact_.row_offset[i] + k), int(support - dofs.begin()), value);
    });
  }
  supported_.resize(contact_.row_offset.back(), problem_.supports.size());
  supported_.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace ricochet
