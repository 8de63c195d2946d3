#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "support/box_mesh.hpp"

/// @file Bodies of every element, bent if it may be, and motions of them.
namespace ricochet::test_support {

struct BodyKind {
  ElementKind element;
  PlaneState plane = PlaneState::strain;

  [[nodiscard]] std::string label() const {
    return element.label() + (plane == PlaneState::axisymmetric ? "_axisymmetric" : "");
  }
};

/// Returns every element, those of the plane also as sections of rings.
inline std::vector<BodyKind> all_body_kinds() {
  std::vector<BodyKind> all;
  for (const ElementKind& element : all_element_kinds()) {
    all.push_back({element});
    if (element.dimension() == 2) all.push_back({element, PlaneState::axisymmetric});
  }
  return all;
}

/// Makes two boxes along each axis; rings have an inner radius of 2.
inline std::unique_ptr<MeshedBody> make_bent_body(const ElementKind& element, PlaneState plane) {
  BoxMesh box = box_of(element.shape, std::vector<int>(std::size_t(element.dimension()), 2));
  box.geometry_degree = element.geometry_degree;
  if (box.geometry_degree == 2) box.map = bend_map();
  if (plane == PlaneState::axisymmetric) {
    const PointMap map = box.map;
    box.map = [map](const Vector& x) { return Vector((map ? map(x) : x) + 2.0 * Vector::Unit(2, 0)); };
  }
  return make_meshed_body(make_box_mesh(box), element.displacement_degree, plane);
}

inline Vector random_displacement(const MeshedBody& body, double size, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> random(-size, size);
  Vector result(body.space.dof_count());
  for (double& each : result) each = random(generator);
  return result;
}

/// Returns the displacement of X ↦ Q (X + u).
inline Vector turned(const MeshedBody& body, const Vector& displacement, const Matrix& rotation) {
  const Points& nodes = body.space.nodes;
  return Vector((rotation * (nodes + displacement.reshaped(nodes.rows(), nodes.cols())) - nodes).reshaped());
}

inline Matrix some_rotation(int dimension) {
  if (dimension == 2) return Eigen::Rotation2Dd(2.3).toRotationMatrix();
  return Eigen::AngleAxisd(2.3, Eigen::Vector3d(0.3, -0.2, 0.8).normalized()).toRotationMatrix();
}

}  // namespace ricochet::test_support
