#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>

/// @file Random bodies and cases.

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * (double(engine_()) / 4294967296.0); }
  double power(double low, double high) { return std::pow(10.0, between(low, high)); }
  int integer(int low, int high) { return low + int(between(0.0, 1.0) * (high - low + 1)); }
  bool chance(double part) { return between(0.0, 1.0) < part; }

 private:
  std::mt19937 engine_;  // the same numbers everywhere, unlike the library's distributions
};

/// Returns a box of slightly distorted cells as a mesh in Gmsh's format 2.2. Facets of the lower side are group
/// "bottom", of the upper side "top"; the cells are "body".
std::string box_mesh(Random& random, int d, bool simplices, const std::array<int, 3>& counts,
                     const std::array<double, 3>& lengths);

struct RandomCase {
  std::string text, description;  ///< without [time] and [mass]
  double step, end, friction, cell, crossings;
  int steps;
};

std::string vector_text(int d, const std::array<double, 3>& of);

enum class ObstacleKind { plane, sphere, turning };
/// Makes a box against a plane or a sphere, or against one of them that rotates.
RandomCase make_obstacle_case(unsigned seed, ObstacleKind kind, const std::filesystem::path& folder);
/// Makes a box against another one: meshes, sizes, stiffnesses and positions do not match. `sliding`: the upper one
/// slides along the lower one and over its ends, at small or at finite strain, and pairs follow.
RandomCase make_pair_case(unsigned seed, bool sliding, const std::filesystem::path& folder);
