#pragma once

#include <string>
#include <vector>

/// @file Bodies thrown at an oblique plane, on which identities and laws of every step are tested.
namespace ricochet::test_support {

struct ThrownBody {
  std::string name;
  int dimension;
  int degree;
  std::string mesh;
  std::string against = {};  ///< a group of another body, in place of the plane
};

/// Returns unstructured discs and balls of radius 1 that touch the obstacle soon; their whole boundary, or its lower
/// part, is the contact boundary. The last two are pairs of free bodies that meet each other: blocks with curved sides
/// and non-matching meshes.
std::vector<ThrownBody> thrown_bodies();

/// Returns one of these pairs, in two or three dimensions.
ThrownBody thrown_pair(int dimension);

/// Returns a block with contact on one side, for which every mass can be built.
ThrownBody one_sided_block();

/// Returns a body thrown at an oblique plane in oblique gravity, rotating, so that no component is special: 150 steps
/// of 0.01. `time`, `contact` and `obstacle` are additional lines of [time], [[contact]] and [obstacle.plane].
std::string thrown_case(const ThrownBody& body, const std::string& mass, const std::string& time,
                        const std::string& contact = "", const std::string& obstacle = "");

/// Returns the same case with features that interact with friction: a moving plane, a load that varies in time and
/// space, mass damping.
std::string dragged_case(const ThrownBody& body, const std::string& mass, const std::string& time,
                         const std::string& contact);

/// Returns the lines of [time] for a registered scheme.
std::string time_of(const std::string& scheme);
/// Returns the masses that a scheme accepts; it refuses all others. The default is every mass, so that a new scheme is
/// tested with all of them.
std::vector<std::string> masses_of(const std::string& scheme);

/// Returns false for schemes that refuse friction.
bool takes_friction(const std::string& scheme);
bool takes_damping(const std::string& scheme);
/// Returns true if stiffness damping is accepted at contact nodes as well.
bool takes_stiffness_damping(const std::string& scheme);

/// Every registered scheme, mass and multiplier space, whether compatible or not.
struct Discretization {
  std::string scheme, mass, multipliers;

  /// Returns the lines of [time] and [[contact]], with friction.
  [[nodiscard]] std::string time() const;
  [[nodiscard]] std::string contact() const;
  /// Returns true if the scheme accepts the mass.
  [[nodiscard]] bool is_possible() const;
  [[nodiscard]] std::string label() const { return scheme + ' ' + mass + ' ' + multipliers; }
};
std::vector<Discretization> all_discretizations();

/// A block pushed into the floor by moving supports, also on contact nodes: 200 steps, under every scheme.
struct SupportedCase {
  std::string scheme, text;
};
std::vector<SupportedCase> moving_support_cases();

}  // namespace ricochet::test_support
