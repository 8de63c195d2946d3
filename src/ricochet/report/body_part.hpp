#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/report/contact_line.hpp"
#include "ricochet/report/packed_array.hpp"
#include "ricochet/report/run_data.hpp"
#include "ricochet/report/simplices.hpp"

/// @file The body over time in a page, and its contact boundary.
namespace ricochet {

/// A quantity of the contact boundary, frames × nodes of the contact line.
struct ContactQuantity {
  std::string name;
  PackedArray values;
};

struct ContactPart {
  ContactLine line;
  std::vector<int> frames;  ///< numbers of the frames included
  PackedArray position;     ///< in the plane
  PackedArray nodes;        ///< numbers of the nodes in the body's surface; −1: not a node of the surface
  std::vector<ContactQuantity> quantities;
};

/// A field of the body, frames × nodes or frames × cells of the surface.
struct BodyField {
  std::string name;
  bool on_nodes = true;
  PackedArray values;
};

/// The inside of a solid at the frames of its BodyPart; displacements are relative to the same mean.
struct VolumePart {
  Index nodes = 0, tetrahedra = 0;
  PackedArray positions;  ///< 3 × nodes, reference configuration
  PackedArray corners;    ///< tetrahedra × 4
  PackedArray cells;      ///< per tetrahedron, index of its cell among those included
  PackedArray faces;      ///< sides, see Simplices
  std::vector<PackedArray> deviations;
  std::vector<BodyField> fields;
  bool is_thinned = false;  ///< nodes were merged
};

struct BodyPart {
  Index nodes = 0, triangles = 0;
  PackedArray positions;                ///< dimension × nodes, reference configuration
  PackedArray corners;                  ///< triangles × 3
  PackedArray triangle_cells;           ///< per triangle, index of its cell among the visible ones
  PackedArray edges;                    ///< sides, see Simplices
  std::vector<int> frames;              ///< numbers of the frames included
  PackedArray mean;                     ///< frames × 3: mean displacement of the nodes
  std::vector<PackedArray> deviations;  ///< per dimension, frames × nodes: displacement less its mean
  std::vector<BodyField> fields;
  int displacement_bits = 0, field_bits = 0;  ///< of the levels
  bool is_coarse = false;                     ///< fewer bits than at the best quality
  std::vector<std::string> left_out;          ///< fields that are not in the page
  bool is_thinned = false;                    ///< triangles were merged
  std::optional<VolumePart> volume;           ///< inside of solids, if the size allows it
};

/// Data of a body for pages, read once: its visible surface and all its frames (or as many as memory allows).
class BodyFrames {
 public:
  /// Keeps a reference to the results. The inside of a solid is coarsened to take approximately so many bytes of the
  /// page.
  BodyFrames(const ResultsReader& results, Index most_triangles, std::size_t volume_bytes);

  /// Packs at most so many bytes of the page, as far as omitting frames and coarser levels allow.
  [[nodiscard]] ContactPart pack_contact(std::size_t most_bytes, PackedArrays& arrays) const;
  [[nodiscard]] BodyPart pack_body(std::size_t most_bytes, PackedArrays& arrays) const;
  /// Returns the number of frames of the run.
  [[nodiscard]] Index frame_count() const { return Index(results_.times().size()); }

 private:
  struct Values {
    std::string name;
    bool on_nodes = true;
    Index columns = 0;
    std::vector<float> values;  ///< frames × columns
  };
  struct Quality {
    int displacement_bits, field_bits;
    std::size_t stride;  ///< ratio of the frames read to those included
  };
  /// The surface or the inside of a body in the page, with its displacements and fields.
  struct Part {
    std::vector<Index> nodes;
    std::vector<int> cells;    ///< cells of the body that are needed
    std::vector<int> numbers;  ///< per triangle or tetrahedron, index in `cells`
    std::vector<Values> deviations, fields;
    Part() = default;
    Part(std::vector<Index> its_nodes, const std::vector<int>& cells_of_pieces);
  };
  void choose();
  void make_inside(std::size_t bytes);
  void read_frames();
  void store_displacement(const std::vector<float>& field);
  void store_contact(const ResultField& field, const std::vector<float>& values);
  void store_field(const ResultField& field, const std::vector<float>& values);
  /// Returns the rows of the frames that a stride leaves, always including the last.
  [[nodiscard]] std::vector<std::size_t> selected_rows(std::size_t stride) const;
  [[nodiscard]] std::vector<int> frames_of(const std::vector<std::size_t>& rows) const;
  void pack_frames(const Quality& quality, const std::vector<std::size_t>& rows, PackedArrays& arrays,
                   BodyPart& part) const;
  [[nodiscard]] std::optional<VolumePart> pack_volume(const std::vector<std::size_t>& rows, std::size_t most_bytes,
                                                      PackedArrays& arrays) const;
  [[nodiscard]] PackedArray pack_positions(const std::vector<Index>& nodes, PackedArrays& arrays) const;
  [[nodiscard]] static PackedArray pack(const Values& values, const std::vector<std::size_t>& rows, int bits,
                                        PackedArrays& arrays);

  const ResultsReader& results_;
  int dimension_;
  Simplices surface_;
  ContactLine line_;
  Simplices volume_;
  Part outside_, inside_;
  std::vector<int> frames_;   ///< numbers of the frames that were read
  std::vector<double> mean_;  ///< frames × 3
  std::vector<Values> contact_;
  std::vector<std::string> left_out_;
};

}  // namespace ricochet
