#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/contact/contact_rows.hpp"
#include "ricochet/problem/body_rotations.hpp"

/// @file A factor that turns with the bodies. The tangent of a body that has turned by R is R K Rᵀ where its strains
/// are those of before (for any law that sees no rotation), and M₀ = m₀ ⊗ I commutes with R. So with the factor of A₀
/// at one displacement,
///   A ≈ R A₀ Rᵀ:   A δ = b + Hᵀρ   is   A₀ (Rᵀδ) = Rᵀb + (H R)ᵀρ,
/// R = diag(R of each node's body). Columns of contact rows stay what they are while R stays.
namespace ricochet {

class TurnedFrame {
 public:
  explicit TurnedFrame(const SemidiscreteProblem& problem) : problem_(problem), bodies_(problem) { restart({}); }

  /// R becomes that of the bodies at this displacement where they have turned by more than `slack` since it was fitted.
  /// (A frame that is off by an angle costs iterations, about as many as strains of that size do.)
  void follow(const Vector& displacement);
  /// The factor has been made at this displacement (empty: the undeformed body): R = I there.
  void restart(const Vector& displacement);

  /// A number that changes with R.
  [[nodiscard]] long number() const { return number_; }
  /// Rᵀ v and R v, per dof.
  void turn_back(const Vector& values, Vector& result) const;
  void turn(Vector& values) const;
  /// H R; `result` keeps its storage where the pattern is the same.
  void turn_back(const SparseRowMatrix& rows, SparseRowMatrix& result) const;

  void save(Snapshot& snapshot, const std::string& name) const;
  void load(const Snapshot& snapshot, const std::string& name);

 private:
  static constexpr double slack = 0.02;
  template <class Entry>
  void visit_turned(const SparseRowMatrix& rows, const Entry& visit) const;

  const SemidiscreteProblem& problem_;
  BodyRotations bodies_;
  std::vector<Tensor> start_;     ///< per body, at the factor's displacement
  std::vector<Tensor> rotation_;  ///< R
  std::vector<Tensor> fitted_;
  bool is_identity_ = true;
  long number_ = 0;
};

}  // namespace ricochet
