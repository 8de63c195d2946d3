#pragma once

#include "ricochet/contact/contact_rows.hpp"

/// @file Values of the rows of contact points, whose pattern stays the same over a run.
namespace ricochet {

/// Of all rows of G and B_T.
[[nodiscard]] Index row_value_count(const ContactRows& rows);
[[nodiscard]] Vector row_values(const ContactRows& rows);
/// `values`: row_value_count() of them; false where the rows have them already.
bool take_row_values(const Vector& values, ContactRows& rows);

/// The largest change of a value of a point's rows, relative to the largest one of its G or B_T.
[[nodiscard]] double change_of_rows(const ContactRows& from, const ContactRows& to, Index point);
/// With normal, tangents and slips.
void copy_point(const ContactRows& from, ContactRows& to, Index point);

}  // namespace ricochet
