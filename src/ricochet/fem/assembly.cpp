#include "ricochet/fem/assembly.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/fem/cell_assembly.hpp"
#include "ricochet/fem/facet_integration.hpp"

namespace ricochet {

namespace {

template <int d>
SparseMatrix scalar_mass(const Body& body, const NodeGraph& graph, const std::vector<double>& weight) {
  std::vector<MassIntegration> rules;
  for (const CellBlock& block : body.mesh->cells)
    rules.emplace_back(block.shape, body.mesh->degree, body.space->degree, is_axisymmetric(body));
  return assemble<1>(body, graph, [&](std::size_t b, Index cell, std::size_t number, double* blocks) {
    const auto material = std::size_t(body.cell_material[number]);
    const double density = body.materials[material].density * (weight.empty() ? 1.0 : weight[material]);
    element_mass<d>(rules[b], body.mesh->nodes, body.mesh->cells[b].cell(cell), density, blocks);
  });
}

template <int d>
SparseMatrix stiffness(const Body& body, const NodeGraph& graph, const std::vector<double>& weight) {
  std::vector<BlockIntegration> rules;
  for (const CellBlock& block : body.mesh->cells)
    rules.push_back(stiffness_integration(block.shape, body.mesh->degree, body.space->degree, is_axisymmetric(body)));
  return assemble<d>(body, graph, [&](std::size_t b, Index cell, std::size_t number, double* blocks) {
    const auto material_number = std::size_t(body.cell_material[number]);
    const Material& material = body.materials[material_number];
    const double factor = weight.empty() ? 1.0 : weight[material_number];
    const IsotropicElasticity law = linear_law(body, material);
    element_stiffness<d>(rules[b], body.mesh->nodes, body.mesh->cells[b].cell(cell),
                         {factor * law.lambda, factor * law.mu}, blocks);
  });
}

template <int d>
void cell_load(const Body& body, const ForceDensity& force, Vector& load) {
  Vector position(d), density(d);
  for (std::size_t b = 0; b < body.space->cells.size(); ++b) {
    const CellBlock& cells = body.mesh->cells[b];
    const bool axisymmetric = is_axisymmetric(body);
    const BlockIntegration integration(
        cells.shape, body.mesh->degree, body.space->degree,
        product_quadrature_degree(cells.shape, body.mesh->degree, body.space->degree, axisymmetric), axisymmetric);
    for (Index cell = 0; cell < cells.size(); ++cell) {
      for (Index q = 0; q < integration.rule.weights.size(); ++q) {
        const auto map =
            jacobian<d>(body.mesh->nodes, cells.cell(cell), integration.geometry.gradients[std::size_t(q)]);
        position.setZero();
        for (int k = 0; k < cells.nodes_per_cell; ++k) {
          position += body.mesh->nodes.col(cells.cell(cell)[k]) * integration.geometry.values(k, q);
        }
        force(position, density);
        const double measure =
            integration.rule.weights[q] * map.determinant() * integration.ring(body.mesh->nodes, cells.cell(cell), q);
        for (int k = 0; k < body.space->cells[b].nodes_per_cell; ++k) {
          load.segment<d>(body.space->cells[b].cell(cell)[k] * d) +=
              (measure * integration.displacement.values(k, q)) * density;
        }
      }
    }
  }
}

}  // namespace

bool has_finite_strain(const Body& body) {
  return std::ranges::any_of(body.materials, [](const Material& material) { return !material.law->is_linear(); });
}

IsotropicElasticity linear_law(const Body& body, const Material& material) {
  if (const auto law = material.law->constant_tangent(is_plane_stress(body))) return *law;
  throw Error(ErrorKind::invalid_input,
              fmt::format("material \"{}\": its law is not linear, but a constant stiffness is needed", material.name));
}

SparseMatrix assemble_scalar_mass(const Body& body, const NodeGraph& graph, const std::vector<double>& weight) {
  return body.mesh->dimension == 2 ? scalar_mass<2>(body, graph, weight) : scalar_mass<3>(body, graph, weight);
}

SparseMatrix assemble_stiffness(const Body& body, const NodeGraph& graph, const std::vector<double>& weight) {
  return body.mesh->dimension == 2 ? stiffness<2>(body, graph, weight) : stiffness<3>(body, graph, weight);
}

void add_body_load(const Body& body, const ForceDensity& force, Vector& load) {
  body.mesh->dimension == 2 ? cell_load<2>(body, force, load) : cell_load<3>(body, force, load);
}

void add_facet_load(const Body& body, const std::vector<Index>& facets, const ForceDensity& force, Vector& load) {
  const int d = body.space->dimension;
  const FacetIntegration integration(body);
  FacetQuadrature quadrature;
  Vector position(d), density(d);
  for (const Index facet : facets) {
    integration.evaluate(facet, quadrature);
    for (Index q = 0; q < quadrature.measure.size(); ++q) {
      position = quadrature.positions.col(q);
      force(position, density);
      for (Index k = 0; k < quadrature.node_count(); ++k) {
        load.segment(quadrature.nodes[k] * d, d) +=
            (quadrature.measure[q] * (*quadrature.displacement)(k, q)) * density;
      }
    }
  }
}

SparseMatrix expand_to_components(const SparseMatrix& scalar, int dimension) {
  SparseMatrix result(scalar.rows() * dimension, scalar.cols() * dimension);
  result.resizeNonZeros(scalar.nonZeros() * dimension);
  Index position = 0;
  for (Index column = 0; column < scalar.cols(); ++column) {
    for (int k = 0; k < dimension; ++k) {
      result.outerIndexPtr()[column * dimension + k] = int(position);
      for (SparseMatrix::InnerIterator entry(scalar, column); entry; ++entry, ++position) {
        result.innerIndexPtr()[position] = int(entry.row()) * dimension + k;
        result.valuePtr()[position] = entry.value();
      }
    }
  }
  result.outerIndexPtr()[result.cols()] = int(position);
  return result;
}

}  // namespace ricochet
