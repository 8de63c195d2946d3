#include "ricochet/fem/vertex_volumes.hpp"

#include "ricochet/fem/cell_integration.hpp"

namespace ricochet {

VertexVolumes::VertexVolumes(const Body& body) : body_(body) {
  for (const CellBlock& block : body.mesh->cells) {
    const Points vertices = ReferenceElement::get(block.shape, 1).nodes();
    geometry_.push_back(ReferenceElement::get(block.shape, body.mesh->degree).tabulate(vertices));
    displacement_.push_back(ReferenceElement::get(block.shape, body.space->degree).tabulate(vertices));
  }
}

template <int d>
void VertexVolumes::add_block(std::size_t block, Index first_cell, const Vector& displacement, Smallest& result) const {
  using Tensor = Eigen::Matrix<double, d, d>;
  const CellBlock &geometry = body_.mesh->cells[block], &cells = body_.space->cells[block];
  for (Index cell = 0; cell < cells.size(); ++cell) {
    for (std::size_t vertex = 0; vertex < geometry_[block].gradients.size(); ++vertex) {
      const Matrix& shape = displacement_[block].gradients[vertex];
      const Tensor reference = jacobian<d>(body_.mesh->nodes, geometry.cell(cell), geometry_[block].gradients[vertex]);
      Tensor current = reference;
      for (Index k = 0; k < shape.rows(); ++k)
        current += displacement.segment<d>(cells.cell(cell)[k] * d) * shape.template block<1, d>(k, 0);
      const double ratio = current.determinant() / reference.determinant();
      if (ratio < result.ratio) result = {ratio, first_cell + cell};
    }
  }
}

VertexVolumes::Smallest VertexVolumes::smallest(const Vector& displacement) const {
  Smallest result;
  Index first_cell = 0;
  for (std::size_t block = 0; block < geometry_.size(); ++block) {
    body_.mesh->dimension == 2 ? add_block<2>(block, first_cell, displacement, result)
                               : add_block<3>(block, first_cell, displacement, result);
    first_cell += body_.mesh->cells[block].size();
  }
  return result;
}

}  // namespace ricochet
