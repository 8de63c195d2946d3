#pragma once

#include <optional>
#include <vector>

#include "ricochet/contact/contact_rows.hpp"
#include "ricochet/contact/row_writer.hpp"
#include "ricochet/contact/sliding/sliding_pair.hpp"

/// @file The rows of points that slide far, from what they see.
namespace ricochet {

class SlidingRows {
 public:
  /// `nodes`: reference positions of all nodes, d × count; kept by reference.
  explicit SlidingRows(const Points& nodes);

  /// Rows of the step between two displacements, or where `start` is null those of an instant, come from now on.
  void begin(const Vector& displacement, const Vector* start);
  /// Half way between both, or the instant.
  [[nodiscard]] const Vector& middle() const { return middle_; }
  /// The displacement over the step.
  [[nodiscard]] const Vector& step() const { return step_; }

  /// Makes the row's product with the step the change of the gap; where none is known, no positive one. A product that
  /// is too large could give energy and is mended in any case; one that is too small takes some, and is, up to a part
  /// of the row. What is less than a part of `rounding` stays.
  void correct(SlidingView& view, std::optional<double> change, double rounding);
  /// The row of a point that sees something.
  void write(const SlidingPair::Point& point, const SlidingView& view, ContactRows& rows);
  /// That of a point that is far from touching, or faces nothing: of a plane across its normal.
  void write_plane(const SlidingPair::Point& point, const SlidingVector& normal, ContactRows& rows);
  /// Writes all of them; rows that are others than before get the next revision.
  void finish(ContactRows& rows);

 private:
  void take_directions(const SlidingPair::Point& point, const SlidingVector& direction, ContactRows& rows) const;
  void write_slips(Index point, const ContactRows& rows);
  [[nodiscard]] Index dimension() const { return nodes_.rows(); }

  const Points& nodes_;
  double extent_;
  Vector middle_, step_;
  RowWriter gap_writer_, slip_writer_;
  RowWriter::Entries entries_, trace_;
  std::vector<char> changed_, slip_changed_;
  std::vector<SlidingVector> places_, motions_;
  long revision_ = 0;  ///< of the last update: no two rows that differ have the same
};

}  // namespace ricochet
