#include "ricochet/linear_algebra/single_precision_cg.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "ricochet/base/flush_denormals.hpp"
#include "ricochet/base/node_order.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/node_kernels.hpp"

namespace ricochet {

namespace {

template <int d>
using Square = Eigen::Matrix<double, d, d>;
template <int d>
using SingleSquare = Eigen::Matrix<float, d, d>;

/// Returns a block with zeros in the rows and columns of dofs that are not solved for.
template <int d>
Square<d> masked(const double* values, const std::vector<char>& solved, Index row, Index column) {
  Square<d> block = Eigen::Map<const Square<d>>(values);
  for (int k = 0; k < d; ++k) {
    if (solved[std::size_t(row * d + k)] == 0) block.row(k).setZero();
    if (solved[std::size_t(column * d + k)] == 0) block.col(k).setZero();
  }
  return block;
}

/// Computes L⁻¹ per node. A block that is not positive definite is treated as if it were: conjugate gradients detect
/// it.
template <int d>
void invert_factors(const Vector& blocks, const std::vector<char>& solved, std::vector<float>& result) {
  result.assign(std::size_t(blocks.size()) + 1, 0.0F);
  parallel_ranges(blocks.size() / (d * d), [&](Index begin, Index end) {
    for (Index node = begin; node < end; ++node) {
      Square<d> own = masked<d>(blocks.data() + node * d * d, solved, node, node);
      for (int a = 0; a < d; ++a) {
        if (solved[std::size_t(node * d + a)] == 0) own(a, a) = 1.0;
      }
      const Eigen::LLT<Square<d>> factor(own);
      Square<d> inverse = Square<d>::Identity();
      if (factor.info() == Eigen::Success) factor.matrixL().solveInPlace(inverse);
      Eigen::Map<SingleSquare<d>>(result.data() + node * d * d) = inverse.template cast<float>();
    }
  });
}

template <int d>
void scale_blocks(const NodeMatrix& matrix, const std::vector<char>& solved, const std::vector<float>& inverse_factor,
                  LargeVector<float>& result) {
  const NodePattern& pattern = matrix.pattern();
  result.assign(matrix.values().size(), 0.0F);
  const auto factor_of = [&](Index node) -> Square<d> {
    return Eigen::Map<const SingleSquare<d>>(inverse_factor.data() + node * d * d).template cast<double>();
  };
  parallel_ranges(pattern.parts(), [&](Index first, Index last) {
    pattern.visit_rows(first, last, [&](int node, Index first_block, const RowGroup& group) {
      const Square<d> own = factor_of(node);
      for (Index k = first_block; k < first_block + group.blocks_per_row(); ++k) {
        const Index other = pattern.column[std::size_t(k)];
        const Square<d> block = masked<d>(matrix.values().data() + k * d * d, solved, node, other);
        Eigen::Map<SingleSquare<d>>(result.data() + k * d * d) =
            (own * block * factor_of(other).transpose()).template cast<float>();
      }
    });
  });
}

template <int d>
Square<d> block_of(const std::vector<float>& blocks, Index node) {
  return Eigen::Map<const SingleSquare<d>>(blocks.data() + node * d * d).template cast<double>();
}

/// Calls work with d as a compile-time constant.
template <class Work>
auto with_dimension(int d, const Work& work) {
  return d == 2 ? work(std::integral_constant<int, 2>{}) : work(std::integral_constant<int, 3>{});
}

}  // namespace

SinglePrecisionCg::SinglePrecisionCg(const NodeMatrix& matrix, const Vector& diagonal_blocks,
                                     const std::vector<char>& solved, const Ranks& ranks)
    : matrix_(matrix), ranks_(ranks) {
  if (matrix.dimension() == 2) {
    invert_factors<2>(diagonal_blocks, solved, inverse_factor_);
    scale_blocks<2>(matrix, solved, inverse_factor_, values_);
  } else {
    invert_factors<3>(diagonal_blocks, solved, inverse_factor_);
    scale_blocks<3>(matrix, solved, inverse_factor_, values_);
  }
  for (Numbers* numbers : {&x_, &residual_, &direction_, &image_}) numbers->setZero(matrix.size());
}

/// Computes q = Â p; returns pᵀ q.
double SinglePrecisionCg::multiply() {
  const NodePattern& pattern = matrix_.pattern();
  std::array<double, most_node_parts> sums{};
  parallel_ranges(pattern.parts(), [&](Index first, Index last) {
    const FlushDenormals flush;
    for (Index part = first; part < last; ++part) {
      sums[std::size_t(part)] = multiply_single_rows(part_rows(pattern, part, values_.data()), matrix_.dimension(),
                                                     direction_.data(), image_.data());
    }
  });
  double total = 0.0;
  for (const double sum : sums) total += sum;
  // Each rank has its contribution to the image, which is the one that pᵀ q needs.
  total = ranks_.sum(total);
  ranks_.accumulate(image_);
  return total;
}

/// Returns |r̂|² from the sum over this rank's nodes, which includes nodes owned by others.
double SinglePrecisionCg::squared_norm(double of_all_nodes) const {
  const int d = matrix_.dimension();
  for (const Index node : ranks_.not_owned()) of_all_nodes -= double(residual_.segment(node * d, d).squaredNorm());
  return ranks_.sum(of_all_nodes);
}

/// Computes r̂ = L⁻¹ r / |L⁻¹ r|; returns the norm.
double SinglePrecisionCg::scale(const Vector& residual) {
  return with_dimension(matrix_.dimension(), [&](auto dimension) {
    constexpr int d = dimension;
    const auto at = [&](Index node) {
      return (block_of<d>(inverse_factor_, node) * residual.segment<d>(node * d)).squaredNorm();
    };
    double squared = parallel_sum<double>(residual.size() / d, [&](Index begin, Index end) {
      double sum = 0.0;
      for (Index node = begin; node < end; ++node) sum += at(node);
      return sum;
    });
    for (const Index node : ranks_.not_owned()) squared -= at(node);
    const double norm = std::sqrt(ranks_.sum(squared));
    if (!(norm > 0.0) || !std::isfinite(norm)) return norm;
    parallel_ranges(residual.size() / d, [&](Index begin, Index end) {
      for (Index node = begin; node < end; ++node) {
        const Eigen::Matrix<double, d, 1> value = block_of<d>(inverse_factor_, node) * residual.segment<d>(node * d);
        residual_.segment<d>(node * d) = (value / norm).template cast<float>();
      }
    });
    return norm;
  });
}

/// Computes x += factor · L⁻ᵀ x̂.
void SinglePrecisionCg::add_to(Vector& x, double factor) const {
  with_dimension(matrix_.dimension(), [&](auto dimension) {
    constexpr int d = dimension;
    parallel_ranges(x.size() / d, [&](Index begin, Index end) {
      for (Index node = begin; node < end; ++node) {
        const Eigen::Matrix<double, d, 1> value = x_.segment<d>(node * d).template cast<double>();
        x.segment<d>(node * d) += factor * (block_of<d>(inverse_factor_, node).transpose() * value);
      }
    });
  });
}

ConjugateGradients::Result SinglePrecisionCg::solve(const Vector& residual, double reduction, int iteration_limit,
                                                    Vector& x) {
  ConjugateGradients::Result result;
  const double norm = scale(residual);
  if (!(norm > 0.0) || !std::isfinite(norm)) {
    result.residual = norm;
    result.converged = norm == 0.0;
    return result;
  }
  x_.setZero();
  direction_ = residual_;
  double squared = 1.0;
  while (true) {
    result.residual = norm * std::sqrt(squared);
    result.converged = squared <= reduction * reduction;
    if (result.converged || result.iterations == iteration_limit) break;
    const double curvature = multiply();
    if (!(curvature > 0.0) || !std::isfinite(squared)) break;
    ++result.iterations;
    const auto length = float(squared / curvature);
    const double next = squared_norm(parallel_sum<double>(x.size(), [&](Index begin, Index end) {
      const FlushDenormals flush;
      double sum = 0.0;
      constexpr Index stretch = 512;
      for (Index at = begin; at < end; at += stretch) {
        const Index count = std::min(stretch, end - at);
        x_.segment(at, count) += length * direction_.segment(at, count);
        residual_.segment(at, count) -= length * image_.segment(at, count);
        sum += double(residual_.segment(at, count).squaredNorm());
      }
      return sum;
    }));
    const auto factor = float(next / squared);
    squared = next;
    parallel_ranges(x.size(), [&](Index begin, Index end) {
      const FlushDenormals flush;
      direction_.segment(begin, end - begin) =
          residual_.segment(begin, end - begin) + factor * direction_.segment(begin, end - begin);
    });
  }
  add_to(x, norm);
  return result;
}

}  // namespace ricochet
