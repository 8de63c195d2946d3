#include "ricochet/scheme/reduced/lagged_rows.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

const std::string memory_of_rows = "lagged_rows";

using Values = Eigen::Map<const Eigen::VectorXd>;

/// Of rows first … last − 1.
Values values_of(const SparseRowMatrix& rows, Index first, Index last) {
  const Index begin = rows.outerIndexPtr()[first];
  return {rows.valuePtr() + begin, rows.outerIndexPtr()[last] - begin};
}

/// The largest change of a value, relative to the largest one; patterns are the same.
double change_of(const SparseRowMatrix& from, const SparseRowMatrix& to, Index first, Index last) {
  const Values before = values_of(from, first, last), after = values_of(to, first, last);
  if (before.size() == 0) return 0.0;
  const double size = before.lpNorm<Eigen::Infinity>(), change = (after - before).lpNorm<Eigen::Infinity>();
  if (size > 0.0) return change / size;
  return change > 0.0 ? 1.0 : 0.0;
}

void copy_rows(const SparseRowMatrix& from, SparseRowMatrix& to, Index first, Index last) {
  const Values values = values_of(from, first, last);
  std::copy_n(values.data(), values.size(), to.valuePtr() + to.outerIndexPtr()[first]);
}

}  // namespace

void LaggedRows::start(const State& state) {
  exact_ = nullptr;
  const auto known = state.memory.find(memory_of_rows);
  if (known == state.memory.end()) {
    lagged_ = nullptr;
    return;
  }
  if (lagged_ == nullptr) {
    lagged_ = std::make_shared<ContactRows>(*state.forces.rows);
    read_only_ = lagged_;
  }
  SparseRowMatrix &gap = lagged_->gap_operator, &slip = lagged_->tangential_trace;
  const Vector& values = known->second;
  if (values.size() != gap.nonZeros() + slip.nonZeros())
    Snapshot::refuse(memory_of_rows, "has a length that is none of this problem's");
  const Values gap_values(values.data(), gap.nonZeros()), slip_values(values.data() + gap.nonZeros(), slip.nonZeros());
  is_new_ = false;
  if (gap_values == values_of(gap, 0, gap.rows()) && slip_values == values_of(slip, 0, slip.rows())) return;
  std::copy_n(gap_values.data(), gap_values.size(), gap.valuePtr());
  std::copy_n(slip_values.data(), slip_values.size(), slip.valuePtr());
  std::fill(lagged_->revision.begin(), lagged_->revision.end(), ++revision_);
}

void LaggedRows::take_over(const Vector& motion, Stage& stage) {
  exact_ = stage.rows;
  renew();
  stage.rows = read_only_;
  stage.motion.reset();
  exact_->normal_motion(motion, motion_);
  stage.gap_offset += stage.gap_factor * motion_;
  lagged_->normal_motion(motion, motion_);
  stage.gap_offset -= stage.gap_factor * motion_;
  if (stage.slip_offset.size() == 0) return;
  exact_->tangential_motion(motion, motion_);
  stage.slip_offset += stage.slip_factor * motion_;
  lagged_->tangential_motion(motion, motion_);
  stage.slip_offset -= stage.slip_factor * motion_;
}

/// Where Ĥ is off H by too much it becomes H.
void LaggedRows::renew() {
  const ContactRows* const exact = exact_.get();
  if (lagged_ == nullptr) {
    lagged_ = std::make_shared<ContactRows>(*exact);
    read_only_ = lagged_;
    std::fill(lagged_->revision.begin(), lagged_->revision.end(), ++revision_);
    is_new_ = true;
    return;
  }
  ++revision_;
  const Index tangents = exact->dimension() - 1;
  for (Index i = 0; i < exact->size(); ++i) {
    const Index first = i * tangents, last = first + tangents;
    if (change_of(lagged_->gap_operator, exact->gap_operator, i, i + 1) <= slack &&
        change_of(lagged_->tangential_trace, exact->tangential_trace, first, last) <= slack)
      continue;
    copy_rows(exact->gap_operator, lagged_->gap_operator, i, i + 1);
    copy_rows(exact->tangential_trace, lagged_->tangential_trace, first, last);
    lagged_->normals.col(i) = exact->normals.col(i);
    lagged_->tangents[static_cast<std::size_t>(i)] = exact->tangents[static_cast<std::size_t>(i)];
    for (Index k = first; k < last; ++k)
      lagged_->slips[static_cast<std::size_t>(k)] = exact->slips[static_cast<std::size_t>(k)];
    lagged_->revision[static_cast<std::size_t>(i)] = revision_;
    is_new_ = true;
  }
}

void LaggedRows::add_difference(const Vector& normal, const Vector& tangential, Vector& force) {
  exact_->add_force(normal, tangential, force);
  motion_ = -normal;
  negative_ = -tangential;
  lagged_->add_force(motion_, negative_, force);
}

void LaggedRows::remember(State& state) const {
  if (!is_new_) return;
  const SparseRowMatrix &gap = lagged_->gap_operator, &slip = lagged_->tangential_trace;
  Vector& values = state.memory[memory_of_rows];
  values.resize(gap.nonZeros() + slip.nonZeros());
  values << values_of(gap, 0, gap.rows()), values_of(slip, 0, slip.rows());
}

}  // namespace ricochet
