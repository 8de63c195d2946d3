#pragma once

#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/contact/contact_rows.hpp"
#include "ricochet/problem/body_rotations.hpp"

/// @file Corotated frame: a factor that rotates with the bodies. The tangent of a body rotated by R is R K Rᵀ if its
/// strains are unchanged (for any objective law), and M₀ = m₀ ⊗ I commutes with R. So with the factor of A₀ at one
/// displacement,
///   A ≈ R A₀ Rᵀ:   A δ = b + Hᵀρ   is   A₀ (Rᵀδ) = Rᵀb + (H R)ᵀρ,
/// R = diag(R of each node's body). Columns of contact rows are unchanged while R is.
namespace ricochet {

class CorotatedFrame {
 public:
  explicit CorotatedFrame(const SemidiscreteProblem& problem) : problem_(problem), bodies_(problem) { restart({}); }

  /// Sets R to that of the bodies at this displacement if they have rotated by more than `slack` since it was fitted.
  /// (An angular error costs iterations, about as many as strains of that size do.)
  void follow(const Vector& displacement);
  /// Sets R = I at this displacement, where the factor has been made (empty: the undeformed body).
  void restart(const Vector& displacement);

  /// Computes a displacement with a part of the strains of another one, and without rotations of the bodies:
  /// part · (Rᵀ(X + u) − X).
  void scale_strains(const Vector& displacement, double part, Vector& result) const;

  /// Revision number, which changes with R.
  [[nodiscard]] long number() const { return number_; }
  /// Compute Rᵀ v and R v, per dof.
  void rotate_back(const Vector& values, Vector& result) const;
  void rotate(Vector& values) const;
  /// Computes H R; `result` keeps its storage if the pattern is unchanged.
  void rotate_back(const SparseRowMatrix& rows, SparseRowMatrix& result) const;

  void persist(const SnapshotVisitor& visit);

 private:
  static constexpr double slack = 0.02;
  template <class Entry>
  void visit_rotated(const SparseRowMatrix& rows, const Entry& visit) const;

  const SemidiscreteProblem& problem_;
  BodyRotations bodies_;
  std::vector<Tensor> start_;     ///< per body, at the displacement of the factor
  std::vector<Tensor> rotation_;  ///< R
  std::vector<Tensor> fitted_;
  bool is_identity_ = true;
  long number_ = 0;
};

}  // namespace ricochet
