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

/// Unstructured discs and balls of radius 1 that touch the obstacle soon; their whole boundary, or its lower part, is
/// the contact boundary. The last two are pairs of bodies that meet each other: blocks with curved sides whose meshes
/// do not match, both free.
std::vector<ThrownBody> thrown_bodies();

/// One of these pairs, in two or three dimensions.
ThrownBody thrown_pair(int dimension);

/// A block with contact on one side, of which every mass can be made.
ThrownBody one_sided_block();

/// A body thrown at an oblique plane in oblique gravity, turning, so that no component is special: 150 steps of 0.01.
/// `time`, `contact` and `obstacle` are further lines of [time], [[contact]] and [obstacle.plane].
std::string thrown_case(const ThrownBody& body, const std::string& mass, const std::string& time,
                        const std::string& contact = "", const std::string& obstacle = "");

/// The same with friction's company: a plane that moves, a load that varies in time and space, mass damping.
std::string dragged_case(const ThrownBody& body, const std::string& mass, const std::string& time,
                         const std::string& contact);

/// Lines of [time] for a registered scheme.
std::string time_of(const std::string& scheme);
/// The masses that a scheme takes; it refuses all others. Every mass where this list does not know better: a new scheme
/// is tested with all of them.
std::vector<std::string> masses_of(const std::string& scheme);

/// Those that do not refuse it.
bool takes_friction(const std::string& scheme);
bool takes_damping(const std::string& scheme);
/// Also at contact nodes.
bool takes_stiffness_damping(const std::string& scheme);

/// Every scheme, mass and multiplier space that is registered, whether they go together or not.
struct Discretization {
  std::string scheme, mass, multipliers;

  /// Lines of [time] and [[contact]], with friction.
  [[nodiscard]] std::string time() const;
  [[nodiscard]] std::string contact() const;
  /// The scheme takes the mass.
  [[nodiscard]] bool is_possible() const;
  [[nodiscard]] std::string label() const { return scheme + ' ' + mass + ' ' + multipliers; }
};
std::vector<Discretization> all_discretizations();

/// A block pushed into the floor by supports that move, also on contact nodes: 200 steps, under every scheme.
struct SupportedCase {
  std::string scheme, text;
};
std::vector<SupportedCase> moving_support_cases();

}  // namespace ricochet::test_support
