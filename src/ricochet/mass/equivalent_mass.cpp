#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mass/mass_conditions.hpp"

namespace ricochet {

namespace {

/// One of the three positive semi-definite constructions, for each problem by what it is (docs/equivalent-mass.md has
/// the measurements). In space cell by cell, whose pattern is that of the consistent mass: the factor of a step is half
/// as large, and with degree 1 frequencies are as near to the exact ones but on coarse balls. Where bodies are too
/// coarse for that node by node, which needs no whole cell and heaps up less, or within cells where there are many
/// contact nodes and more free ones; and node by node in the plane, where factors differ little. Where that is refused,
/// cells that heap up more are better than nothing.
class EquivalentMass final : public MassConstruction {
 public:
  [[nodiscard]] bool removes_contact_inertia() const override { return true; }

  [[nodiscard]] std::optional<MassChoice> choose(const MassInput& input) const override {
    if (input.nodes->rows() == 2) return MassChoice{nodewise, {}, {}};
    if (input.cells == nullptr) return MassChoice{nodewise, "the masses of single cells are not known", {}};
    MassInput inertia = input;
    inertia.consistent = &input.inertia_matrix();
    inertia.inertia = nullptr;
    const bool is_large = input.contact_nodes.size() > many_contact_nodes;
    const std::optional<SparseMatrix> by_cells = built(cellwise, inertia);
    const double top = by_cells ? top_eigenvalue(*by_cells, inertia.consistent->diagonal()) : 0.0;
    if (by_cells && top <= (is_large ? most_of_large : most_of_small))
      return MassChoice{cellwise, "its factor is that of the consistent mass", by_cells};
    const std::string reason =
        by_cells ? fmt::format("on so coarse a body cells would heap up {:.3g} times the inertia that was there", top)
                 : "cells with enough free nodes to take the inertia of others are rare or missing";
    // Where no free cell is near, `compact` looks far for each cell, and the factor of `nodewise` is small.
    const char* const name = is_large && by_cells ? compact : nodewise;
    if (std::optional<SparseMatrix> mass = built(name, inertia)) return MassChoice{name, reason, std::move(mass)};
    if (!by_cells) return MassChoice{name, reason, {}};  // building it says what stands in the way
    return MassChoice{cellwise, fmt::format("{}, but \"{}\" refuses it", reason, name), by_cells};
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
  /// Of D⁻¹M₀, the top eigenvalue from which on the other mass is better for the small and coarse, whose factors are
  /// small anyway; and for the large, whose factor node by node would be several times as large.
  static constexpr double most_of_small = 20.0, most_of_large = 60.0;
  static constexpr std::size_t many_contact_nodes = 2000;
};

}  // namespace

MassRegistration equivalent_mass() {
  return {"equivalent", [](const Parameters&) { return std::make_unique<EquivalentMass>(); }};
}

}  // namespace ricochet
