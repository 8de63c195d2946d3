#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/solver/contact/contact_system.hpp"

// Distance of an iterate from a solution of a contact problem, and the part of it that is rounding: see the header.
namespace ricochet {

namespace {

/// Rounding of sums above this part of q is no excuse: an iteration on a problem without a solution could increase its
/// reactions until rounding hides the residual.
constexpr double largest_excuse = 0.01;

/// Effect of an error of u of this size on the natural map: û = u + F |u_T|.
double floor_of_map(const ContactPoint& point, const ContactSystem::Floor& floor) {
  return (std::max(floor.normal, floor.tangential) + point.coefficient * floor.tangential) / std::sqrt(point.diagonal);
}

/// Violation of the law, in units of u, and without the factor F that cone and floor have.
double violation(const ContactPoint& point, const ContactIterate& iterate) {
  return alart_curnier_residual(point, 1.0 / point.diagonal, padded(point, iterate.reaction),
                                padded(point, iterate.motion));
}

}  // namespace

double ContactSystem::residual(const ContactPoint& point, const PaddedVector& reaction, const PaddedVector& motion) {
  const double value = natural_map(point, reaction, motion).norm() * std::sqrt(point.diagonal);
  return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

double ContactSystem::residual(const ContactIterate& iterate) const {
  double largest = 0.0;
  for (const ContactPoint& point : points_)
    largest = std::max(largest, residual(point, padded(point, iterate.reaction), padded(point, iterate.motion)));
  return largest;
}

ContactSystem::Floor ContactSystem::floor_of(const ContactPoint& point, const ContactIterate& iterate) const {
  Floor floor;
  for (Index k = 0; k < point.size; ++k) {
    const Index row = point.row + k;
    const double of_sum = sum_rounding * iterate.size[row];
    double& of_row = k == 0 ? floor.normal : floor.tangential;
    of_row = std::max(of_row, offset_rounding_[row] + of_sum);
    floor.of_sums = std::max(floor.of_sums, of_sum);
    floor.of_offset = std::max(floor.of_offset, offset_rounding_[row]);
  }
  return floor;
}

ContactSystem::Measure ContactSystem::measure(const ContactIterate& iterate) const {
  Measure result;
  const double excused = largest_excuse * std::max(data_, largest_offset_);
  for (const ContactPoint& point : points_) {
    const double value = residual(point, padded(point, iterate.reaction), padded(point, iterate.motion));
    const Floor of_motion = floor_of(point, iterate);
    const double floor = floor_of_map(point, of_motion);
    result.is_exact =
        result.is_exact && value * std::sqrt(point.diagonal) <= (1.0 + point.coefficient) * of_motion.of_sums;
    result.residual = std::max(result.residual, value);
    result.rounding_floor = std::max(result.rounding_floor, floor);
    const bool is_finite = std::isfinite(value) && std::isfinite(floor);
    // The rounding of q excuses everything; that of the sums only so much.
    const double offset_error = (1.0 + point.coefficient) * of_motion.of_offset / std::sqrt(point.diagonal);
    const bool is_hidden = is_finite && value <= floor && value > std::max(loosest_residual * data_, offset_error);
    const bool is_steep = point.coefficient > steep_coefficient;
    const bool is_violated = (is_hidden || is_steep) && violation(point, iterate) > excused;
    if (!is_finite) {
      result.beyond_floor = std::numeric_limits<double>::infinity();
    } else if (value > floor) {
      result.beyond_floor = std::max(result.beyond_floor, value - floor);
    } else if (is_hidden && is_violated) {
      result.beyond_floor = std::max(result.beyond_floor, value);
    }
    if (is_steep && is_violated) result.beyond_floor = std::max(result.beyond_floor, data_);
    // If W has a zero block, r is in no sum.
    const double of_reaction = sum_rounding * point.diagonal * iterate.reaction[point.row];
    if (iterate.reaction[point.row] > 0.0 && std::max(of_motion.of_sums, of_reaction) > excused)
      result.beyond_floor = std::max({result.beyond_floor, value, floor, of_reaction});
  }
  return result;
}

double ContactSystem::residual_of(const ContactProblem& problem, Index i, const Vector& reaction,
                                  const Vector& motion) const {
  const ContactPoint point = make_point(problem, i);
  return residual(point, reaction_scale(i) * padded(point, reaction), motion_scale(i) * padded(point, motion));
}

}  // namespace ricochet
