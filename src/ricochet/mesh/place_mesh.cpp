#include "ricochet/mesh/place_mesh.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "ricochet/mesh/offenders.hpp"

namespace ricochet {

namespace {

struct CosineAndSine {
  double cosine, sine;
};

/// Cosine and sine of an angle in degrees, reduced to [−45°, 45°] first, so that quarter turns are exact.
CosineAndSine of_degrees(double degrees) {
  const double rest = std::remainder(degrees, 90.0);
  const double c = std::cos(rest * std::numbers::pi / 180.0), s = std::sin(rest * std::numbers::pi / 180.0);
  const int quarter = int(std::fmod(std::round((degrees - rest) / 90.0), 4.0));
  switch ((quarter + 4) % 4) {
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    case 3:
      return {s, -c};
    default:
      return {c, s};
  }
}

Eigen::Map<const Vector> vector_of(const std::vector<double>& values) { return {values.data(), Index(values.size())}; }

Matrix rotation_matrix(const MeshRotation& rotation, int dimension) {
  const auto [cosine, sine] = of_degrees(rotation.angle);
  Matrix result = cosine * Matrix::Identity(dimension, dimension);
  if (dimension == 2) {
    result(0, 1) = -sine;
    result(1, 0) = sine;
    return result;
  }
  const Eigen::Vector3d axis = vector_of(rotation.axis).stableNormalized();
  Eigen::Matrix3d across;
  across << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  result += sine * across + (1.0 - cosine) * axis * axis.transpose();
  return result;
}

}  // namespace

void place_mesh(Mesh& mesh, const Placement& placement) {
  for (const MeshRotation& rotation : placement.rotations) {
    if (rotation.angle == 0.0) continue;
    const Vector centre = rotation.about.empty() ? Vector(Vector::Zero(mesh.dimension)) : vector_of(rotation.about);
    const Matrix matrix = rotation_matrix(rotation, mesh.dimension);
    for (Index node = 0; node < mesh.node_count(); ++node) {
      const Vector arm = mesh.nodes.col(node) - centre;
      mesh.nodes.col(node) = centre + matrix * arm;
    }
  }
  if (!placement.move.empty()) mesh.nodes.colwise() += vector_of(placement.move);
  if (!mesh.nodes.allFinite()) fail_mesh(mesh.source, "coordinates overflow when the mesh is rotated and moved");
}

}  // namespace ricochet
