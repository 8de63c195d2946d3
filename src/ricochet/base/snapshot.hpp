#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Named numbers and texts: the state of a run, from which it can continue later with the same bits.
///
/// Every part that keeps state from step to step lists it once, in a function that saves it and loads it:
///
///   void Watch::persist(const SnapshotVisitor& visit) {
///     visit("limit", limit_);                      // an entry: its name is that of the part and this key
///     visit("points", points_, {0, size_ - 1});    // each number that is loaded must be within these limits
///     visit("forces", forces_, size_);             // the loaded vector must have this size
///     inner_.persist(visit.part("inner"));
///     if (visit.loads()) find_largest();           // follows from the rest
///   }
///
/// Names are paths ("solver.0.candidates"). Everything that is constant during a run is computed again from the case.
/// See io/checkpoint.hpp for the file.
namespace ricochet {

class SnapshotVisitor;

class Snapshot {
 public:
  using Integers = std::vector<std::int64_t>;
  using Texts = std::vector<std::string>;
  using Value = std::variant<Vector, Integers, Texts>;

  void save(const std::string& name, const Vector& values) { values_[name] = values; }
  void save(const std::string& name, double value) { values_[name] = Vector(Vector::Constant(1, value)); }
  void save(const std::string& name, Integers values) { values_[name] = std::move(values); }
  void save(const std::string& name, std::int64_t value) { values_[name] = Integers{value}; }
  void save(const std::string& name, Texts values) { values_[name] = std::move(values); }
  void save(const std::string& name, const std::string& value) { values_[name] = Texts{value}; }

  /// Visitors that save the state of a part under a name, and load it.
  [[nodiscard]] SnapshotVisitor saver(const std::string& name);
  [[nodiscard]] SnapshotVisitor loader(const std::string& name) const;

  [[nodiscard]] bool has(const std::string& name) const { return values_.contains(name); }
  /// All of these throw Error(invalid_input) if the entry is missing or of another type or size.
  [[nodiscard]] const Vector& reals(const std::string& name) const;
  /// Requires one of these two sizes.
  [[nodiscard]] const Vector& reals(const std::string& name, Index size, Index other_size = -1) const;
  [[nodiscard]] double real(const std::string& name) const { return reals(name, 1)[0]; }
  [[nodiscard]] const Integers& integers(const std::string& name) const;
  /// Requires each value to be from `least` to `most`.
  [[nodiscard]] const Integers& integers(const std::string& name, std::int64_t least, std::int64_t most) const;
  [[nodiscard]] std::int64_t integer(const std::string& name) const;
  [[nodiscard]] const Texts& texts(const std::string& name) const;
  [[nodiscard]] const std::string& text(const std::string& name) const;

  /// All values, in the order of their names.
  [[nodiscard]] const std::map<std::string, Value>& values() const { return values_; }
  void set(const std::string& name, Value value) { values_[name] = std::move(value); }

  /// Throws Error(invalid_input), "the saved state does not fit: NAME WHY", for parts that check more.
  [[noreturn]] static void refuse(const std::string& name, const std::string& why);

 private:
  template <class Kind>
  [[nodiscard]] const Kind& find(const std::string& name, const char* kind) const;

  std::map<std::string, Value> values_;
};

/// Visits numbers that form one entry: writes them, or reads them in the same order.
class NumberVisitor {
 public:
  /// Creates a visitor that writes.
  NumberVisitor() = default;
  /// Creates a visitor that reads these numbers of an entry.
  NumberVisitor(const Vector& numbers, std::string name)
      : read_(numbers.data(), std::size_t(numbers.size())), name_(std::move(name)), reads_(true) {}

  /// Visits a number, the numbers of a vector or an array, or those of a record, which lists them in members(). Throws
  /// Error(invalid_input) if an integer or a flag is read from a number that is no whole number of its range.
  template <class Value>
  void operator()(Value& value) {
    if constexpr (std::is_floating_point_v<Value>) {
      visit(value);
    } else if constexpr (std::is_arithmetic_v<Value>) {
      auto number = double(value);
      visit(number);
      using Limits = std::numeric_limits<Value>;
      if (reads_) value = static_cast<Value>(whole(number, double(Limits::lowest()), double(Limits::max())));
    } else if constexpr (requires { value.data(); }) {
      for (auto& each : std::span(value.data(), std::size_t(value.size()))) (*this)(each);
    } else {
      std::apply([this](auto&... members) { ((*this)(members), ...); }, value.members());
    }
  }
  [[nodiscard]] const std::vector<double>& written() const { return written_; }

 private:
  void visit(double& value);
  [[nodiscard]] double whole(double number, double least, double most) const;

  std::vector<double> written_;
  std::span<const double> read_;
  std::string name_;
  bool reads_ = false;
};

template <class Value>
concept WholeNumber = std::integral<Value> || std::is_enum_v<Value>;

/// Values that an integer may have, besides those of its type. An enumeration needs its range: any number of its
/// underlying type would pass otherwise.
struct IntegerRange {
  std::int64_t least = std::numeric_limits<std::int64_t>::min(), most = std::numeric_limits<std::int64_t>::max();
};

/// Saves each entry of a part, or loads it. Loading throws Error(invalid_input) if an entry is missing, or of another
/// type, size or range than stated. The visitor itself stays as it is: it refers to a snapshot, which saving changes.
class SnapshotVisitor {
 public:
  [[nodiscard]] bool loads() const { return from_ != nullptr; }
  /// Visitor of a part of this part.
  [[nodiscard]] SnapshotVisitor part(const std::string& key) const { return {to_, from_, name_of(key)}; }
  [[nodiscard]] SnapshotVisitor part(std::size_t number) const { return part(std::to_string(number)); }
  /// Refuses an entry that is loaded unless it fits: "the saved state does not fit: NAME WHY".
  void require(bool fits, const std::string& key, const std::string& why) const {
    if (loads() && !fits) Snapshot::refuse(name_of(key), why);
  }

  void operator()(const std::string& key, double& value) const { numbers(key, value); }
  void operator()(const std::string& key, std::string& value) const;
  void operator()(const std::string& key, Snapshot::Texts& values) const;
  void operator()(const std::string& key, Vector& values) const;
  /// Requires one of these two sizes.
  void operator()(const std::string& key, Vector& values, Index size, Index other_size = -1) const;
  /// Visits a matrix of so many rows, column by column. Requires one of these two numbers of columns.
  void operator()(const std::string& key, Points& values, Index rows, Index columns, Index other_columns) const;
  template <WholeNumber Whole>
  void operator()(const std::string& key, Whole& value, IntegerRange range = {}) const {
    integers(key, range, value);
  }
  template <WholeNumber Whole>
  void operator()(const std::string& key, std::vector<Whole>& values, IntegerRange range = {}, Index size = -1) const {
    Snapshot::Integers integers(values.size());
    std::transform(values.begin(), values.end(), integers.begin(), [](Whole value) { return std::int64_t(value); });
    exchange(key, integers, range, size);
    values.resize(integers.size());
    for (std::size_t i = 0; i < values.size(); ++i) assign(key, integers[i], values[i]);
  }

  /// Visits several integers as one entry.
  template <WholeNumber... Wholes>
  void integers(const std::string& key, IntegerRange range, Wholes&... values) const {
    Snapshot::Integers integers{std::int64_t(values)...};
    exchange(key, integers, range, Index(integers.size()));
    auto next = integers.begin();
    (assign(key, *next++, values), ...);
  }
  /// Visits several numbers, vectors or records (or vectors of these) as one entry, which is returned. Requires the
  /// present sizes.
  template <class... Values>
  Vector numbers(const std::string& key, Values&... values) const {
    NumberVisitor writes;
    (writes(values), ...);
    Vector all = Eigen::Map<const Vector>(writes.written().data(), Index(writes.written().size()));
    (*this)(key, all, all.size());
    if (loads()) {
      NumberVisitor reads(all, name_of(key));
      (reads(values), ...);
    }
    return all;
  }
  /// Visits any number of records, up to `most`, as one entry. `one` is a prototype of a record, with the sizes of its
  /// vectors.
  template <class Record>
  void list(const std::string& key, std::vector<Record>& records, std::size_t most = 1U << 31U,
            Record one = Record{}) const {
    if (loads()) {
      NumberVisitor writes;
      writes(one);
      records.assign(count_of_records(key, Index(writes.written().size()), most), one);
    }
    numbers(key, records);
  }

 private:
  friend class Snapshot;
  SnapshotVisitor(Snapshot* to, const Snapshot* from, std::string name)
      : to_(to), from_(from), name_(std::move(name)) {}

  /// Name of an entry; the key "" is the part itself.
  [[nodiscard]] std::string name_of(const std::string& key) const;
  void exchange(const std::string& key, Snapshot::Integers& values, IntegerRange range, Index size) const;
  [[nodiscard]] std::size_t count_of_records(const std::string& key, Index width, std::size_t most) const;
  template <class Whole>
  void assign(const std::string& key, std::int64_t from, Whole& to) const {
    to = static_cast<Whole>(from);
    if (std::int64_t(to) != from) require(false, key, "has " + std::to_string(from) + ", out of range");
  }

  Snapshot* to_;
  const Snapshot* from_;
  std::string name_;
};

}  // namespace ricochet
