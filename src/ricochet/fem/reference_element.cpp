#include "ricochet/fem/reference_element.hpp"

#include <basix/cell.h>
#include <basix/element-families.h>
#include <basix/finite-element.h>
#include <basix/quadrature.h>

#include <numeric>
#include <span>
#include <stdexcept>

#include "ricochet/base/blas.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

namespace {

/// Basix's cell of the same dimension with as many vertices; std::logic_error if there is none.
basix::cell::type basix_cell(CellShape shape) {
  auto type = basix::cell::type::interval;
  const auto fits = [&] {
    return basix::cell::topological_dimension(type) == dimension(shape) &&
           basix::cell::num_sub_entities(type, 0) == vertex_count(shape);
  };
  while (!fits()) {
    if (type == basix::cell::type::pyramid)
      throw std::logic_error("Basix has no cell with the vertices of a " + name(shape));
    type = static_cast<basix::cell::type>(int(type) + 1);
  }
  return type;
}

const basix::FiniteElement& basix_element(CellShape shape, int degree) {
  static const ShapeTable elements([](CellShape of, int k) {
    prepare_blas();  // Basix solves a linear system for the coefficients of its shape functions
    return basix::create_element(basix::element::family::P, basix_cell(of), k,
                                 basix::element::lagrange_variant::gll_warped, false);
  });
  return elements.at(shape, degree);
}

}  // namespace

Tabulation ReferenceElement::tabulate(const Points& points) const {
  const basix::FiniteElement& element = basix_element(shape_, degree_);
  const auto count = std::size_t(points.cols());
  const auto dimension = std::size_t(points.rows());
  // Basix expects contiguous points, which the columns are.
  const auto [data, extents] =
      element.tabulate(1, std::span<const double>(points.data(), count * dimension), {count, dimension});
  const auto nodes = std::size_t(node_count());
  Tabulation result;
  result.values.resize(node_count(), points.cols());
  result.gradients.assign(count, Matrix(node_count(), points.rows()));
  for (std::size_t p = 0; p < count; ++p) {
    for (std::size_t i = 0; i < nodes; ++i) {
      const auto row = Index(i);
      result.values(row, Index(p)) = data[p * nodes + i];
      for (std::size_t k = 0; k < dimension; ++k) {
        result.gradients[p](row, Index(k)) = data[((k + 1) * count + p) * nodes + i];
      }
    }
  }
  return result;
}

ReferenceElement::ReferenceElement(CellShape shape, int degree) : shape_(shape), degree_(degree) {
  const auto [points, extents] = basix_element(shape, degree).points();
  nodes_ = Eigen::Map<const Points>(points.data(), Index(extents[1]), Index(extents[0]));
}

const ReferenceElement& ReferenceElement::get(CellShape shape, int degree) {
  static const ShapeTable elements([](CellShape of, int k) { return ReferenceElement(of, k); });
  return elements.at(shape, degree);
}

QuadratureRule quadrature(CellShape shape, int degree) {
  prepare_blas();
  const auto [points, weights] = basix::quadrature::make_quadrature(basix_cell(shape), degree);
  const auto count = Index(weights.size());
  QuadratureRule rule;
  rule.points = Eigen::Map<const Points>(points.data(), dimension(shape), count);
  rule.weights = Eigen::Map<const Vector>(weights.data(), count);
  return rule;
}

Vector reference_centre(CellShape shape) {
  std::vector<int> vertices(static_cast<std::size_t>(vertex_count(shape)));
  std::iota(vertices.begin(), vertices.end(), 0);
  return reference_position(shape, vertices).head(dimension(shape));
}

}  // namespace ricochet
