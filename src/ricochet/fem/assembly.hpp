#pragma once

#include <functional>
#include <vector>

#include "ricochet/fem/displacement_space.hpp"
#include "ricochet/fem/material.hpp"
#include "ricochet/fem/node_graph.hpp"
#include "ricochet/fem/tied_nodes.hpp"

/// @file Assembly of the matrices and vectors of eq. (2) of the source, by quadrature over cells and facets.
namespace ricochet {

/// Input of the assembly: the mesh and the space of a body, and the material of every cell.
struct Body {
  const Mesh* mesh = nullptr;
  const DisplacementSpace* space = nullptr;
  PlaneState plane = PlaneState::strain;  ///< of 2D bodies
  std::vector<Material> materials;
  std::vector<int> cell_material;  ///< per cell, numbered through all blocks: index into materials
  /// Tied nodes; null if none. Assembly ignores them: matrices and loads are condensed afterwards.
  const TiedNodes* tied = nullptr;
};

[[nodiscard]] inline bool is_plane_stress(const Body& body) {
  return body.mesh->dimension == 2 && body.plane == PlaneState::stress;
}
/// Whether the mesh is the meridian section of a body of revolution about the y axis:
/// integrals are over the whole ring.
[[nodiscard]] inline bool is_axisymmetric(const Body& body) {
  return body.mesh->dimension == 2 && body.plane == PlaneState::axisymmetric;
}

/// Whether a node of the displacement is on the axis: in axisymmetric bodies at exactly x = 0.
[[nodiscard]] inline bool is_on_axis(const Body& body, Index node) {
  return is_axisymmetric(body) && body.space->nodes(0, node) == 0.0;
}

/// Whether some material has a law of finite strain; then all have.
[[nodiscard]] bool has_finite_strain(const Body& body);
/// Law of a material, which has a constant tangent; throws Error(invalid_input) if the law is not linear.
[[nodiscard]] IsotropicElasticity linear_law(const Body& body, const Material& material);
[[nodiscard]] inline const Material& material_of(const Body& body, Index cell) {
  return body.materials[std::size_t(body.cell_material[std::size_t(cell)])];
}

/// ∫ w ρ φ_i φ_j, one scalar per pair of nodes: the mass matrix is M = m ⊗ I. `weight` is per material (empty: 1).
/// Exactly symmetric.
[[nodiscard]] SparseMatrix assemble_scalar_mass(const Body& body, const NodeGraph& graph,
                                                const std::vector<double>& weight = {});

/// K: ∫ A ε(u) : ε(v), dof × dof, in axisymmetric bodies with the hoop strain u_x/x. `weight` is per material
/// (empty: 1). Exactly symmetric.
[[nodiscard]] SparseMatrix assemble_stiffness(const Body& body, const NodeGraph& graph,
                                              const std::vector<double>& weight = {});

/// Expands a scalar matrix on nodes to dofs: m ⊗ I.
[[nodiscard]] SparseMatrix expand_to_components(const SparseMatrix& scalar, int dimension);

/// Force density at a point: writes `dimension` components.
using ForceDensity = std::function<void(const Vector& position, Vector& force)>;

/// Adds ∫ f·v over the cells of the body to `load`.
void add_body_load(const Body& body, const ForceDensity& force, Vector& load);

/// Adds ∫ f·v over facets (numbered through all blocks) to `load`; f is a force per undeformed area.
void add_facet_load(const Body& body, const std::vector<Index>& facets, const ForceDensity& force, Vector& load);

}  // namespace ricochet
