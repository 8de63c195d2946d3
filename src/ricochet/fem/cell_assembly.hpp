#pragma once

#include <algorithm>
#include <vector>

#include "ricochet/base/parallel.hpp"
#include "ricochet/fem/assembly.hpp"
#include "ricochet/fem/element_matrices.hpp"

/// @file Sums over cells with results that do not depend on the number of threads. Not part of the public interface.
namespace ricochet {

/// Zero matrix with `components` × `components` entries per pair of neighbouring nodes.
inline SparseMatrix matrix_on_graph(const NodeGraph& graph, int components) {
  const Index nodes = graph.node_count();
  SparseMatrix matrix(nodes * components, nodes * components);
  const Index entries = Index(graph.neighbours.size()) * components * components;
  matrix.resizeNonZeros(entries);
  int* outer = matrix.outerIndexPtr();
  outer[nodes * components] = int(entries);
  parallel_ranges(nodes, [&](Index first, Index last) {
    for (Index node = first; node < last; ++node) {
      const Index begin = graph.offsets[std::size_t(node)];
      const Index length = graph.offsets[std::size_t(node) + 1] - begin;
      for (int a = 0; a < components; ++a) {
        Index position = (begin * components + a * length) * components;
        outer[node * components + a] = int(position);
        for (Index k = begin; k < begin + length; ++k) {
          for (int b = 0; b < components; ++b, ++position) {
            matrix.innerIndexPtr()[position] = graph.neighbours[std::size_t(k)] * components + b;
            matrix.valuePtr()[position] = 0.0;
          }
        }
      }
    }
  });
  return matrix;
}

/// Storage of the matrix of a cell.
enum class CellMatrix {
  symmetric,  ///< blocks of components² for pairs of nodes i ≤ j, see element_matrices.hpp
  general     ///< all entries, column by column
};

/// Number of entries of the matrix of a cell with `count` nodes.
template <int components>
constexpr int entries_of(CellMatrix storage, int count) {
  return components * components * (storage == CellMatrix::symmetric ? pair_number(0, count) : count * count);
}

/// Entry of the matrix of a cell: row `c` of node j, column `a` of node i.
template <int components, CellMatrix storage>
double entry_of(const double* matrix, int count, int i, int j, int a, int c) {
  if constexpr (storage == CellMatrix::general) return matrix[((i * components + a) * count + j) * components + c];
  const double* const block = matrix + pair_number(std::min(i, j), std::max(i, j)) * components * components;
  return i <= j ? block[a * components + c] : block[c * components + a];
}

/// Adds the columns of a cell's matrix that belong to the nodes of a part.
template <int components, CellMatrix storage>
void add_columns(const NodeGraph& graph, Index part_begin, Index part_end, const Index* nodes, int count,
                 const double* matrix, double* values) {
  for (int i = 0; i < count; ++i) {
    const auto column = std::size_t(nodes[i]);
    if (nodes[i] < part_begin || nodes[i] >= part_end) continue;
    const Index start = graph.offsets[column];
    const Index length = graph.offsets[column + 1] - start;
    const int* begin = graph.neighbours.data() + start;
    for (int j = 0; j < count; ++j) {
      const Index at = std::lower_bound(begin, begin + length, int(nodes[j])) - begin;
      for (int a = 0; a < components; ++a) {
        double* target = values + (start * components + a * length + at) * components;
        for (int c = 0; c < components; ++c) target[c] += entry_of<components, storage>(matrix, count, i, j, a, c);
      }
    }
  }
}

/// Assembles the matrices of all cells. Each column is summed by one thread in the order of the cells, so that the
/// result is bitwise the same for any number of threads. `element(block number, cell, cell number through all blocks,
/// entries)` computes the matrix of a cell.
template <int components, CellMatrix storage = CellMatrix::symmetric, class ElementMatrix>
SparseMatrix assemble(const Body& body, const NodeGraph& graph, const ElementMatrix& element) {
  SparseMatrix result = matrix_on_graph(graph, components);
  int most_nodes = 0;
  for (const CellBlock& block : body.space->cells) most_nodes = std::max(most_nodes, block.nodes_per_cell);
  parallel_ranges(graph.parts(), [&](Index first, Index last) {
    std::vector<double> entries(static_cast<std::size_t>(entries_of<components>(storage, most_nodes)));
    for (auto part = std::size_t(first); part < std::size_t(last); ++part) {
      CellWalk cell(body.space->cells);
      for (Index k = graph.cell_begins[part]; k < graph.cell_begins[part + 1]; ++k) {
        const int number = graph.cells[std::size_t(k)];
        cell.go_to(number);
        element(cell.block(), cell.local(), std::size_t(number), entries.data());
        add_columns<components, storage>(graph, graph.part_begins[part], graph.part_begins[part + 1], cell.nodes(),
                                         cell.node_count(), entries.data(), result.valuePtr());
      }
    }
  });
  return result;
}

/// Assembles `count` vectors with `components` per node in the same way. `element(walk, part, cell number through all
/// blocks, vectors)` computes those of the current cell of the walk.
template <int components, std::size_t count, class ElementVectors>
void assemble_vectors(const Body& body, const NodeGraph& graph, const ElementVectors& element,
                      const std::array<Vector*, count>& results) {
  for (Vector* const result : results) result->setZero(graph.node_count() * components);
  parallel_ranges(graph.parts(), [&](Index first, Index last) {
    std::array<std::array<double, most_cell_nodes * components>, count> values;
    for (auto part = std::size_t(first); part < std::size_t(last); ++part) {
      const Index begin = graph.part_begins[part], end = graph.part_begins[part + 1];
      CellWalk walk(body.space->cells);
      for (Index k = graph.cell_begins[part]; k < graph.cell_begins[part + 1]; ++k) {
        const Index cell = graph.cells[std::size_t(k)];
        walk.go_to(cell);
        element(walk, part, cell, values);
        for (std::size_t r = 0; r < count; ++r) {
          const double* value = values[r].data();
          double* const result = results[r]->data();
          for (int i = 0; i < walk.node_count(); ++i, value += components) {
            const Index node = walk.nodes()[i];
            if (node < begin || node >= end) continue;
            for (int a = 0; a < components; ++a) result[node * components + a] += value[a];
          }
        }
      }
    }
  });
}

/// Assembles a single vector.
template <int components, class ElementVector>
void assemble_vector(const Body& body, const NodeGraph& graph, const ElementVector& element, Vector& result) {
  const auto first = [&](const CellWalk& walk, std::size_t part, Index cell, auto& values) {
    element(walk, part, cell, values[0]);
  };
  assemble_vectors<components>(body, graph, first, std::array<Vector*, 1>{&result});
}

}  // namespace ricochet
