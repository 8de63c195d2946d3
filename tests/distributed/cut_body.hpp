#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/distributed/cut_problem.hpp"
#include "ricochet/distributed/mpi_ranks.hpp"
#include "ricochet/distributed/partition.hpp"
#include "ricochet/distributed/piece.hpp"
#include "ricochet/fem/assembly.hpp"
#include "support/box_mesh.hpp"

/// @file A body cut in pieces. Here every rank also has the whole body, for the expected results.
namespace ricochet::distributed_test {

using test_support::BoxMesh;
using test_support::make_box_mesh;
using test_support::make_meshed_body;
using test_support::MeshedBody;

struct Variant {
  CellShape shape;
  std::vector<int> counts;
  int degree;
  PartitionMethod method;

  [[nodiscard]] std::string name() const {
    return ricochet::name(shape) + std::to_string(degree) + (method == PartitionMethod::random ? "random" : "graph");
  }
};

class CutBody {
 public:
  explicit CutBody(const Variant& variant)
      : world_(Communicator::world()),
        whole_(make_meshed_body(make_box_mesh({variant.shape, variant.counts, 1, 0.1, {}}), variant.degree)),
        division_(partition_cells(whole_->mesh, world_.size(), variant.method, 7)),
        piece_(cut_piece(whole_->mesh, whole_->space, division_, world_.rank())),
        exchange_(world_, piece_.node_number, whole_->space.node_count()),
        ranks_(world_, exchange_),
        d_(whole_->mesh.dimension) {
    own_.mesh = &piece_.mesh;
    own_.space = &piece_.space;
    own_.materials = whole_->body.materials;
    own_.cell_material.assign(piece_.cell_number.size(), 0);
  }

 protected:
  /// Returns this rank's part of a vector on the whole body.
  [[nodiscard]] Vector part_of(const Vector& whole) const { return cut_values(whole, piece_, d_); }

  Communicator world_;
  std::unique_ptr<MeshedBody> whole_;
  std::vector<int> division_;
  Piece piece_;
  NodeExchange exchange_;
  MpiRanks ranks_;
  Body own_;
  int d_;
};

[[nodiscard]] inline std::vector<Variant> variants() {
  return {{CellShape::triangle, {12, 9}, 2, PartitionMethod::graph},
          {CellShape::quadrilateral, {12, 9}, 1, PartitionMethod::random},
          {CellShape::tetrahedron, {7, 6, 5}, 1, PartitionMethod::graph},
          {CellShape::tetrahedron, {4, 4, 3}, 2, PartitionMethod::random},
          {CellShape::hexahedron, {6, 5, 4}, 2, PartitionMethod::graph}};
}

}  // namespace ricochet::distributed_test
