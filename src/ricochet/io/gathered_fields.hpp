#pragma once

#include <memory>
#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/io/fields/field_source.hpp"

/// @file The fields of a body that is divided among ranks, put together on the first.
namespace ricochet {

class GatheredFields {
 public:
  /// `own`: of this rank; of a shared node the values of its owner are taken. `node_rows`, `cell_rows`: where those of
  /// this rank are in the whole.
  GatheredFields(const Ranks& ranks, std::vector<Field> own, const std::vector<Index>& node_rows,
                 const std::vector<Index>& cell_rows, Index nodes, Index cells);

  /// On the first rank, of the whole; elsewhere none.
  [[nodiscard]] const std::vector<Field>& fields() const { return fields_; }
  /// Takes the values that there are now. All ranks together.
  void gather();

 private:
  struct Rows {
    std::vector<Index> own;               ///< that this rank tells
    std::vector<std::vector<Index>> all;  ///< on the first: where those of each rank go
  };
  [[nodiscard]] Rows rows_of(const std::vector<Index>& own, const std::vector<Index>& places) const;
  [[nodiscard]] const Rows& rows_of(const Field& field) const {
    return field.place == FieldPlace::nodes ? nodes_ : cells_;
  }

  const Ranks& ranks_;
  std::vector<Field> own_, fields_;
  Rows nodes_, cells_;
  std::vector<std::vector<double>> reals_;
  std::vector<std::vector<int>> integers_;
};

}  // namespace ricochet
