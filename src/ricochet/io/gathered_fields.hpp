#pragma once

#include <memory>
#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/io/fields/field_source.hpp"

/// @file Fields of a body that is divided among ranks, assembled on the first rank.
namespace ricochet {

class GatheredFields {
 public:
  /// `own`: fields of this rank; at a shared node the values of its owner count. `node_rows`, `cell_rows`: rows of this
  /// rank in the whole.
  GatheredFields(const Ranks& ranks, std::vector<Field> own, const std::vector<Index>& node_rows,
                 const std::vector<Index>& cell_rows, Index nodes, Index cells);

  /// Fields of the whole body on the first rank; empty elsewhere.
  [[nodiscard]] const std::vector<Field>& fields() const { return fields_; }
  /// Gathers the current values. All ranks call it together.
  void gather();

 private:
  struct Rows {
    std::vector<Index> own;               ///< that this rank contributes
    std::vector<std::vector<Index>> all;  ///< on the first rank: target rows of each rank
  };
  [[nodiscard]] Rows rows_of(const std::vector<Index>& own, const std::vector<Index>& global_rows) const;
  [[nodiscard]] const Rows& rows_of(const Field& field) const {
    return field.location == FieldLocation::nodes ? nodes_ : cells_;
  }

  const Ranks& ranks_;
  std::vector<Field> own_, fields_;
  Rows nodes_, cells_;
  std::vector<std::vector<double>> reals_;
  std::vector<std::vector<int>> integers_;
};

}  // namespace ricochet
