#include "ricochet/solver/mean_reaction/normal_path.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

/// Distance behind the beginning of a piece at which its set is determined: changes in between are of its square.
constexpr double behind_change = 1e-9;
/// Part of the largest reaction, or of the largest gap without reactions, below which values are rounding.
constexpr double path_rounding = 1e-13;
/// Part of the motion due to reactions that may remain of a gap closed by U_AA⁻¹.
constexpr double closed_gap = 1e-12;
/// Exchanges of all wrong points without progress, before points are added one by one.
constexpr int patience_of_exchange = 10;

/// Computes r and y at q with the points of the set. Returns false if the inverse is useless.
bool NormalPath::evaluate(const Vector& q) {
  for (const bool is_new : {false, true}) {
    if (is_new && !set_.renew()) return false;
    set_.solve(q, r_);
    const double closed = 10.0 * gap_rounding_ + closed_gap * u_->diagonal().maxCoeff() * r_.lpNorm<Eigen::Infinity>();
    y_ = q;
    set_.add_motion(r_, y_);
    const auto& points = set_.points();
    if (std::ranges::all_of(points, [&](Index i) { return std::abs(y_[i]) <= closed; })) return true;
  }
  return false;
}

/// Exchanges all wrong points (J. J. Júdice, F. M. Pires, Comput. Oper. Res. 21 (1994) 587–596). Returns false if their
/// number does not fall.
bool NormalPath::exchange_all(const Vector& q, std::vector<char>& active) {
  const auto count = std::size_t(q.size());
  std::size_t fewest = count + 1;
  for (int remaining = patience_of_exchange; remaining >= 0;) {
    if (!set_.set_points(active) || !evaluate(q)) return false;
    const double force = path_rounding * r_.lpNorm<Eigen::Infinity>();
    wrong_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = Index(i);
      if (eligible_[i] == 0) continue;
      if (active[i] != 0 ? r_[at] < -force : y_[at] < -gap_rounding_) wrong_.push_back(i);
    }
    if (wrong_.empty()) return true;
    if (wrong_.size() < fewest) {
      fewest = wrong_.size();
      remaining = patience_of_exchange;
    } else {
      --remaining;
    }
    for (const std::size_t i : wrong_) active[i] = active[i] == 0 ? 1 : 0;
  }
  return false;
}

/// Determines the pressing points at q.
bool NormalPath::find_set(const Vector& q, std::vector<char>& active) {
  if (kind_ != PathMatrix::semidefinite) {
    guess_ = active;
    if (exchange_all(q, active)) return true;
    if (kind_ == PathMatrix::general) return false;
    active = guess_;
  }
  return one_by_one_.find(*u_, q, eligible_, gap_rounding_, active) && set_.set_points(active) && evaluate(q);
}

/// Returns the position on the path at which the next point begins or ceases to press.
double NormalPath::piece_end(const std::vector<char>& active, double begin) {
  set_.solve(change_, rate_);
  y_rate_ = change_;
  set_.add_motion(rate_, y_rate_);
  // If signs are those of rounding, sets are the same on both sides.
  const double force = 2.0 * path_rounding * r_.lpNorm<Eigen::Infinity>(), gap = 2.0 * gap_rounding_;
  double end = 1.0;
  for (std::size_t i = 0; i < active.size(); ++i) {
    const auto at = Index(i);
    if (eligible_[i] == 0) continue;
    const double value = active[i] != 0 ? r_[at] + force : y_[at] + gap;
    const double rate = active[i] != 0 ? rate_[at] : y_rate_[at];
    if (rate < 0.0) end = std::min(end, begin + std::max(0.0, -value / rate));
  }
  return end;
}

NormalPath::Piece& NormalPath::next_piece() {
  if (count_ == pieces_.size()) pieces_.emplace_back();
  return pieces_[count_++];
}

bool NormalPath::follow(const Vector& q0, const Vector& q1, const std::vector<char>& eligible,
                        const std::vector<char>& pressing) {
  eligible_ = eligible;
  q0_ = q0;
  change_ = q1 - q0;
  gap_rounding_ = path_rounding * (q0.lpNorm<Eigen::Infinity>() + q1.lpNorm<Eigen::Infinity>());
  count_ = 0;
  mean_.setZero(q0.size());
  if (keeps_derivatives_) mean_derivative_.setZero(u_->rows(), u_->cols());
  active_ = pressing;
  for (std::size_t i = 0; i < active_.size(); ++i) active_[i] = active_[i] != 0 && eligible_[i] != 0 ? 1 : 0;
  const std::size_t max_pieces = 4 * active_.size() + 20;
  for (double begin = 0.0; begin < 1.0;) {
    if (count_ > max_pieces) return false;
    const double inside = std::min(begin + behind_change, 0.5 * (1.0 + begin));
    at_ = q0_ + inside * change_;
    if (!find_set(at_, active_)) return false;
    Piece& piece = next_piece();
    piece.begin = begin;
    piece.end = piece_end(active_, inside);
    if (piece.end > 1.0 - 1e-14) piece.end = 1.0;
    piece.first = r_ + (piece.begin - inside) * rate_;
    piece.last = r_ + (piece.end - inside) * rate_;
    if (keeps_derivatives_)
      set_.add_inverse(0.5 * (piece.end * piece.end - piece.begin * piece.begin), mean_derivative_);
    mean_ += (0.5 * (piece.end - piece.begin)) * (piece.first + piece.last);
    begin = piece.end;
  }
  if (keeps_derivatives_) {
    end_derivative_.setZero(u_->rows(), u_->cols());
    set_.add_inverse(1.0, end_derivative_);
  }
  return true;
}

}  // namespace ricochet
