#include "ricochet/fem/assembly.hpp"

#include <algorithm>

#include "ricochet/base/parallel.hpp"
#include "ricochet/fem/cell_integration.hpp"
#include "ricochet/fem/facet_integration.hpp"

namespace ricochet {

NodeGraph node_graph(const DisplacementSpace& space) {
  const auto count = static_cast<std::size_t>(space.node_count());
  std::vector<Index> offsets(count + 1, 0);
  for (const CellBlock& block : space.cells) {
    for (const Index node : block.nodes) offsets[static_cast<std::size_t>(node) + 1] += 1;
  }
  for (std::size_t i = 0; i < count; ++i) offsets[i + 1] += offsets[i];
  struct Incidence {
    const CellBlock* block;
    Index cell;
  };
  std::vector<Incidence> cells(static_cast<std::size_t>(offsets[count]));
  std::vector<Index> next(offsets.begin(), offsets.end() - 1);
  for (const CellBlock& block : space.cells) {
    for (Index i = 0; i < block.size(); ++i) {
      for (int k = 0; k < block.nodes_per_cell; ++k) {
        cells[static_cast<std::size_t>(next[static_cast<std::size_t>(block.cell(i)[k])]++)] = {&block, i};
      }
    }
  }
  NodeGraph graph;
  graph.offsets.assign(1, 0);
  graph.offsets.reserve(count + 1);
  std::vector<int> row;
  for (std::size_t node = 0; node < count; ++node) {
    row.clear();
    for (Index k = offsets[node]; k < offsets[node + 1]; ++k) {
      const auto& [block, cell] = cells[static_cast<std::size_t>(k)];
      for (int j = 0; j < block->nodes_per_cell; ++j) row.push_back(static_cast<int>(block->cell(cell)[j]));
    }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    graph.neighbours.insert(graph.neighbours.end(), row.begin(), row.end());
    graph.offsets.push_back(static_cast<Index>(graph.neighbours.size()));
  }
  return graph;
}

namespace {

/// An empty matrix with `components` × `components` values per pair of neighbouring nodes.
SparseMatrix matrix_on_graph(const NodeGraph& graph, int components) {
  const auto nodes = static_cast<Index>(graph.offsets.size()) - 1;
  SparseMatrix matrix(nodes * components, nodes * components);
  matrix.resizeNonZeros(static_cast<Index>(graph.neighbours.size()) * components * components);
  int* outer = matrix.outerIndexPtr();
  int* inner = matrix.innerIndexPtr();
  Index position = 0;
  for (Index node = 0; node < nodes; ++node) {
    for (int a = 0; a < components; ++a) {
      outer[node * components + a] = static_cast<int>(position);
      for (Index k = graph.offsets[static_cast<std::size_t>(node)];
           k < graph.offsets[static_cast<std::size_t>(node) + 1]; ++k) {
        for (int b = 0; b < components; ++b) {
          inner[position++] = graph.neighbours[static_cast<std::size_t>(k)] * components + b;
        }
      }
    }
  }
  outer[nodes * components] = static_cast<int>(position);
  std::fill_n(matrix.valuePtr(), position, 0.0);
  return matrix;
}

/// Position of node `column` among the neighbours of node `row`.
Index neighbour_position(const NodeGraph& graph, Index row, Index column) {
  const int* begin = graph.neighbours.data() + graph.offsets[static_cast<std::size_t>(row)];
  const int* end = graph.neighbours.data() + graph.offsets[static_cast<std::size_t>(row) + 1];
  return std::lower_bound(begin, end, static_cast<int>(column)) - begin;
}

/// Calls `element(block number, cell, cell number through all blocks, matrix)` for the cells that touch a range of
/// nodes and adds the rows of those nodes. Every row is summed by one thread in the order of the cells: the same bits
/// for any number of threads. (`element` returns a symmetric matrix, nodes × components.)
template <class ElementMatrix>
void assemble_rows(const Body& body, const NodeGraph& graph, int components, const ElementMatrix& element,
                   SparseMatrix& result) {
  double* values = result.valuePtr();
  parallel_ranges(body.space->node_count(), [&](Index begin, Index end) {
    Matrix local;
    Index cell_number = 0;
    for (std::size_t b = 0; b < body.space->cells.size(); ++b) {
      const CellBlock& block = body.space->cells[b];
      for (Index cell = 0; cell < block.size(); ++cell, ++cell_number) {
        const Index* nodes = block.cell(cell);
        if (std::none_of(nodes, nodes + block.nodes_per_cell, [&](Index n) { return n >= begin && n < end; })) continue;
        element(b, cell, cell_number, local);
        for (int i = 0; i < block.nodes_per_cell; ++i) {
          const Index row = nodes[i];
          if (row < begin || row >= end) continue;
          const Index row_start = graph.offsets[static_cast<std::size_t>(row)];
          const Index row_length = graph.offsets[static_cast<std::size_t>(row) + 1] - row_start;
          for (int j = 0; j < block.nodes_per_cell; ++j) {
            const Index at = neighbour_position(graph, row, nodes[j]);
            for (int a = 0; a < components; ++a) {
              double* target = values + (row_start * components + a * row_length + at) * components;
              for (int c = 0; c < components; ++c) target[c] += local(i * components + a, j * components + c);
            }
          }
        }
      }
    }
  });
}

std::vector<BlockIntegration> integrations(const Body& body, int (*degree)(CellShape, int, int)) {
  std::vector<BlockIntegration> result;
  for (const CellBlock& block : body.mesh->cells) {
    result.emplace_back(block.shape, body.mesh->degree, body.space->degree,
                        degree(block.shape, body.mesh->degree, body.space->degree));
  }
  return result;
}

template <int d>
SparseMatrix scalar_mass(const Body& body, const NodeGraph& graph, const std::vector<double>& weight) {
  SparseMatrix result = matrix_on_graph(graph, 1);
  const std::vector<BlockIntegration> rules = integrations(body, product_quadrature_degree);
  const auto element = [&](std::size_t b, Index cell, Index number, Matrix& local) {
    const BlockIntegration& integration = rules[b];
    const auto material = static_cast<std::size_t>(body.cell_material[static_cast<std::size_t>(number)]);
    const double density = body.materials[material].density * (weight.empty() ? 1.0 : weight[material]);
    const Matrix& values = integration.displacement.values;
    local.setZero(values.rows(), values.rows());
    for (Index q = 0; q < values.cols(); ++q) {
      const Eigen::Matrix<double, d, d> map = jacobian<d>(body.mesh->nodes, body.mesh->cells[b].cell(cell),
                                                          integration.geometry.gradients[static_cast<std::size_t>(q)]);
      const double factor = density * integration.rule.weights[q] * map.determinant();
      for (Index j = 0; j < values.rows(); ++j) {
        for (Index i = 0; i <= j; ++i) local(i, j) += factor * (values(i, q) * values(j, q));
      }
    }
    local.template triangularView<Eigen::StrictlyLower>() = local.transpose();
  };
  assemble_rows(body, graph, 1, element, result);
  return result;
}

template <int d>
SparseMatrix stiffness(const Body& body, const NodeGraph& graph, const std::vector<double>& weight) {
  SparseMatrix result = matrix_on_graph(graph, d);
  const std::vector<BlockIntegration> rules = integrations(body, stiffness_quadrature_degree);
  const auto element = [&](std::size_t b, Index cell, Index number, Matrix& local) {
    const BlockIntegration& integration = rules[b];
    const auto material_number = static_cast<std::size_t>(body.cell_material[static_cast<std::size_t>(number)]);
    const Material& material = body.materials[material_number];
    const double factor = weight.empty() ? 1.0 : weight[material_number];
    const bool plane_stress = d == 2 && body.plane == PlaneState::stress;
    const double lambda = factor * (plane_stress ? material.plane_stress_lambda() : material.lambda);
    const double mu = factor * material.mu;
    const Index nodes = integration.displacement.values.rows();
    local.setZero(nodes * d, nodes * d);
    Eigen::Matrix<double, Eigen::Dynamic, d> gradients;
    for (std::size_t q = 0; q < integration.geometry.gradients.size(); ++q) {
      const Eigen::Matrix<double, d, d> map =
          jacobian<d>(body.mesh->nodes, body.mesh->cells[b].cell(cell), integration.geometry.gradients[q]);
      const double measure = integration.rule.weights[static_cast<Index>(q)] * map.determinant();
      gradients.noalias() = integration.displacement.gradients[q] * map.inverse();
      for (Index j = 0; j < nodes; ++j) {
        for (Index i = 0; i <= j; ++i) {
          const auto gi = gradients.row(i);
          const auto gj = gradients.row(j);
          Eigen::Matrix<double, d, d> pair = lambda * gi.transpose() * gj + mu * gj.transpose() * gi;
          pair.diagonal().array() += mu * gi.dot(gj);
          local.template block<d, d>(i * d, j * d) += measure * pair;
        }
      }
    }
    local.template triangularView<Eigen::StrictlyLower>() = local.transpose();
  };
  assemble_rows(body, graph, d, element, result);
  return result;
}

template <int d>
void cell_load(const Body& body, const ForceDensity& force, Vector& load) {
  Vector position(d), density(d);
  for (std::size_t b = 0; b < body.space->cells.size(); ++b) {
    const CellBlock& cells = body.mesh->cells[b];
    const BlockIntegration integration(cells.shape, body.mesh->degree, body.space->degree,
                                       product_quadrature_degree(cells.shape, body.mesh->degree, body.space->degree));
    for (Index cell = 0; cell < cells.size(); ++cell) {
      for (Index q = 0; q < integration.rule.weights.size(); ++q) {
        const auto map = jacobian<d>(body.mesh->nodes, cells.cell(cell),
                                     integration.geometry.gradients[static_cast<std::size_t>(q)]);
        position.setZero();
        for (int k = 0; k < cells.nodes_per_cell; ++k) {
          position += body.mesh->nodes.col(cells.cell(cell)[k]) * integration.geometry.values(k, q);
        }
        force(position, density);
        const double measure = integration.rule.weights[q] * map.determinant();
        for (int k = 0; k < body.space->cells[b].nodes_per_cell; ++k) {
          load.segment<d>(body.space->cells[b].cell(cell)[k] * d) +=
              (measure * integration.displacement.values(k, q)) * density;
        }
      }
    }
  }
}

}  // namespace

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
      result.outerIndexPtr()[column * dimension + k] = static_cast<int>(position);
      for (SparseMatrix::InnerIterator entry(scalar, column); entry; ++entry, ++position) {
        result.innerIndexPtr()[position] = static_cast<int>(entry.row()) * dimension + k;
        result.valuePtr()[position] = entry.value();
      }
    }
  }
  result.outerIndexPtr()[result.cols()] = static_cast<int>(position);
  return result;
}

}  // namespace ricochet
