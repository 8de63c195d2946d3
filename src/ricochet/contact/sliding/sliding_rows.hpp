#pragma once

#include <vector>

#include "ricochet/contact/contact_rows.hpp"
#include "ricochet/contact/row_writer.hpp"
#include "ricochet/contact/sliding/sliding_pair.hpp"

/// @file Rows of points that slide far, from their views.
namespace ricochet {

class SlidingRows {
 public:
  /// `nodes`: reference positions of all nodes, d × count; kept by reference.
  explicit SlidingRows(const Points& nodes);

  /// Begins the rows of the step between two displacements, or, if `start` is null, those of an instant.
  void begin(const Vector& displacement, const Vector* start);
  /// Middle of both displacements, or the displacement of the instant.
  [[nodiscard]] const Vector& middle() const { return middle_; }
  /// Displacement increment of the step.
  [[nodiscard]] const Vector& step() const { return step_; }

  /// Corrects the row so that its product with the step is between `least` and `most`: both are the change of the gap
  /// if that is known and smooth. A product that is too large could create energy and is always corrected; one that is
  /// too small dissipates energy, and is corrected up to a fraction of the row. Deviations below a fraction of
  /// `rounding` are ignored.
  void correct(SlidingView& view, double least, double most, double rounding);
  /// Writes the row of a point that faces something.
  void write(const SlidingPair::Point& point, const SlidingView& view, ContactRows& rows);
  /// Writes the row of a point that is far from contact, or faces nothing: that of a plane perpendicular to its normal.
  void write_plane(const SlidingPair::Point& point, const SlidingVector& normal, ContactRows& rows);
  /// Writes all rows; those that differ from before receive the next revision.
  void finish(ContactRows& rows);

 private:
  void set_directions(const SlidingPair::Point& point, const SlidingVector& direction, ContactRows& rows) const;
  void write_slips(Index point, const ContactRows& rows);
  [[nodiscard]] Index dimension() const { return nodes_.rows(); }

  const Points& nodes_;
  double extent_;
  Vector middle_, step_;
  RowWriter gap_writer_, slip_writer_;
  RowWriter::Entries entries_, trace_;
  std::vector<char> changed_, slip_changed_;
  std::vector<SlidingVector> positions_, motions_;
  long revision_ = 0;  ///< number of the last update; different rows never share it
};

}  // namespace ricochet
