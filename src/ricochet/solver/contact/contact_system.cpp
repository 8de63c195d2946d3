#include "ricochet/solver/contact/contact_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/linear_algebra/dense_kernels.hpp"

namespace ricochet {

namespace {

/// Number of rows up to which the entries of a product operator are computed by products with unit vectors.
constexpr Index few_rows = 3000;
/// Number of rows up to which a dense matrix is always faster than a sparse one.
constexpr Index small = 150;
/// Number of rows from which on sweeps are limited by memory bandwidth.
constexpr Index many_rows = 350;

/// Exponent within which data are scaled to the middle of the range of numbers before they are squared.
constexpr int largest_exponent = 960;

/// Largest power of two that does not exceed a value.
double power_of_two(double value) { return std::isnormal(value) ? std::ldexp(1.0, std::ilogb(value)) : 1.0; }

}  // namespace

void ContactSystem::analyse(const ContactProblem& problem) {
  operator_ = problem.contact_operator;
  is_symmetric_ = problem.is_symmetric;
  problem_row_offset_ = problem.row_offset;
  gathered_.clear();
  row_of_.clear();
  points_.clear();
  const Index points = problem.points();
  scale_.assign(std::size_t(points), 1.0);
  normal_.assign(scale_.size(), 1.0);
  mean_.assign(scale_.size(), 1.0);
  std::vector<double> largest_of(scale_.size(), 0.0);
  found_.reset();
  if (operator_->dense() == nullptr && operator_->sparse() == nullptr && operator_->rows() <= few_rows) {
    Matrix entries(operator_->rows(), operator_->rows());
    Vector unit = Vector::Zero(operator_->rows()), column;
    for (Index j = 0; j < entries.cols(); ++j) {
      unit[j] = 1.0;
      operator_->multiply(unit, column);
      unit[j] = 0.0;
      entries.col(j) = column;
    }
    found_ = make_dense_operator(std::move(entries));
    operator_ = found_;
  }
  mode_ = operator_->dense() != nullptr ? Mode::dense : operator_->sparse() != nullptr ? Mode::sparse : Mode::product;
  // Few rows, or rows that are not sparse: dense loops are faster.
  if (mode_ == Mode::sparse) {
    const SparseMatrix& w = *operator_->sparse();
    const double rows = double(w.rows());
    if (w.rows() <= small || (w.rows() <= few_rows && double(w.nonZeros()) > 0.1 * rows * rows)) {
      found_ = make_dense_operator(Matrix(w));
      operator_ = found_;
      mode_ = Mode::dense;
    }
  }
  double largest = 0.0;
  fault_.clear();
  blocks_.clear();
  for (Index i = 0; i < points; ++i) {
    const auto at = std::size_t(i);
    const PointMatrix block =
        operator_->block(problem.row_offset[at], problem.row_offset[at + 1] - problem.row_offset[at]);
    blocks_.push_back(block);
    if (fault_.empty() && !(block.allFinite() && (block.diagonal().array() >= 0.0).all()))
      fault_ = fmt::format("W has a negative or non-finite entry in the diagonal block of point {}", i);
    normal_[at] = block(0, 0);
    mean_[at] = block.trace() / double(block.rows());
    largest_of[at] = block.diagonal().maxCoeff();
    largest = std::max(largest, largest_of[at]);
  }
  operator_scale_ = 1.0;
  if (!fault_.empty()) return;  // no solver runs with such a W
  // The root of a power of two is one only for even powers: W's largest diagonal is brought between one and two first.
  operator_scale_ = 1.0 / power_of_two(largest);
  // Even with respect to the first point: a scaling of other rows, the largest one's included, changes nothing.
  const auto present = std::ranges::find_if(largest_of, [](double d) { return d > 0.0; });
  if (present != largest_of.end() && ((std::ilogb(largest) - std::ilogb(*present)) & 1) != 0) operator_scale_ *= 0.5;
  for (std::size_t i = 0; i < scale_.size(); ++i) {
    const double diagonal = operator_scale_ * largest_of[i];
    if (std::isnormal(diagonal) && diagonal > 0.0) scale_[i] = std::ldexp(1.0, -(std::ilogb(diagonal) >> 1));
    const double factor = operator_scale_ * scale_[i] * scale_[i];
    mean_[i] *= factor;
    normal_[i] *= factor;
  }
}

ContactPoint ContactSystem::make_point(const ContactProblem& problem, Index i) const {
  const auto at = std::size_t(i);
  ContactPoint point;
  point.point = i;
  point.row = problem.row_offset[at];
  point.size = problem.row_offset[at + 1] - point.row;
  if (point.size > 1) {
    point.coefficient = problem.friction_coefficient[i];
    point.bound = problem.bound(i) * reaction_scale(i);
  }
  const bool friction = point.has_friction();
  if (!friction) point.size = 1;
  const double w = friction ? mean_[at] : normal_[at];
  if (w > 0.0) point.diagonal = w;
  return point;
}

void ContactSystem::set_data(const ContactProblem& problem) {
  data_scale_ = 1.0;
  data_ = 0.0;
  data_are_finite_ = true;
  double largest = 0.0;
  for (Index i = 0; i < problem.points(); ++i) {
    if (!problem.is_eligible(i)) continue;
    const Index row = problem.row_offset[std::size_t(i)];
    const auto q = problem.offset.segment(row, problem.row_offset[std::size_t(i) + 1] - row);
    data_are_finite_ = data_are_finite_ && q.allFinite();
    largest = std::max(largest, scale_[std::size_t(i)] * q.lpNorm<Eigen::Infinity>());
  }
  if (!data_are_finite_ || !std::isfinite(largest) || largest == 0.0) return;
  const double range = std::ldexp(1.0, std::clamp(-std::ilogb(largest), -largest_exponent, largest_exponent));
  for (Index i = 0; i < problem.points(); ++i) {
    if (!problem.is_eligible(i)) continue;
    ContactPoint point = make_point(problem, i);
    PaddedVector q = PaddedVector::Zero();
    const double scale = range * scale_[std::size_t(i)];
    for (Index k = 0; k < point.size; ++k) q[k] = scale * problem.offset[point.row + k];
    data_ = std::max(data_, residual(point, PaddedVector::Zero(), q));
  }
  const double unit = 1.0 / power_of_two(data_);
  data_scale_ = range * unit;
  data_ *= unit;
}

void ContactSystem::select(const ContactProblem& problem, const std::vector<char>& selected) {
  chosen_.clear();
  for (Index i = 0; i < problem.points(); ++i) {
    // Sparse and product operators keep all points: a selection would cost more than they do.
    if (mode_ != Mode::dense || selected[std::size_t(i)] != 0) chosen_.push_back(i);
  }
  gather(problem);
  offset_.resize(Index(row_of_.size()));
  offset_rounding_.setZero(offset_.size());
  for (Index row = 0; row < offset_.size(); ++row) {
    const auto at = std::size_t(row);
    const double scale = data_scale_ * row_scale_[at];
    offset_[row] = scale * problem.offset[row_of_[at]];
    if (problem.offset_rounding.size() > 0) offset_rounding_[row] = scale * problem.offset_rounding[row_of_[at]];
  }
  largest_offset_ = offset_.lpNorm<Eigen::Infinity>();
}

void ContactSystem::gather(const ContactProblem& problem) {
  last_points_.swap(points_);
  points_.clear();
  rows_.clear();
  for (const Index i : chosen_) {
    ContactPoint point = make_point(problem, i);
    const Index first = point.row;
    // Sparse and product operators keep all of their rows.
    const Index size = mode_ == Mode::dense ? point.size : problem_row_offset_[std::size_t(i) + 1] - first;
    point.row = Index(rows_.size());
    for (Index k = 0; k < size; ++k) rows_.push_back(first + k);
    if (problem.is_eligible(i)) points_.push_back(point);
  }
  const bool same = rows_ == row_of_ && chosen_ == gathered_;
  if (!same) {
    gathered_ = chosen_;
    row_of_ = rows_;
    row_scale_.assign(row_of_.size(), 1.0);
    std::size_t point = 0;
    for (std::size_t row = 0; row < row_of_.size(); ++row) {
      while (problem_row_offset_[point + 1] <= row_of_[row]) ++point;
      row_scale_[row] = scale_[point];
    }
    if (mode_ == Mode::dense) copy_dense();
    if (mode_ == Mode::sparse) copy_sparse();
  }
  const auto is_alike = [](const ContactPoint& a, const ContactPoint& b) { return a.row == b.row && a.size == b.size; };
  if (same && std::equal(points_.begin(), points_.end(), last_points_.begin(), last_points_.end(), is_alike)) return;
  point_operators_.clear();
  for (const ContactPoint& point : points_) {
    const double scale = row_scale_[std::size_t(point.row)];
    const PointMatrix& whole = blocks_[std::size_t(point.point)];
    const PointMatrix block = operator_scale_ * scale * scale * whole.topLeftCorner(point.size, point.size);
    point_operators_.push_back(make_point_operator(block));
  }
}

Index ContactSystem::system_row(Index problem_row) const {
  const auto found = std::ranges::lower_bound(row_of_, problem_row);
  return found != row_of_.end() && *found == problem_row ? found - row_of_.begin() : -1;
}

/// Copies rows in runs of neighbours.
void ContactSystem::copy_dense() {
  const Matrix& w = *operator_->dense();
  const auto count = Index(row_of_.size());
  if (matrix_.rows() != count) matrix_.resize(count, count);
  std::vector<Index>& runs = runs_;
  runs.clear();
  for (Index i = 0; i < count; ++i) {
    if (i == 0 || problem_row(i) != problem_row(i - 1) + 1) runs.push_back(i);
  }
  runs.push_back(count);
  const Eigen::Map<const Vector> scales(row_scale_.data(), count);
  double sum = 0.0;
  for (Index j = 0; j < count; ++j) {
    const double* column = w.data() + problem_row(j) * w.rows();
    const double scale = operator_scale_ * row_scale_[std::size_t(j)];
    for (std::size_t k = 0; k + 1 < runs.size(); ++k) {
      const Index first = runs[k], size = runs[k + 1] - first;
      const Eigen::Map<const Vector> from(column + problem_row(first), size);
      matrix_.col(j).segment(first, size) = (scale * scales.segment(first, size)).cwiseProduct(from);
    }
    sum += matrix_.col(j).sum();
  }
  note_sum(sum);
  single_.resize(0, 0);
  if (count >= many_rows) single_ = matrix_.cast<float>();
}

/// Checks the sum of the scaled entries, which are too small for a sum of finite ones to overflow.
void ContactSystem::note_sum(double sum) {
  if (!std::isfinite(sum) && fault_.empty()) fault_ = "W has non-finite entries";
}

void ContactSystem::copy_sparse() {
  double sum = 0.0;
  sparse_ = *operator_->sparse();
  for (Index j = 0; j < sparse_.cols(); ++j) {
    const double scale = operator_scale_ * row_scale_[std::size_t(j)];
    for (SparseMatrix::InnerIterator entry(sparse_, j); entry; ++entry)
      entry.valueRef() *= scale * row_scale_[std::size_t(entry.row())];
    sum += sparse_.col(j).sum();
  }
  note_sum(sum);
}

void ContactSystem::add_change(const ContactPoint& point, const PaddedVector& change, Vector& motion) const {
  if (mode_ == Mode::dense) {
    add_columns(motion.size(), point.size, matrix_.data() + point.row * matrix_.rows(), matrix_.rows(), change.data(),
                motion.data());
    return;
  }
  for (Index k = 0; k < point.size; ++k) {
    if (change[k] == 0.0) continue;
    for (SparseMatrix::InnerIterator entry(sparse_, point.row + k); entry; ++entry)
      motion[entry.row()] += change[k] * entry.value();
  }
}

void ContactSystem::add_change_roughly(const ContactPoint& point, const PaddedVector& change, Vector& motion) const {
  if (!has_rough_entries()) return add_change(point, change, motion);
  add_columns(motion.size(), point.size, single_.data() + point.row * single_.rows(), single_.rows(), change.data(),
              motion.data());
}

void ContactSystem::multiply(const Vector& x, Vector& y) const {
  if (mode_ != Mode::product) {
    y.setZero(rows());
    for (const ContactPoint& point : points_) {
      const PaddedVector part = padded(point, x);
      if (!part.isZero(0.0)) add_change(point, part, y);
    }
    return;
  }
  product_argument_.setZero(operator_->rows());
  for (const ContactPoint& point : points_) {
    for (Index row = point.row; row < point.row + point.size; ++row)
      product_argument_[row] = row_scale_[std::size_t(row)] * x[row];
  }
  operator_->multiply(product_argument_, product_result_);
  y.resize(rows());
  for (Index row = 0; row < y.size(); ++row)
    y[row] = operator_scale_ * row_scale_[std::size_t(row)] * product_result_[row];
}

void ContactSystem::evaluate(ContactIterate& iterate) const {
  iterate.motion = offset_;
  iterate.size = offset_.cwiseAbs();
  if (mode_ == Mode::dense) {
    for (const ContactPoint& point : points_) {
      const PaddedVector r = padded(point, iterate.reaction);
      if (r.isZero(0.0)) continue;
      add_columns(rows(), point.size, matrix_.data() + point.row * matrix_.rows(), matrix_.rows(), r.data(),
                  iterate.motion.data(), iterate.size.data());
    }
  } else if (mode_ == Mode::sparse) {
    for (const ContactPoint& point : points_) {
      for (Index k = point.row; k < point.row + point.size; ++k) {
        const double r = iterate.reaction[k];
        if (r == 0.0) continue;
        for (SparseMatrix::InnerIterator entry(sparse_, k); entry; ++entry) {
          iterate.motion[entry.row()] += r * entry.value();
          iterate.size[entry.row()] += std::abs(r * entry.value());
        }
      }
    }
  } else {
    Vector product;
    multiply(iterate.reaction, product);
    iterate.motion += product;
    // Σ |W r| as far as it is known: the point's own part, and the sum of the others. The bound Σ_j 4 |r_j| would take
    // residuals of 1e-8 for rounding with thousands of points.
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const Index first = points_[k].row;
      const PaddedVector r = padded(points_[k], iterate.reaction);
      const PaddedVector own = point_operators_[k].block * r;
      const PaddedVector own_size = point_operators_[k].block.cwiseAbs() * r.cwiseAbs();
      for (Index i = 0; i < points_[k].size; ++i)
        iterate.size[first + i] += own_size[i] + std::abs(product[first + i] - own[i]);
    }
  }
}

void ContactSystem::scale_reaction(const Vector& reaction, Vector& scaled) const {
  scaled.setZero(rows());
  for (const ContactPoint& point : points_) {
    const double scale = reaction_scale(point.point);
    const Index first = problem_row_offset_[std::size_t(point.point)];
    for (Index k = 0; k < point.size; ++k) scaled[point.row + k] = scale * reaction[first + k];
  }
}

void ContactSystem::unscale_reaction(const Vector& scaled, Vector& reaction) const {
  reaction.setZero(problem_row_offset_.back());
  for (const ContactPoint& point : points_) {
    const double scale = 1.0 / reaction_scale(point.point);
    const Index first = problem_row_offset_[std::size_t(point.point)];
    for (Index k = 0; k < point.size; ++k) reaction[first + k] = scale * scaled[point.row + k];
  }
}

void ContactSystem::unscale_motion(const Vector& scaled, Vector& motion) const {
  motion.resize(rows());
  for (Index row = 0; row < rows(); ++row) motion[row] = scaled[row] / (data_scale_ * row_scale_[std::size_t(row)]);
}

}  // namespace ricochet
