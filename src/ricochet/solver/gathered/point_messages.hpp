#pragma once

#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "ricochet/solver/gathered/gathered_nodes.hpp"
#include "ricochet/step/stage_members.hpp"

/// @file Messages of the values of contact points, between the ranks and the root of their contact. Writer and reader
/// visit the lists of members of contact_members.hpp and stage_members.hpp. For each member that has values per point
/// or per tangent a message contains 1 and the values of its points, or 0 if the member is empty. Not part of the
/// public interface.
namespace ricochet {

template <class Number>
concept Sendable = std::is_arithmetic_v<Number> || std::is_enum_v<Number>;

/// Reads numbers one after the other.
class NumberReader {
 public:
  explicit NumberReader(const std::vector<double>& numbers) : at_(numbers.data()) {}
  double next() { return *at_++; }
  Index integer() { return Index(next()); }

 private:
  const double* at_;
};

/// Selects the members that are sent, and numbers their items.
class PointMembers {
 public:
  explicit PointMembers(Index dimension) : d_(dimension) {}

 protected:
  [[nodiscard]] static bool are_sent(ContactAxes axes) {
    return axes.along == ContactAxis::point || axes.along == ContactAxis::tangent;
  }
  [[nodiscard]] Index per_point(ContactAxes axes) const { return axes.along == ContactAxis::tangent ? d_ - 1 : 1; }
  [[nodiscard]] Index per_node(ContactAxes axes) const { return axes.of == ContactAxis::dof ? d_ : 1; }
  /// Calls visit(item) for the items of these points.
  template <class Visit>
  void visit_items(ContactAxes axes, const std::vector<Index>& points, const Visit& visit) const {
    const Index count = per_point(axes);
    for (const Index point : points) {
      for (Index item = point * count; item < (point + 1) * count; ++item) visit(item);
    }
  }

  Index d_;
};

class PointWriter : private PointMembers {
 public:
  /// Appends to the message. Keeps references to all arguments.
  PointWriter(const Ranks& ranks, Index dimension, const std::vector<Index>& points, std::vector<double>& message)
      : PointMembers(dimension), ranks_(ranks), points_(points), message_(message) {}

  template <class... Members>
  void operator()(ContactAxes axes, const Members&... members) {
    if (are_sent(axes)) (write(axes, members), ...);
  }

 private:
  template <class Values>
  void write(ContactAxes axes, const Values& values) {
    if constexpr (requires { append(axes, values, Index{}); }) {
      message_.push_back(values.size() > 0 ? 1.0 : 0.0);
      if (values.size() > 0) visit_items(axes, points_, [&](Index item) { append(axes, values, item); });
    } else {
      throw std::logic_error("a member of contact points is not sent");
    }
  }
  /// Rows at the root have constant columns: none has a rotating trace.
  void write(ContactAxes, const std::shared_ptr<const SparseRowMatrix>&) {}

  void append(ContactAxes, const Vector& values, Index item) { message_.push_back(values[item]); }
  template <Sendable Number>
  void append(ContactAxes, const std::vector<Number>& values, Index item) {
    message_.push_back(double(values[std::size_t(item)]));
  }
  void append(ContactAxes, const Points& values, Index item) {
    for (Index k = 0; k < values.rows(); ++k) message_.push_back(values(k, item));
  }
  void append(ContactAxes, const std::vector<Points>& values, Index item) {
    const Points& own = values[std::size_t(item)];
    message_.insert(message_.end(), own.data(), own.data() + own.size());
  }
  /// Appends the number of entries, and column in the whole body and value of each.
  void append(ContactAxes axes, const SparseRowMatrix& matrix, Index row) {
    const Index d = per_node(axes);
    message_.push_back(double(matrix.outerIndexPtr()[row + 1] - matrix.outerIndexPtr()[row]));
    for (SparseRowMatrix::InnerIterator entry(matrix, row); entry; ++entry) {
      message_.push_back(double(ranks_.number_of(entry.col() / d) * d + entry.col() % d));
      message_.push_back(entry.value());
    }
  }

  const Ranks& ranks_;
  const std::vector<Index>& points_;
  std::vector<double>& message_;
};

class PointReader : private PointMembers {
 public:
  /// Message and the points to which its values belong.
  struct Part {
    NumberReader numbers;
    std::vector<Index> points;
  };
  /// Reads members of so many points from messages. The values of other points are kept, or zero if `keeps` is false or
  /// if the member was empty. Columns of sparse matrices are numbered by `nodes`.
  PointReader(Index dimension, Index point_count, const GatheredNodes& nodes, bool keeps, std::vector<Part> parts)
      : PointMembers(dimension), count_(point_count), nodes_(nodes), keeps_(keeps), parts_(std::move(parts)) {}

  template <class... Members>
  void operator()(ContactAxes axes, Members&... members) {
    if (are_sent(axes)) (read(axes, members), ...);
  }

 private:
  template <class Values>
  void read(ContactAxes axes, Values& values) {
    if constexpr (requires { clear(values, Index{}); }) {
      const auto has = read_flags();
      const Index size = std::ranges::find(has, 1) != has.end() ? count_ * per_point(axes) : 0;
      if (!keeps_ || values.size() == 0) clear(values, size);
      visit_parts(axes, has, [&](NumberReader& numbers, Index item) { enter(numbers, values, item); });
    } else {
      throw std::logic_error("a member of contact points is not sent");
    }
  }
  void read(ContactAxes, std::shared_ptr<const SparseRowMatrix>&) {}
  void read(ContactAxes axes, SparseRowMatrix& matrix) {
    std::vector<char> is_new(static_cast<std::size_t>(count_ * per_point(axes)), 0);
    std::vector<Eigen::Triplet<double>> entries;
    const Index d = per_node(axes);
    visit_parts(axes, read_flags(), [&](NumberReader& numbers, Index row) {
      is_new[std::size_t(row)] = 1;
      for (Index count = numbers.integer(); count > 0; --count) {
        const Index column = numbers.integer();
        entries.emplace_back(int(row), int(nodes_.index_of(column / d) * d + column % d), numbers.next());
      }
    });
    for (Index row = 0; keeps_ && row < matrix.rows(); ++row) {
      if (is_new[std::size_t(row)] != 0) continue;
      for (SparseRowMatrix::InnerIterator entry(matrix, row); entry; ++entry)
        entries.emplace_back(int(row), int(entry.col()), entry.value());
    }
    matrix = SparseRowMatrix(count_ * per_point(axes), nodes_.count() * d);
    matrix.setFromTriplets(entries.begin(), entries.end());
  }

  [[nodiscard]] std::vector<char> read_flags() {
    std::vector<char> result;
    for (Part& part : parts_) result.push_back(part.numbers.next() != 0.0 ? 1 : 0);
    return result;
  }
  /// Calls visit(numbers, item) for the items of the parts that have the member.
  template <class Visit>
  void visit_parts(ContactAxes axes, const std::vector<char>& has, const Visit& visit) {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (has[i] != 0) visit_items(axes, parts_[i].points, [&](Index item) { visit(parts_[i].numbers, item); });
    }
  }

  static void clear(Vector& values, Index size) { values.setZero(size); }
  void clear(Points& values, Index size) const { values.setZero(d_, size); }
  void clear(std::vector<Points>& values, Index size) const {
    values.assign(std::size_t(size), Points::Zero(d_, d_ - 1));
  }
  template <Sendable Number>
  static void clear(std::vector<Number>& values, Index size) {
    values.assign(std::size_t(size), Number{});
  }
  static void enter(NumberReader& numbers, Vector& values, Index item) { values[item] = numbers.next(); }
  static void enter(NumberReader& numbers, Points& values, Index item) {
    for (Index k = 0; k < values.rows(); ++k) values(k, item) = numbers.next();
  }
  static void enter(NumberReader& numbers, std::vector<Points>& values, Index item) {
    for (double& value : values[std::size_t(item)].reshaped()) value = numbers.next();
  }
  template <Sendable Number>
  static void enter(NumberReader& numbers, std::vector<Number>& values, Index item) {
    values[std::size_t(item)] = static_cast<Number>(numbers.next());
  }

  Index count_;
  const GatheredNodes& nodes_;
  bool keeps_;
  std::vector<Part> parts_;
};

}  // namespace ricochet
