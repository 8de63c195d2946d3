#pragma once

#include <vector>

#include "ricochet/solver/mean_reaction/path_active_set.hpp"
#include "ricochet/solver/mean_reaction/pressing_set.hpp"

/// @file Normal reactions while the gaps without them change linearly from one end of a step to the other:
///   0 ≤ r(τ) ⟂ q₀ + τ (q₁ − q₀) + U r(τ) ≥ 0,   0 < τ ≤ 1.
/// r is piecewise linear in τ: between changes of the set A of pressing points, it is −P (q₀ + τ (q₁ − q₀)), P = U_AA⁻¹
/// on A and 0 elsewhere.
namespace ricochet {

enum class PathMatrix : char {
  definite,      ///< U symmetric and positive definite: r is unique
  semidefinite,  ///< U symmetric: gaps and nodal forces are unique; r is that of independent points
  general        ///< not symmetric, due to friction proportional to the normal reactions: r need not be unique
};

class NormalPath {
 public:
  struct Piece {
    double begin = 0.0, end = 0.0;
    Vector first, last;  ///< r at both ends
  };

  /// Sets U, to which a reference is kept.
  void prepare(const Matrix& u, PathMatrix kind) {
    u_ = &u;
    kind_ = kind;
    set_.prepare(u);
  }
  /// Enables the computation of derivatives for the following paths.
  void keep_derivatives(bool enabled) { keeps_derivatives_ = enabled; }
  /// Follows the path of the eligible points. Returns false if the sets of pressing points were not found. `pressing`
  /// is a guess for the start.
  [[nodiscard]] bool follow(const Vector& q0, const Vector& q1, const std::vector<char>& eligible,
                            const std::vector<char>& pressing);
  /// r(0+), ∫ r dτ and r(1).
  [[nodiscard]] const Vector& start() const { return pieces_.front().first; }
  [[nodiscard]] const Vector& mean() const { return mean_; }
  [[nodiscard]] const Vector& end() const { return pieces_[count_ - 1].last; }
  /// −∂mean/∂q₁ = ∫ τ P dτ and −∂end/∂q₁ = P(1) of the last path: symmetric, positive semi-definite if U is.
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
  std::vector<Piece> pieces_;  ///< the first count_ are used; the others keep their storage
  std::size_t count_ = 0;
  PathActiveSet one_by_one_;
  double gap_rounding_ = 0.0;
  PressingSet set_;
  Vector mean_, q0_, change_, at_, r_, rate_, y_, y_rate_;
  Matrix mean_derivative_, end_derivative_;
};

}  // namespace ricochet
