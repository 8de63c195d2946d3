#pragma once

#include <vector>

#include "ricochet/base/expression.hpp"
#include "ricochet/fem/assembly.hpp"
#include "ricochet/fem/cell_integration.hpp"

/// @file Pressure that remains normal to the deformed surface of a body.
namespace ricochet {

/// A pressure p acts on the deformed surface: its force per undeformed area is −p cof(F) N, with the outward
/// normal N of the undeformed surface and cof F = J F⁻ᵀ, and its virtual work is −∫ p n·v da. With the deformed
/// facet y(ξ) over its reference facet
///   3D:            n da = ± y,₁ × y,₂ dξ₁dξ₂,
///   2D:            n da = ± (y₂′, −y₁′) dξ, per undeformed thickness, in plane stress, too,
///   axisymmetric:  the 2D expression times 2π y₁, the current length of the ring.
/// The integrands are polynomials and are integrated exactly. A uniform pressure around a whole body, or in
/// a closed cavity of it, therefore has no resultant and no moment at any displacement (no moment provided
/// that the degree of the displacement is at least that of the geometry). At zero displacement it equals the
/// dead load of the same pressure.
class FollowerPressure {
 public:
  /// Keeps a reference to the body and to its ties.
  explicit FollowerPressure(const Body& body);

  /// Adds a pressure on `facets` of the body's surface, numbered through all blocks. `pressure` is a stress, positive
  /// in compression, as a function of the undeformed position and of time.
  void add(const std::vector<Index>& facets, Expression pressure);
  [[nodiscard]] bool empty() const { return surfaces_.empty(); }

  /// Adds the forces at a displacement and a time, scaled by `part`, to a load per dof.
  void add_force(const Vector& displacement, double time, Vector& load, double part = 1.0) const;
  /// Adds the forces at a displacement with the mean of the pressures at two instants.
  void add_mean_force(const Vector& displacement, double start, double end, Vector& load) const;

  /// Instant of the pressure in stiffness(), and its scale factor.
  struct Instant {
    double time = 0.0, part = 1.0;
  };
  /// Instant of the last forces (of a mean, its end): iterations that request a new factorization linearize there.
  [[nodiscard]] const Instant& last() const { return last_; }
  void set_last(const Instant& instant) const { last_ = instant; }
  /// Symmetric part of −∂force/∂U at a displacement and the last instant, as the factorization of a symmetric matrix
  /// requires. Under a uniform pressure the antisymmetric part comes from the edges of the surface alone and vanishes
  /// if these are supported or if there are none. Entries couple nodes of the same facet.
  [[nodiscard]] SparseMatrix stiffness(const Vector& displacement) const;
  /// Returns −∂force/∂U of the force that add_mean_force() adds, with its antisymmetric part. For solvers with the
  /// exact tangent: of a step, a times this belongs to InternalForce::path_tangent(), as U is the middle.
  [[nodiscard]] SparseMatrix mean_stiffness(const Vector& displacement, double start, double end) const;

 private:
  struct Facet {
    std::size_t block;
    Index local;
    double side;  ///< 1, or −1 if the order of its nodes makes the normal point inward
  };
  struct Surface {
    std::vector<Facet> facets;
    Expression pressure;
  };
  struct Point;
  template <int d, class Visit>
  void visit_points(const Vector& displacement, const Visit& visit) const;
  template <int d, class Pressure>
  void add_forces(const Vector& displacement, const Pressure& pressure, Vector& load) const;
  template <int d, class Weight>
  [[nodiscard]] SparseMatrix stiffness_of(const Vector& displacement, const Weight& weighted, bool symmetric) const;
  template <class Weight>
  [[nodiscard]] SparseMatrix complete_stiffness(const Vector& displacement, const Weight& weighted,
                                                bool symmetric) const;
  template <class Pressure>
  void add_condensed(const Vector& displacement, const Pressure& pressure, Vector& load) const;
  [[nodiscard]] double outward_side(const Facet& facet, Index cell) const;
  [[nodiscard]] const Vector& complete(const Vector& displacement) const;

  const Body& body_;
  std::vector<BlockIntegration> rules_;  ///< per block of facets
  std::vector<Surface> surfaces_;
  mutable Instant last_;
  mutable Vector complete_, force_;
};

}  // namespace ricochet
