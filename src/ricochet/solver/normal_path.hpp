#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Normal reactions while the gaps without them go straight from one end of a step to the other:
///   0 ≤ r(τ) ⟂ q₀ + τ (q₁ − q₀) + U r(τ) ≥ 0,   0 < τ ≤ 1,
/// with U symmetric and positive definite. r is piecewise linear in τ: between changes of the set of points that press,
/// A, it is −P (q₀ + τ (q₁ − q₀)), P = U_AA⁻¹ on A and 0 elsewhere.
namespace ricochet {

class NormalPath {
 public:
  /// Of points that may press. Keeps a reference to U.
  NormalPath(const Matrix& u, const std::vector<char>& eligible);

  /// False where the sets of points that press were not found. `pressing`: a guess for the start.
  [[nodiscard]] bool follow(const Vector& q0, const Vector& q1, const std::vector<char>& pressing);
  /// r(0+), ∫ r dτ and r(1).
  [[nodiscard]] const Vector& start() const { return start_; }
  [[nodiscard]] const Vector& mean() const { return mean_; }
  [[nodiscard]] const Vector& end() const { return end_; }
  /// −∂mean/∂q₁ = ∫ τ P dτ and −∂end/∂q₁ = P(1): symmetric, positive semi-definite. Of the last path.
  [[nodiscard]] Matrix mean_derivative() const;
  [[nodiscard]] Matrix end_derivative() const;
  [[nodiscard]] std::size_t pieces() const { return pieces_.size(); }

 private:
  struct Piece {
    std::vector<Index> pressing;
    double begin, end;
  };
  void solve_on(const std::vector<Index>& pressing, const Vector& right, Vector& r);
  [[nodiscard]] bool find_set(const Vector& q, std::vector<char>& active);
  [[nodiscard]] double piece_end(const std::vector<char>& active, double begin);
  void add_inverse(const std::vector<Index>& pressing, double factor, Matrix& sum) const;

  const Matrix& u_;
  std::vector<char> eligible_;
  std::vector<Piece> pieces_;
  Vector start_, mean_, end_;
  Vector q0_, change_, at_, r_, rate_, y_, y_rate_;
};

/// The places of the marked ones, ascending.
[[nodiscard]] std::vector<Index> marked(const std::vector<char>& marks);

}  // namespace ricochet
