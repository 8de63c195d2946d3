#include "ricochet/solver/corotated/corotated_frame.hpp"

#include <algorithm>

#include "ricochet/base/parallel.hpp"

namespace ricochet {

void CorotatedFrame::restart(const Vector& displacement) {
  if (displacement.size() > 0) {
    bodies_.fit(displacement, start_);
  } else {
    start_.assign(bodies_.count(), Tensor::Identity());
  }
  rotation_.assign(bodies_.count(), Tensor::Identity());
  is_identity_ = true;
  ++number_;
}

void CorotatedFrame::follow(const Vector& displacement) {
  bodies_.fit(displacement, fitted_);
  bool rotated = false;
  for (std::size_t i = 0; i < fitted_.size(); ++i) {
    fitted_[i] = (fitted_[i] * start_[i].transpose()).eval();
    rotated = rotated || rotation_angle(fitted_[i] * rotation_[i].transpose()) > slack;
  }
  if (!rotated) return;
  rotation_ = fitted_;
  is_identity_ = false;
  ++number_;
}

namespace {

/// Computes v_a ← R_a v_a, or R_aᵀ v_a; nodes of no body are unchanged.
template <int d, bool transposed>
void rotate_nodes(const BodyRotations& bodies, const std::vector<Tensor>& rotation, const Vector& from, Vector& to) {
  parallel_ranges(from.size() / d, [&](Index first, Index last) {
    for (Index node = first; node < last; ++node) {
      const int body = bodies.body_of_node(node);
      if (body < 0) {
        to.segment<d>(node * d) = from.segment<d>(node * d);
        continue;
      }
      const Eigen::Matrix<double, d, d> r = rotation[std::size_t(body)].template topLeftCorner<d, d>();
      const Eigen::Matrix<double, d, 1> value = from.segment<d>(node * d);
      if constexpr (transposed) {
        to.segment<d>(node * d) = r.transpose() * value;
      } else {
        to.segment<d>(node * d) = r * value;
      }
    }
  });
}

}  // namespace

void CorotatedFrame::scale_strains(const Vector& displacement, double part, Vector& result) const {
  std::vector<Tensor> rotations;
  bodies_.fit(displacement, rotations);
  const Vector reference = problem_.nodes.reshaped();
  const Vector position = reference + displacement;
  result.resize(position.size());
  problem_.dimension == 2 ? rotate_nodes<2, true>(bodies_, rotations, position, result)
                          : rotate_nodes<3, true>(bodies_, rotations, position, result);
  result = part * (result - reference);
}

void CorotatedFrame::rotate_back(const Vector& values, Vector& result) const {
  if (is_identity_) {
    result = values;
    return;
  }
  result.resize(values.size());
  problem_.dimension == 2 ? rotate_nodes<2, true>(bodies_, rotation_, values, result)
                          : rotate_nodes<3, true>(bodies_, rotation_, values, result);
}

void CorotatedFrame::rotate(Vector& values) const {
  if (is_identity_ || values.size() == 0) return;
  problem_.dimension == 2 ? rotate_nodes<2, false>(bodies_, rotation_, values, values)
                          : rotate_nodes<3, false>(bodies_, rotation_, values, values);
}

/// Calls visit(row, column, value) for all entries of H R, row by row, columns ascending. Entries of a row of H come by
/// ascending dof, those of a node together; rows in the frame have all d of them.
template <class Entry>
void CorotatedFrame::visit_rotated(const SparseRowMatrix& rows, const Entry& visit) const {
  const int d = problem_.dimension;
  for (Index row = 0; row < rows.rows(); ++row) {
    SparseRowMatrix::InnerIterator entry(rows, row);
    while (entry) {
      const Index node = entry.col() / d;
      Eigen::Vector3d value = Eigen::Vector3d::Zero();
      for (; entry && entry.col() / d == node; ++entry) value[entry.col() % d] = entry.value();
      const int body = bodies_.body_of_node(node);
      if (body >= 0) value = (rotation_[std::size_t(body)].transpose() * value).eval();
      for (int k = 0; k < d; ++k) visit(row, node * d + k, value[k]);
    }
  }
}

void CorotatedFrame::rotate_back(const SparseRowMatrix& rows, SparseRowMatrix& result) const {
  if (result.rows() == rows.rows() && result.cols() == rows.cols() && result.isCompressed()) {
    Index at = 0;
    bool same = true;
    visit_rotated(rows, [&](Index row, Index column, double value) {
      same = same && at < result.outerIndexPtr()[row + 1] && at >= result.outerIndexPtr()[row] &&
             result.innerIndexPtr()[at] == column;
      if (same) result.valuePtr()[at++] = value;
    });
    if (same && at == result.nonZeros()) return;
  }
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(std::size_t(rows.nonZeros() * problem_.dimension));
  visit_rotated(rows,
                [&](Index row, Index column, double value) { entries.emplace_back(int(row), int(column), value); });
  result.resize(rows.rows(), rows.cols());
  result.setFromTriplets(entries.begin(), entries.end());
}

void CorotatedFrame::persist(const SnapshotVisitor& visit) {
  visit.numbers("rotation", rotation_);
  if (!visit.loads()) return;
  is_identity_ = std::ranges::all_of(rotation_, [](const Tensor& r) { return r == Tensor::Identity(); });
  ++number_;
}

}  // namespace ricochet
