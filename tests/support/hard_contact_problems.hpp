#pragma once

#include <random>
#include <vector>

#include "support/contact_problems.hpp"

/// @file Contact problems that are hard by nature, and a judge in long double that shares no code with the solvers.
namespace ricochet::test_support {

// Rigid bodies.

/// A point of a rigid body, relative to the body's centre of mass, and the normal of the obstacle there (into the
/// body).
struct RigidPoint {
  Eigen::Vector3d position, normal;
};

/// Returns the map from (v, ω) of the body to the velocities of the points in their frames (normal, tangents); in two
/// dimensions, in the plane of x and z, from (v_x, v_z, ω_y).
Matrix rigid_trace(const std::vector<RigidPoint>& points, Index dimension);

/// Returns W = G M⁻¹ Gᵀ, q = G (velocity without contact) for a box of mass one with these sides.
FrictionProblem rigid_problem(const std::vector<RigidPoint>& points, const Eigen::Vector3d& sides,
                              const Eigen::Matrix<double, 6, 1>& velocity, Index dimension, double friction);

/// Makes a box that lands on many points of its base, with a tangential and a rocking velocity. The points are on a
/// regular grid (even seeds) or random. W has rank three (two dimensions) or six.
FrictionProblem rigid_box(Index points, Index dimension, double friction, unsigned seed);

/// Makes a body in a groove or (three dimensions, odd seeds) a funnel whose walls are at `angle` (radians) to the
/// direction in which it is pushed: it locks if F > tan(angle). The compliance of its surface is `softness` times the
/// mean diagonal of W, larger between neighbours. It is pushed in, or pulled out after it was pressed in (`preload`, a
/// velocity: the walls recede if it is negative).
FrictionProblem wedged_body(Index points, Index dimension, double friction, double angle, double push, double softness,
                            double preload, unsigned seed);

// Other problems.

/// Duplicates every point, the copies last.
FrictionProblem twice(const FrictionProblem& single);

/// Returns a factor for each point, from 1 down to 10^−decades, in random order; `per_body` neighbours share one.
Vector decades_of(Index points, Index dimension, double decades, Index per_body, std::mt19937& random);

/// Makes bodies of five points whose masses and stiffnesses spread over `decades` (as does W's diagonal), each coupled
/// internally and weakly with all others (W is a scaled positive definite matrix). q is proportional to √W_ii^`power`:
/// 1 gives every point the same share in the measure, 0 every point the same velocity.
FrictionProblem unequal_bodies(Index points, Index dimension, double friction, double decades, double power,
                               unsigned seed);

/// Makes points of a square lattice, each coupled to its four neighbours: 3×3 or 2×2 blocks, sparse, with W's smallest
/// eigenvalue about 1e-3 of the largest. With `coupling` 1 neighbours push each other apart, as on an elastic surface;
/// with −1 W is a discrete Laplacian, whose smooth modes are the soft ones. The mean normal velocity is −`pressing`.
ContactProblem lattice_problem(Index side, Index dimension, double friction, double coupling, double pressing,
                               unsigned seed);

// The judge.

struct Judgement {
  double residual = 0.0;  ///< as ContactSolution states it
  /// Part of the residual beyond 32 ε (|q| + Σ|W r|) of the point itself, relative to the data like `residual`.
  double beyond_rounding = 0.0;
  /// Largest residual of a point relative to its own value at r = 0 or to the terms of its u, whichever is larger.
  double own_residual = 0.0;
  double outside_cone = 0.0;  ///< largest (|r_T| − F r_N)/|r| or −r_N/|r|: rounding at most
};

/// Returns |r − P_K(r − û/w)| √w with sums in long double, without bounds on friction. W dense or sparse.
Judgement judge(const ContactProblem& problem, const Vector& reaction);

}  // namespace ricochet::test_support
