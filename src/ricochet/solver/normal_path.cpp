#include "ricochet/solver/normal_path.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

/// The set of a piece is looked for so far behind its beginning: what changes in between is of the square of it.
constexpr double behind_change = 1e-9;
/// A reaction or a gap below this part of the largest is rounding.
constexpr double path_rounding = 1e-13;
/// Exchanges of all points that are wrong, without progress, before they are exchanged one by one.
constexpr int patience_of_exchange = 10;

}  // namespace

std::vector<Index> marked(const std::vector<char>& marks) {
  std::vector<Index> result;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i] != 0) result.push_back(static_cast<Index>(i));
  }
  return result;
}

NormalPath::NormalPath(const Matrix& u, const std::vector<char>& eligible) : u_(u), eligible_(eligible) {}

/// U_AA r_A = −right_A, zero elsewhere.
void NormalPath::solve_on(const std::vector<Index>& pressing, const Vector& right, Vector& r) {
  r.setZero(right.size());
  if (pressing.empty()) return;
  const Matrix block = u_(pressing, pressing);
  const Vector solution = block.llt().solve(-Vector(right(pressing)));
  for (std::size_t i = 0; i < pressing.size(); ++i) r[pressing[i]] = solution[static_cast<Index>(i)];
}

/// The points that press at q: block principal pivoting (J. J. Júdice, F. M. Pires, Comput. Oper. Res. 21 (1994)
/// 587–596), and Murty's exchange of the last wrong point, which always ends, where that makes no progress.
bool NormalPath::find_set(const Vector& q, std::vector<char>& active) {
  const auto count = static_cast<std::size_t>(q.size());
  std::size_t least = count + 1;
  int left = patience_of_exchange;
  for (std::size_t round = 0; round < 20 * count + 100; ++round) {
    const std::vector<Index> pressing = marked(active);
    solve_on(pressing, q, r_);
    y_ = q;
    for (const Index i : pressing) y_ += r_[i] * u_.col(i);
    if (!r_.allFinite()) return false;
    const double force = path_rounding * r_.lpNorm<Eigen::Infinity>();
    const double gap = path_rounding * (q.lpNorm<Eigen::Infinity>() + y_.lpNorm<Eigen::Infinity>());
    std::vector<std::size_t> wrong;
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = static_cast<Index>(i);
      if (eligible_[i] == 0) continue;
      if (active[i] != 0 ? r_[at] < -force : y_[at] < -gap) wrong.push_back(i);
    }
    if (wrong.empty()) return true;
    if (wrong.size() < least) {
      least = wrong.size();
      left = patience_of_exchange;
    } else if (left > 0) {
      --left;
    } else {
      wrong.erase(wrong.begin(), wrong.end() - 1);
    }
    for (const std::size_t i : wrong) active[i] = active[i] == 0 ? 1 : 0;
  }
  return false;
}

/// Where the next point begins or ceases to press.
double NormalPath::piece_end(const std::vector<char>& active, double begin) {
  const std::vector<Index> pressing = marked(active);
  solve_on(pressing, change_, rate_);
  y_rate_ = change_;
  for (const Index i : pressing) y_rate_ += rate_[i] * u_.col(i);
  double end = 1.0;
  for (std::size_t i = 0; i < active.size(); ++i) {
    const auto at = static_cast<Index>(i);
    if (eligible_[i] == 0) continue;
    const double value = active[i] != 0 ? r_[at] : y_[at], rate = active[i] != 0 ? rate_[at] : y_rate_[at];
    if (rate < 0.0) end = std::min(end, begin + std::max(0.0, -value / rate));
  }
  return end;
}

bool NormalPath::follow(const Vector& q0, const Vector& q1, const std::vector<char>& pressing) {
  q0_ = q0;
  change_ = q1 - q0;
  pieces_.clear();
  mean_.setZero(q0.size());
  std::vector<char> active = pressing;
  for (std::size_t i = 0; i < active.size(); ++i) active[i] = active[i] != 0 && eligible_[i] != 0 ? 1 : 0;
  const std::size_t most = 4 * active.size() + 20;
  for (double begin = 0.0; begin < 1.0;) {
    if (pieces_.size() > most) return false;
    const double inside = std::min(begin + behind_change, 0.5 * (1.0 + begin));
    at_ = q0_ + inside * change_;
    if (!find_set(at_, active)) return false;
    double end = piece_end(active, inside);
    if (end > 1.0 - 1e-14) end = 1.0;
    const std::vector<Index> set = marked(active);
    if (pieces_.empty()) solve_on(set, q0_, start_);
    at_ = q0_ + (0.5 * (begin + end)) * change_;
    solve_on(set, at_, r_);
    mean_ += (end - begin) * r_;
    pieces_.push_back({set, begin, end});
    begin = end;
  }
  solve_on(pieces_.back().pressing, q1, end_);
  return true;
}

void NormalPath::add_inverse(const std::vector<Index>& pressing, double factor, Matrix& sum) const {
  if (pressing.empty()) return;
  const auto count = static_cast<Index>(pressing.size());
  const Matrix block = u_(pressing, pressing);
  const Matrix inverse = block.llt().solve(Matrix::Identity(count, count));
  sum(pressing, pressing) += factor * inverse;
}

Matrix NormalPath::mean_derivative() const {
  Matrix sum = Matrix::Zero(u_.rows(), u_.cols());
  for (const Piece& piece : pieces_)
    add_inverse(piece.pressing, 0.5 * (piece.end * piece.end - piece.begin * piece.begin), sum);
  return sum;
}

Matrix NormalPath::end_derivative() const {
  Matrix sum = Matrix::Zero(u_.rows(), u_.cols());
  add_inverse(pieces_.back().pressing, 1.0, sum);
  return sum;
}

}  // namespace ricochet
