#include "ricochet/base/snapshot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"

namespace ricochet {

void Snapshot::refuse(const std::string& name, const std::string& why) {
  throw Error(ErrorKind::invalid_input, fmt::format("the saved state does not fit: {} {}", name, why));
}

template <class Kind>
const Kind& Snapshot::find(const std::string& name, const char* kind) const {
  const auto found = values_.find(name);
  if (found == values_.end()) refuse(name, "is missing");
  const Kind* const value = std::get_if<Kind>(&found->second);
  if (value == nullptr) refuse(name, fmt::format("does not hold {}", kind));
  return *value;
}

const Vector& Snapshot::reals(const std::string& name) const { return find<Vector>(name, "numbers"); }

const Vector& Snapshot::reals(const std::string& name, Index size, Index other_size) const {
  const Vector& values = reals(name);
  if (values.size() != size && values.size() != other_size)
    refuse(name, fmt::format("has {} numbers where {} are expected", values.size(), size));
  return values;
}

const Snapshot::Integers& Snapshot::integers(const std::string& name) const { return find<Integers>(name, "integers"); }

const Snapshot::Integers& Snapshot::integers(const std::string& name, std::int64_t least, std::int64_t most) const {
  const Integers& values = integers(name);
  const auto bad = std::ranges::find_if(values, [&](std::int64_t v) { return v < least || v > most; });
  if (bad != values.end()) refuse(name, fmt::format("has {}, which is not from {} to {}", *bad, least, most));
  return values;
}

std::int64_t Snapshot::integer(const std::string& name) const {
  const Integers& values = integers(name);
  if (values.size() != 1) refuse(name, fmt::format("has {} numbers where one is expected", values.size()));
  return values.front();
}

const Snapshot::Texts& Snapshot::texts(const std::string& name) const { return find<Texts>(name, "texts"); }

const std::string& Snapshot::text(const std::string& name) const {
  const Texts& values = texts(name);
  if (values.size() != 1) refuse(name, fmt::format("has {} texts where one is expected", values.size()));
  return values.front();
}

void NumberVisitor::visit(double& value) {
  if (!reads_) return written_.push_back(value);
  value = read_.front();
  read_ = read_.subspan(1);
}

/// 2⁶³, the limit of a type as a double, is no int64.
double NumberVisitor::whole(double number, double least, double most) const {
  if (number != std::floor(number) || !(number >= least && number <= most) || std::abs(number) >= 0x1p63)
    Snapshot::refuse(name_, fmt::format("has {}, which is no whole number of its range", number));
  return number;
}

SnapshotVisitor Snapshot::saver(const std::string& name) { return {this, nullptr, name}; }

SnapshotVisitor Snapshot::loader(const std::string& name) const { return {nullptr, this, name}; }

std::string SnapshotVisitor::name_of(const std::string& key) const {
  return name_.empty() || key.empty() ? name_ + key : name_ + "." + key;
}

void SnapshotVisitor::operator()(const std::string& key, std::string& value) const {
  if (!loads()) return to_->save(name_of(key), value);
  value = from_->text(name_of(key));
}

void SnapshotVisitor::operator()(const std::string& key, Snapshot::Texts& values) const {
  if (!loads()) return to_->save(name_of(key), values);
  values = from_->texts(name_of(key));
}

void SnapshotVisitor::operator()(const std::string& key, Vector& values) const {
  if (!loads()) return to_->save(name_of(key), values);
  values = from_->reals(name_of(key));
}

void SnapshotVisitor::operator()(const std::string& key, Vector& values, Index size, Index other_size) const {
  if (!loads()) return to_->save(name_of(key), values);
  values = from_->reals(name_of(key), size, other_size);
}

void SnapshotVisitor::operator()(const std::string& key, Points& values, Index rows, Index columns,
                                 Index other_columns) const {
  Vector numbers = values.reshaped();
  (*this)(key, numbers, rows * columns, rows * other_columns);
  if (loads()) values = numbers.reshaped(rows, numbers.size() / rows);
}

void SnapshotVisitor::exchange(const std::string& key, Snapshot::Integers& values, IntegerRange range,
                               Index size) const {
  if (!loads()) return to_->save(name_of(key), values);
  values = from_->integers(name_of(key), range.least, range.most);
  require(size < 0 || Index(values.size()) == size, key,
          fmt::format("has {} numbers where {} are expected", values.size(), size));
}

std::size_t SnapshotVisitor::count_of_records(const std::string& key, Index width, std::size_t most) const {
  const Index size = from_->reals(name_of(key)).size();
  require(width > 0 && size % width == 0, key,
          fmt::format("has {} numbers where a multiple of {} is expected", size, width));
  const auto count = std::size_t(size / width);
  require(count <= most, key, fmt::format("has {} records where at most {} are possible", count, most));
  return count;
}

}  // namespace ricochet
