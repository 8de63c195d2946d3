#pragma once

#include <vector>

#include "ricochet/solver/mean_reaction/path_active_set.hpp"
#include "ricochet/solver/mean_reaction/pressing_set.hpp"

/// @file Normal reactions while the gaps without them go straight from one end of a step to the other:
///   0 ≤ r(τ) ⟂ q₀ + τ (q₁ − q₀) + U r(τ) ≥ 0,   0 < τ ≤ 1.
/// r is piecewise linear in τ: between changes of the set of points that press, A, it is −P (q₀ + τ (q₁ − q₀)),
/// P = U_AA⁻¹ on A and 0 elsewhere.
namespace ricochet {

enum class PathMatrix : char {
  definite,      ///< U symmetric and positive definite: r is unique
  semidefinite,  ///< U symmetric: gaps are unique, and so are the forces; r is that of independent points
  general        ///< not symmetric, as friction that goes with the normal reactions makes it: r need not be unique
};

class NormalPath {
 public:
  struct Piece {
    double begin = 0.0, end = 0.0;
    Vector first, last;  ///< r at its two ends
  };

  /// Of U, to which a reference is kept, from now on.
  void prepare(const Matrix& u, PathMatrix kind) {
    u_ = &u;
    kind_ = kind;
    set_.prepare(u);
  }
  /// From now on paths have derivatives, too.
  void keep_derivatives(bool wanted) { keeps_derivatives_ = wanted; }
  /// Of points that may press. False where the sets of points that press were not found. `pressing`: a guess for the
  /// start.
  [[nodiscard]] bool follow(const Vector& q0, const Vector& q1, const std::vector<char>& eligible,
                            const std::vector<char>& pressing);
  /// r(0+), ∫ r dτ and r(1).
  [[nodiscard]] const Vector& start() const { return pieces_.front().first; }
  [[nodiscard]] const Vector& mean() const { return mean_; }
  [[nodiscard]] const Vector& end() const { return pieces_[count_ - 1].last; }
  /// −∂mean/∂q₁ = ∫ τ P dτ and −∂end/∂q₁ = P(1): symmetric, positive semi-definite where U is. Of the last path.
  [[nodiscard]] const Matrix& mean_derivative() const { return mean_derivative_; }
  [[nodiscard]] const Matrix& end_derivative() const { return end_derivative_; }
  [[nodiscard]] std::size_t pieces() const { return count_; }
  [[nodiscard]] const Piece& piece(std::size_t number) const { return pieces_[number]; }

 private:
  [[nodiscard]] bool evaluate(const Vector& q);
  [[nodiscard]] bool find_set(const Vector& q, std::vector<char>& active);
  [[nodiscard]] bool exchange_all(const Vector& q, std::vector<char>& active);
  [[nodiscard]] double piece_end(const std::vector<char>& active, double begin);
  [[nodiscard]] Piece& next_piece();

  const Matrix* u_ = nullptr;
  PathMatrix kind_ = PathMatrix::definite;
  bool keeps_derivatives_ = false;
  std::vector<char> eligible_, active_, guess_;
  std::vector<std::size_t> wrong_;
  std::vector<Piece> pieces_;  ///< the first count_; the others keep their storage
  std::size_t count_ = 0;
  PathActiveSet one_by_one_;
  double gap_rounding_ = 0.0;
  PressingSet set_;
  Vector mean_, q0_, change_, at_, r_, rate_, y_, y_rate_;
  Matrix mean_derivative_, end_derivative_;
};

}  // namespace ricochet
