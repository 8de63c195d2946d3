#pragma once

#include <vector>

#include "ricochet/base/expression.hpp"
#include "ricochet/fem/assembly.hpp"
#include "ricochet/fem/cell_integration.hpp"

/// @file Pressure that stays normal to the surface of a body while that moves.
namespace ricochet {

/// A pressure p presses against the deformed surface: its force per undeformed area is −p cof(F) N, with the outward
/// normal N of the undeformed surface and cof F = J F⁻ᵀ, and its virtual work −∫ p n·v da. With the deformed facet y(ξ)
/// over its reference facet
///   in space:      n da = ± y,₁ × y,₂ dξ₁dξ₂,
///   in the plane:  n da = ± (y₂′, −y₁′) dξ, per undeformed thickness, in plane stress, too,
///   axisymmetric:  that times 2π y₁, the ring's length now.
/// These are polynomials, and integrated exactly. So a uniform pressure all round a body, or round a cavity in it, has
/// neither resultant nor moment, at any displacement (no moment where the displacement's degree is at least that of the
/// geometry). At zero displacement this is the dead load of the same pressure.
class FollowerPressure {
 public:
  /// Keeps a reference to the body, and to its ties.
  explicit FollowerPressure(const Body& body);

  /// `facets`: numbered through all blocks, on the surface of the body. `pressure`: a stress, positive where it
  /// presses; a function of the undeformed position and of time.
  void add(const std::vector<Index>& facets, Expression pressure);
  [[nodiscard]] bool empty() const { return surfaces_.empty(); }

  /// Adds to a load, per dof, the forces at a displacement and a time, or a part of them.
  void add_force(const Vector& displacement, double time, Vector& load, double part = 1.0) const;
  /// The same with the mean of the pressures at two instants.
  void add_mean_force(const Vector& displacement, double start, double end, Vector& load) const;

  /// What `stiffness` is of.
  struct Instant {
    double time = 0.0, part = 1.0;
  };
  /// That of the last forces (of a mean, its end): iterations that want a new factor are there.
  [[nodiscard]] const Instant& last() const { return last_; }
  void set_last(const Instant& instant) const { last_ = instant; }
  /// The symmetric part of −∂force/∂U at a displacement and the last instant: what a factor can take of it. Under a
  /// uniform pressure what it lacks is of the edges of the surface alone, and nothing where these are supported or
  /// where there are none. Entries are of pairs of nodes of one facet.
  [[nodiscard]] SparseMatrix stiffness(const Vector& displacement) const;

 private:
  struct Facet {
    std::size_t block;
    Index local;
    double side;  ///< 1, or −1 where the order of its nodes has the normal inward
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
  template <int d>
  [[nodiscard]] SparseMatrix stiffness_of(const Vector& displacement) const;
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
