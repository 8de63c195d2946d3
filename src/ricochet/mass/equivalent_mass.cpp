#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mass/mass_conditions.hpp"

namespace ricochet {

namespace {

constexpr const char* nodewise_mass = "equivalent-nodewise";
constexpr const char* cellwise_mass = "equivalent-cellwise";
constexpr const char* compact_mass = "equivalent-compact";
/// Top eigenvalue of D⁻¹M₀ above which another mass is preferred: for small problems, whose factors are small anyway,
/// and for large ones, whose nodewise factor would be several times as large.
constexpr double most_of_small = 20.0, most_of_large = 60.0;
constexpr std::size_t many_contact_nodes = 2000;

std::optional<SparseMatrix> built_if_possible(const char* name, const MassInput& inertia) {
  try {
    return build_mass(name, inertia);
  } catch (const Error& refusal) {
    if (refusal.kind() != ErrorKind::invalid_input) throw;
    return {};
  }
}

/// Selects one of the three positive semi-definite constructions according to the problem (docs/equivalent-mass.md has
/// the measurements). In 3D it is the cellwise one, whose pattern is that of the consistent mass: the factor of a step
/// is half as large, and with degree 1 the frequencies are equally accurate except on coarse balls. For bodies too
/// coarse for it, it is the nodewise one, which needs no whole cell and amplifies inertia less, or the compact one if
/// there are many contact nodes and even more massive ones; in 2D, where the factors differ little, it is the nodewise
/// one. If that is refused, a cellwise mass of higher amplification is better than none.
MassChoice choose_equivalent_mass(const MassInput& input) {
  if (input.nodes->rows() == 2) return MassChoice{nodewise_mass, {}, {}};
  if (input.cells == nullptr)
    return MassChoice{nodewise_mass, "the mass matrices of single cells are not available", {}};
  MassInput inertia = input;
  inertia.consistent = &input.inertia_matrix();
  inertia.inertia = nullptr;
  const bool is_large = input.contact_nodes.size() > many_contact_nodes;
  const std::optional<SparseMatrix> by_cells = built_if_possible(cellwise_mass, inertia);
  const double top = by_cells ? top_eigenvalue(*by_cells, inertia.consistent->diagonal()) : 0.0;
  if (by_cells && top <= (is_large ? most_of_large : most_of_small))
    return MassChoice{cellwise_mass, "its factor has the size of that of the consistent mass", by_cells};
  const std::string reason =
      by_cells
          ? fmt::format("on such a coarse body cells would accumulate {:.3g} times their original inertia", top)
          : "cells with enough nodes off the contact boundary to receive the inertia of others are rare or missing";
  // If no cell without contact nodes is near, `compact` searches far away for each cell, and the factor of `nodewise`
  // is small.
  const char* const name = is_large && by_cells ? compact_mass : nodewise_mass;
  if (std::optional<SparseMatrix> mass = built_if_possible(name, inertia))
    return MassChoice{name, reason, std::move(mass)};
  if (!by_cells) return MassChoice{name, reason, {}};  // building it throws an error with the reason
  return MassChoice{cellwise_mass, fmt::format("{}, but \"{}\" cannot be built", reason, name), by_cells};
}

SparseMatrix build_equivalent_mass(const MassInput& input, const Parameters&) {
  MassChoice choice = choose_equivalent_mass(input);
  if (choice.mass && input.consistent == &input.inertia_matrix()) return std::move(*choice.mass);
  return build_mass(choice.name, input);
}

}  // namespace

MassRegistration equivalent_mass() {
  return {"equivalent",
          {.build = build_equivalent_mass, .removes_contact_inertia = true, .choose = choose_equivalent_mass}};
}

}  // namespace ricochet
