#pragma once

#include <utility>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/step/contact_tangent.hpp"
#include "ricochet/step/exact_tangent.hpp"

/// @file Assembly of an ExactTangent from matrices per dof.
namespace ricochet {

/// Equations and unknowns are numbered by dof; a dof may have several of each kind, or none.
class TangentAssembly {
 public:
  /// Number of an equation per dof; −1 if it has none.
  using Equations = std::vector<int>;
  /// Motion of a dof: this factor times this unknown or, if the unknown is −1, times the known value of the dof.
  struct Motion {
    int unknown;
    double factor;
  };
  using Motions = std::vector<Motion>;

  /// Begins equations J z = r with r = 0 and known values 0.
  void start(Index unknowns, Index dofs);
  [[nodiscard]] double& right_hand_side(int equation) { return right_[equation]; }
  void set_known(Index dof, double value) { known_[std::size_t(dof)] = value; }
  [[nodiscard]] double value(const Vector& unknowns, const Motions& motions, Index dof) const {
    const Motion& motion = motions[std::size_t(dof)];
    return motion.factor * (motion.unknown >= 0 ? unknowns[motion.unknown] : known_[std::size_t(dof)]);
  }
  /// Adds factor · matrix · motions of its columns to the equations of its rows; known motions go to r.
  void add(const SparseMatrix& matrix, double factor, const Equations& rows, const Motions& columns);
  /// Adds the change of the forces of contact in all of these equations to J, and writes B, Y, Y_T, q and p. Slips are
  /// `slip_time` / σ times the slip rates of the conditions, σ their factor.
  void add_contact(const ContactTangent& contact, const ContactConditions& conditions, double slip_time,
                   const std::vector<const Equations*>& equations, const Motions& motions, ExactTangent& tangent);
  /// Writes J and r.
  void write(ExactTangent& tangent) const;

 private:
  using Triplets = std::vector<Eigen::Triplet<double>>;
  [[nodiscard]] SparseRowMatrix forces_of(const SparseRowMatrix& rows,
                                          const std::vector<const Equations*>& equations) const;
  [[nodiscard]] SparseRowMatrix motions_of(const SparseRowMatrix& rows, const Motions& motions, Vector& offset) const;
  [[nodiscard]] SparseRowMatrix assemble(Index rows, const Triplets& entries) const;

  Index count_ = 0;            ///< of unknowns
  std::vector<double> known_;  ///< per dof
  Triplets entries_;
  Vector right_;
};

}  // namespace ricochet
