#pragma once

#include <array>
#include <map>
#include <vector>

#include "ricochet/fem/facet_map.hpp"
#include "ricochet/mesh/search/box_tree.hpp"

/// @file One side of a contact between bodies: its facets, cut into flat pieces, in a search tree.
namespace ricochet {

/// All vectors have three components; in 2D the third is 0.
class FacetSurface {
 public:
  using Vector3 = Eigen::Vector3d;
  /// Segment or, in 3D, triangle between nodes of a facet.
  struct Piece {
    int facet = 0;               ///< its index in facets()
    std::array<Index, 3> nodes;  ///< of the mesh, at the corners
    std::array<Vector3, 3> corners;
    Vector3 normal;  ///< out of the body, of length 1
  };
  struct Facet {
    Index number = 0;  ///< through all blocks
    int first_piece = 0, piece_count = 0;
    double area = 0.0;             ///< of the pieces
    Vector3 area_vector{0, 0, 0};  ///< ∫ N over the pieces, out of the body: a length in 2D, an area in 3D
    Vector3 centre{0, 0, 0};       ///< the mean of its vertices
    double size = 0.0;             ///< the longest distance between corners
    double cell_height = 0.0;      ///< height of the cell behind it
    double body_depth = 0.0;       ///< depth of the body behind it, which limits overlaps (deepest_overlap)
  };

  /// `facets`: numbered through all blocks, ascending. Their positions are displaced by `shift` (d; zero if empty).
  FacetSurface(const Body& body, const std::vector<Index>& facets, const Vector& shift = {});
  /// Surface for a moving body: facets of second order have all their pieces, even if they are flat at the start.
  [[nodiscard]] static FacetSurface moving(const Body& body, const std::vector<Index>& facets);
  /// Moves the pieces to the current positions of the mesh nodes; sizes, heights and depths remain the initial ones.
  /// Does not allocate.
  void move(const Points& nodes);

  /// Sets the depth of the body behind each facet, which until then is the height of its cell.
  void set_depths(const std::vector<double>& depths) {
    for (std::size_t k = 0; k < facets_.size(); ++k) facets_[k].body_depth = depths[k];
  }

  [[nodiscard]] const std::vector<Facet>& facets() const { return facets_; }
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  [[nodiscard]] const BoxTree& tree() const { return tree_; }
  /// Cells behind the facets, numbered through all blocks.
  [[nodiscard]] const std::vector<Index>& cells() const { return cells_; }
  /// Smallest height of the cells behind the facets around a node.
  [[nodiscard]] double height_at(Index node) const { return node_height_.at(node); }
  [[nodiscard]] const Vector& shift() const { return shift_; }

 private:
  FacetSurface(const Body& body, const std::vector<Index>& facets, const Vector& shift, bool moves);
  void add_facet(const Body& body, Index facet, Index cell);
  void update_geometry(Facet& facet);

  std::vector<Facet> facets_;
  std::vector<Index> cells_;
  std::vector<Piece> pieces_;
  std::map<Index, double> node_height_;
  Vector shift_;
  bool plane_, moves_;
  std::vector<BoxTree::Box> boxes_;  ///< of the pieces
  BoxTree tree_;
};

}  // namespace ricochet
