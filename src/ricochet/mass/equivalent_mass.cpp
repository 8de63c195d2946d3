#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mass/mass_conditions.hpp"

namespace ricochet {

namespace {

/// Selects one of the three positive semi-definite constructions according to the problem (docs/equivalent-mass.md has
/// the measurements). In 3D it is the cellwise one, whose pattern is that of the consistent mass: the factor of a step
/// is half as large, and with degree 1 the frequencies are equally accurate except on coarse balls. For bodies too
/// coarse for it, it is the nodewise one, which needs no whole cell and amplifies inertia less, or the compact one if
/// there are many contact nodes and even more massive ones; in 2D, where the factors differ little, it is the nodewise
/// one. If that is refused, a cellwise mass of higher amplification is better than none.
class EquivalentMass final : public MassConstruction {
 public:
  [[nodiscard]] bool removes_contact_inertia() const override { return true; }

  [[nodiscard]] std::optional<MassChoice> choose(const MassInput& input) const override {
    if (input.nodes->rows() == 2) return MassChoice{nodewise, {}, {}};
    if (input.cells == nullptr) return MassChoice{nodewise, "the mass matrices of single cells are not available", {}};
    MassInput inertia = input;
    inertia.consistent = &input.inertia_matrix();
    inertia.inertia = nullptr;
    const bool is_large = input.contact_nodes.size() > many_contact_nodes;
    const std::optional<SparseMatrix> by_cells = built(cellwise, inertia);
    const double top = by_cells ? top_eigenvalue(*by_cells, inertia.consistent->diagonal()) : 0.0;
    if (by_cells && top <= (is_large ? most_of_large : most_of_small))
      return MassChoice{cellwise, "its factor has the size of that of the consistent mass", by_cells};
    const std::string reason =
        by_cells
            ? fmt::format("on such a coarse body cells would accumulate {:.3g} times their original inertia", top)
            : "cells with enough nodes off the contact boundary to receive the inertia of others are rare or missing";
    // If no cell without contact nodes is near, `compact` searches far away for each cell, and the factor of `nodewise`
    // is small.
    const char* const name = is_large && by_cells ? compact : nodewise;
    if (std::optional<SparseMatrix> mass = built(name, inertia)) return MassChoice{name, reason, std::move(mass)};
    if (!by_cells) return MassChoice{name, reason, {}};  // building it throws an error with the reason
    return MassChoice{cellwise, fmt::format("{}, but \"{}\" cannot be built", reason, name), by_cells};
  }

  [[nodiscard]] SparseMatrix build(const MassInput& input) const override {
    std::optional<MassChoice> choice = choose(input);
    if (choice->mass && input.consistent == &input.inertia_matrix()) return std::move(*choice->mass);
    return make_mass(choice->name)->build(input);
  }

 private:
  [[nodiscard]] static std::optional<SparseMatrix> built(const char* name, const MassInput& inertia) {
    try {
      return make_mass(name)->build(inertia);
    } catch (const Error& refusal) {
      if (refusal.kind() != ErrorKind::invalid_input) throw;
      return {};
    }
  }

  static constexpr const char* nodewise = "equivalent-nodewise";
  static constexpr const char* cellwise = "equivalent-cellwise";
  static constexpr const char* compact = "equivalent-compact";
  /// Top eigenvalue of D⁻¹M₀ above which another mass is preferred: for small problems, whose factors are small anyway,
  /// and for large ones, whose nodewise factor would be several times as large.
  static constexpr double most_of_small = 20.0, most_of_large = 60.0;
  static constexpr std::size_t many_contact_nodes = 2000;
};

}  // namespace

MassRegistration equivalent_mass() {
  return {"equivalent", [](const Parameters&) { return std::make_unique<EquivalentMass>(); }};
}

}  // namespace ricochet
