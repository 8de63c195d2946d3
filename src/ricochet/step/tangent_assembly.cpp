#include "ricochet/step/tangent_assembly.hpp"

namespace ricochet {

void TangentAssembly::start(Index unknowns, Index dofs) {
  count_ = unknowns;
  known_.assign(std::size_t(dofs), 0.0);
  entries_.clear();
  right_.setZero(unknowns);
}

void TangentAssembly::add(const SparseMatrix& matrix, double factor, const Equations& rows, const Motions& columns) {
  for (Index column = 0; column < matrix.outerSize(); ++column) {
    const auto [unknown, weight] = columns[std::size_t(column)];
    if (weight == 0.0) continue;
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry) {
      const int row = rows[std::size_t(entry.row())];
      if (row < 0) continue;
      const double value = factor * weight * entry.value();
      if (unknown >= 0) {
        entries_.emplace_back(row, unknown, value);
      } else {
        right_[row] -= value * known_[std::size_t(column)];
      }
    }
  }
}

SparseRowMatrix TangentAssembly::assemble(Index rows, const Triplets& entries) const {
  SparseRowMatrix result(rows, count_);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// Rows of reactions as forces in all of these equations.
SparseRowMatrix TangentAssembly::forces_of(const SparseRowMatrix& rows,
                                           const std::vector<const Equations*>& equations) const {
  Triplets entries;
  for (Index row = 0; row < rows.rows(); ++row) {
    for (SparseRowMatrix::InnerIterator entry(rows, row); entry; ++entry) {
      for (const Equations* const of : equations) {
        const int equation = (*of)[std::size_t(entry.col())];
        if (equation >= 0) entries.emplace_back(int(row), equation, entry.value());
      }
    }
  }
  return assemble(rows.rows(), entries);
}

/// Derivatives by unknowns, from those by the motions of dofs; known motions are added to the offset.
SparseRowMatrix TangentAssembly::motions_of(const SparseRowMatrix& rows, const Motions& motions, Vector& offset) const {
  Triplets entries;
  for (Index row = 0; row < rows.rows(); ++row) {
    for (SparseRowMatrix::InnerIterator entry(rows, row); entry; ++entry) {
      const auto [unknown, weight] = motions[std::size_t(entry.col())];
      if (unknown >= 0) {
        entries.emplace_back(int(row), unknown, weight * entry.value());
      } else {
        offset[row] += weight * entry.value() * known_[std::size_t(entry.col())];
      }
    }
  }
  return assemble(rows.rows(), entries);
}

void TangentAssembly::add_contact(const ContactTangent& contact, const ContactConditions& conditions, double slip_time,
                                  const std::vector<const Equations*>& equations, const Motions& motions,
                                  ExactTangent& tangent) {
  for (const Equations* const of : equations) add(contact.force(), -1.0, *of, motions);
  tangent.gap = conditions.gap.offset;
  tangent.gap_rounding = conditions.gap.rounding;
  tangent.normal_force = forces_of(contact.normal_rows(), equations);
  tangent.normal_motion = motions_of(contact.gap(), motions, tangent.gap);
  const bool has_friction = conditions.slip.offset.size() > 0;
  const double scale = has_friction ? slip_time / conditions.slip.factor : 0.0;
  tangent.slip = scale * conditions.slip.offset;
  tangent.slip_rounding = scale * conditions.slip.rounding;
  tangent.tangential_force = forces_of(contact.tangential_rows(), equations);
  if (has_friction) tangent.tangential_motion = motions_of(contact.slip(), motions, tangent.slip);
}

void TangentAssembly::write(ExactTangent& tangent) const {
  tangent.matrix.resize(count_, count_);
  tangent.matrix.setFromTriplets(entries_.begin(), entries_.end());
  tangent.right_hand_side = right_;
}

}  // namespace ricochet
