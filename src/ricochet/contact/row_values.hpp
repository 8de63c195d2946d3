#pragma once

#include "ricochet/contact/contact_rows.hpp"
#include "ricochet/contact/row_writer.hpp"

/// @file Values of the rows of contact points.
namespace ricochet {

/// Of all rows of G and B_T, whose pattern stays the same over a run.
[[nodiscard]] Index row_value_count(const ContactRows& rows);
[[nodiscard]] Vector row_values(const ContactRows& rows);
/// `values`: row_value_count() of them; false where the rows have them already.
bool take_row_values(const Vector& values, ContactRows& rows);

/// The largest change of a value of a point's rows, relative to the largest one of its G or B_T.
[[nodiscard]] double change_of_rows(const ContactRows& from, const ContactRows& to, Index point);
/// Copies points with their normals, tangents and slips. Rows may reach other dofs than those of `to` do: such rows are
/// written by `finish`.
class PointCopier {
 public:
  void copy(const ContactRows& from, ContactRows& to, Index point);
  void finish(ContactRows& to);

 private:
  void copy_rows(const SparseRowMatrix& from, SparseRowMatrix& to, Index first, Index last, RowWriter& writer);

  RowWriter gap_, slip_;
  RowWriter::Entries entries_;
  std::vector<char> changed_;
};

}  // namespace ricochet
