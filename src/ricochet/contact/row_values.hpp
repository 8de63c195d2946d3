#pragma once

#include "ricochet/contact/contact_rows.hpp"
#include "ricochet/contact/row_writer.hpp"

/// @file Values of the rows of contact points.
namespace ricochet {

/// All values of G and B_T, whose pattern must be constant over a run.
[[nodiscard]] Index row_value_count(const ContactRows& rows);
[[nodiscard]] Vector row_values(const ContactRows& rows);
/// Sets row_value_count() values; returns false if the rows already have them.
bool set_row_values(const Vector& values, ContactRows& rows);

/// Largest change of a value in a point's rows, relative to the largest value of its G or B_T.
[[nodiscard]] double change_of_rows(const ContactRows& from, const ContactRows& to, Index point);
/// Copies points with their normals, tangents and slips. Rows with other dofs than those of
/// `to` are written by `finish`.
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
