#include "ricochet/fem/reference_element.hpp"

#include <basix/cell.h>
#include <basix/element-families.h>
#include <basix/finite-element.h>
#include <basix/quadrature.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "ricochet/base/blas.hpp"

namespace ricochet {

namespace {

basix::cell::type basix_cell(CellShape shape) {
  switch (shape) {
    case CellShape::interval:
      return basix::cell::type::interval;
    case CellShape::triangle:
      return basix::cell::type::triangle;
    case CellShape::quadrilateral:
      return basix::cell::type::quadrilateral;
    case CellShape::tetrahedron:
      return basix::cell::type::tetrahedron;
    case CellShape::hexahedron:
      return basix::cell::type::hexahedron;
  }
  return basix::cell::type::point;
}

const basix::FiniteElement& basix_element(CellShape shape, int degree) {
  static std::mutex guard;
  static std::map<std::pair<CellShape, int>, basix::FiniteElement> elements;
  const std::scoped_lock lock(guard);
  const auto key = std::make_pair(shape, degree);
  const auto found = elements.find(key);
  if (found != elements.end()) return found->second;
  prepare_blas();  // Basix solves a linear system for the coefficients of its shape functions
  return elements
      .emplace(key, basix::create_element(basix::element::family::P, basix_cell(shape), degree,
                                          basix::element::lagrange_variant::gll_warped, false))
      .first->second;
}

}  // namespace

Tabulation ReferenceElement::tabulate(const Points& points) const {
  const basix::FiniteElement& element = basix_element(shape_, degree_);
  const auto count = static_cast<std::size_t>(points.cols());
  const auto dimension = static_cast<std::size_t>(points.rows());
  // Basix expects contiguous points, which the columns are.
  const auto [data, extents] =
      element.tabulate(1, std::span<const double>(points.data(), count * dimension), {count, dimension});
  const auto nodes = static_cast<std::size_t>(node_count());
  Tabulation result;
  result.values.resize(node_count(), points.cols());
  result.gradients.assign(count, Matrix(node_count(), points.rows()));
  for (std::size_t p = 0; p < count; ++p) {
    for (std::size_t i = 0; i < nodes; ++i) {
      const auto row = static_cast<Index>(i);
      result.values(row, static_cast<Index>(p)) = data[p * nodes + i];
      for (std::size_t k = 0; k < dimension; ++k) {
        result.gradients[p](row, static_cast<Index>(k)) = data[((k + 1) * count + p) * nodes + i];
      }
    }
  }
  return result;
}

ReferenceElement::ReferenceElement(CellShape shape, int degree) : shape_(shape), degree_(degree) {
  const auto [points, extents] = basix_element(shape, degree).points();
  nodes_ = Eigen::Map<const Points>(points.data(), static_cast<Index>(extents[1]), static_cast<Index>(extents[0]));
}

const ReferenceElement& ReferenceElement::get(CellShape shape, int degree) {
  static std::mutex guard;
  static std::map<std::pair<CellShape, int>, std::unique_ptr<ReferenceElement>> elements;
  const std::scoped_lock lock(guard);
  auto& slot = elements[{shape, degree}];
  if (!slot) slot.reset(new ReferenceElement(shape, degree));
  return *slot;
}

QuadratureRule quadrature(CellShape shape, int degree) {
  prepare_blas();
  const auto [points, weights] = basix::quadrature::make_quadrature(basix_cell(shape), degree);
  const auto count = static_cast<Index>(weights.size());
  QuadratureRule rule;
  rule.points = Eigen::Map<const Points>(points.data(), dimension(shape), count);
  rule.weights = Eigen::Map<const Vector>(weights.data(), count);
  return rule;
}

Vector reference_centre(CellShape shape) {
  const bool simplex = shape == CellShape::triangle || shape == CellShape::tetrahedron;
  return Vector::Constant(dimension(shape), simplex ? 1.0 / (dimension(shape) + 1) : 0.5);
}

}  // namespace ricochet
