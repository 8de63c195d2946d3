#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/base/registry.hpp"
#include "ricochet/fem/facet_integration.hpp"

/// @file Spaces of contact and friction multipliers on the contact boundary (Λ_N^h, Λ_T^h of the source's section 2).
/// To add one: a file with a class and its registration, and one line in multiplier_space.cpp.
namespace ricochet {

/// Domain of a space: the facets of all contact pairs that share an obstacle and name the same space, or of one pair of
/// bodies.
struct ContactPatch {
  struct Part {
    int pair = 0;               ///< number of the ContactPair
    std::vector<Index> facets;  ///< numbered through all blocks
  };
  const Body* body = nullptr;
  std::vector<Part> parts;  ///< pairs ascending
  std::function<bool(Index node)> is_supported =
      {};  ///< whether supports constrain the node along the normal; empty: none
};

enum class MultiplierAnchor { node, facet };

/// Multiplier ψ_i of a space, anchored at a node or at a facet.
struct Multiplier {
  int pair = 0;                                 ///< the first pair whose facets are in its support
  Index node = -1;                              ///< its anchor; −1 if anchored at a facet
  Index facet = -1;                             ///< its anchor; −1 if anchored at a node
  double weight = 0.0;                          ///< D_i = ∫ψ_i
  std::vector<std::pair<Index, double>> trace;  ///< (node j, c_ij = (1/D_i) ∫ψ_i φ_j)
};

/// Functions ψ_i on one facet.
struct FacetMultipliers {
  std::vector<Index> anchors;  ///< nodes, or the facet itself, as in Multiplier
  Matrix values;               ///< anchors × quadrature points
};

class MultiplierSpace {
 public:
  explicit MultiplierSpace(const ContactPatch& patch) : patch_(&patch) {}
  virtual ~MultiplierSpace() = default;
  MultiplierSpace(const MultiplierSpace&) = delete;
  MultiplierSpace& operator=(const MultiplierSpace&) = delete;

  /// All multipliers of the patch, by ascending anchor. Those that can only act on supports may be omitted.
  [[nodiscard]] virtual std::vector<Multiplier> multipliers() const = 0;
  /// Recovers the pressure at nodes from reactions: entries (node, number of the multiplier in `retained`, value) of
  /// the matrix P in p = P r. `retained` are the multipliers in use: the others are zero. Between bodies D_i and c_ij
  /// are those of the covered part.
  [[nodiscard]] virtual std::vector<Eigen::Triplet<double>> pressure_recovery(
      const std::vector<Multiplier>& retained) const = 0;
  /// Whether multipliers are functions; false for nodal forces, which are conditions at nodes. `evaluate` then returns
  /// a basis of their L² representatives.
  [[nodiscard]] virtual bool has_functions() const { return true; }
  /// Evaluates ψ_i at the quadrature points of a facet of the patch. Between bodies the points lie in the part of it
  /// that faces the other surface (FacetQuadrature::whole). In that case each facet has the same anchors in the same
  /// order for any points, and the functions sum to 1 and have positive integrals over any part: a multiplier without
  /// one is omitted as not covered.
  virtual void evaluate(const FacetQuadrature& facet, FacetMultipliers& result) const = 0;

  [[nodiscard]] const ContactPatch& patch() const { return *patch_; }
  [[nodiscard]] bool is_supported(Index node) const { return patch_->is_supported && patch_->is_supported(node); }

 private:
  const ContactPatch* patch_;
};

struct MultiplierSpaceType {
  /// The patch must outlive the space.
  std::function<std::unique_ptr<MultiplierSpace>(const ContactPatch&)> make;
  MultiplierAnchor anchor = MultiplierAnchor::node;
  std::function<std::string(CellShape, int)> instability = {};  ///< see instability(); empty if stable
};
using MultiplierSpaceRegistration = Registration<MultiplierSpaceType>;

/// Registry of all spaces. A program may add its own.
[[nodiscard]] Registry<MultiplierSpaceType>& multiplier_space_registry();
[[nodiscard]] inline std::vector<std::string> multiplier_space_names() { return multiplier_space_registry().names(); }
/// Creates a space by its name in case files; throws Error(invalid_input) that lists the names. The
/// patch must outlive the space.
[[nodiscard]] std::unique_ptr<MultiplierSpace> make_multiplier_space(const std::string& name,
                                                                     const ContactPatch& patch);
/// Anchor of the multipliers of a space; throws like make_multiplier_space.
[[nodiscard]] MultiplierAnchor anchor_of(const std::string& multipliers);

/// Reason why a space is not uniformly inf–sup stable with displacements of a degree on facets of a shape, and an
/// alternative, as a sentence without its full stop; empty if it is stable, according to the numerical test
/// inf_sup_test.cpp on families of meshes (docs/multipliers.md). Without stability, pressures that oscillate from facet
/// to facet are not controlled, and there may be too many conditions for the available displacements.
[[nodiscard]] std::string instability(const std::string& multipliers, CellShape facet, int displacement_degree);

/// Whether supports constrain a multiplier's node or, if it is anchored at a facet, all its nodes: it is then omitted.
[[nodiscard]] bool only_presses_supports(const Multiplier& multiplier, const ContactPatch& patch);

/// Computes D_i and c_ij of a space by integrating its functions over the patch; c_ij that vanish to
/// rounding are set to exact zero.
[[nodiscard]] std::vector<Multiplier> integrate_multipliers(const MultiplierSpace& space, MultiplierAnchor anchor);

}  // namespace ricochet
