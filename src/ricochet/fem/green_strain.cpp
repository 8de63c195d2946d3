#include "ricochet/fem/green_strain.hpp"

#include <algorithm>
#include <cmath>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/fem/cell_integration.hpp"

namespace ricochet {

namespace {

template <int d>
double largest_of_block(const Body& body, std::size_t block, const Vector& displacement) {
  using Tensor = Eigen::Matrix<double, d, d>;
  const CellBlock &geometry = body.mesh->cells[block], &cells = body.space->cells[block];
  const Points centre = reference_centre(geometry.shape);
  const Tabulation of_geometry = ReferenceElement::get(geometry.shape, body.mesh->degree).tabulate(centre);
  const Tabulation of_displacement = ReferenceElement::get(geometry.shape, body.space->degree).tabulate(centre);
  const Matrix &map = of_geometry.gradients[0], &shape = of_displacement.gradients[0];
  double largest = 0.0;
  for (Index cell = 0; cell < cells.size(); ++cell) {
    const Tensor inverse = jacobian<d>(body.mesh->nodes, geometry.cell(cell), map).inverse();
    Tensor gradient = Tensor::Zero();
    for (Index k = 0; k < shape.rows(); ++k)
      gradient += displacement.segment<d>(cells.cell(cell)[k] * d) * (shape.template block<1, d>(k, 0) * inverse);
    const Tensor strain = 0.5 * (gradient + gradient.transpose() + gradient.transpose() * gradient);
    if (!strain.allFinite()) continue;
    largest = std::max(largest, symmetric_eigenvalues(strain).cwiseAbs().maxCoeff());
    if (!is_axisymmetric(body)) continue;
    double radius = 0.0, radial = 0.0;
    for (Index k = 0; k < map.rows(); ++k)
      radius += of_geometry.values(k, 0) * body.mesh->nodes(0, geometry.cell(cell)[k]);
    for (Index k = 0; k < shape.rows(); ++k)
      radial += of_displacement.values(k, 0) * displacement[cells.cell(cell)[k] * d];
    const double hoop = radial / radius;
    if (std::isfinite(hoop)) largest = std::max(largest, std::abs(hoop + 0.5 * hoop * hoop));
  }
  return largest;
}

}  // namespace

double largest_green_strain(const Body& body, const Vector& displacement) {
  double largest = 0.0;
  for (std::size_t block = 0; block < body.space->cells.size(); ++block) {
    largest = std::max(largest, body.mesh->dimension == 2 ? largest_of_block<2>(body, block, displacement)
                                                          : largest_of_block<3>(body, block, displacement));
  }
  return largest;
}

}  // namespace ricochet
