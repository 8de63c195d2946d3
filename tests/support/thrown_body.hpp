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
};

/// Unstructured discs and balls of radius 1 that touch the obstacle soon; their whole boundary, or its lower part, is
/// the contact boundary.
std::vector<ThrownBody> thrown_bodies();

/// A body thrown at an oblique plane in oblique gravity, turning, so that no component is special: 150 steps of 0.01.
/// `time`, `contact` and `obstacle` are further lines of [time], [[contact]] and [obstacle.plane].
std::string thrown_case(const ThrownBody& body, const std::string& mass, const std::string& time,
                        const std::string& contact = "", const std::string& obstacle = "");

}  // namespace ricochet::test_support
