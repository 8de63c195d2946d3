#include "ricochet/base/snapshot.hpp"

#include <fmt/format.h>

#include <algorithm>

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

void Snapshot::save(const std::string& name, const std::vector<ContactStatus>& values) {
  Integers numbers;
  numbers.reserve(values.size());
  for (const ContactStatus status : values) numbers.push_back(static_cast<std::int64_t>(status));
  save(name, std::move(numbers));
}

const Vector& Snapshot::reals(const std::string& name) const {
  return find<Vector>(name, "numbers");
}

const Vector& Snapshot::reals(const std::string& name, Index size, Index other_size) const {
  const Vector& values = reals(name);
  if (values.size() != size && values.size() != other_size)
    refuse(name, fmt::format("has {} numbers where {} are expected", values.size(), size));
  return values;
}

const Snapshot::Integers& Snapshot::integers(const std::string& name) const {
  return find<Integers>(name, "integers");
}

const Snapshot::Integers& Snapshot::integers(const std::string& name, std::int64_t least, std::int64_t most) const {
  const Integers& values = integers(name);
  const auto bad = std::find_if(values.begin(), values.end(), [&](std::int64_t v) { return v < least || v > most; });
  if (bad != values.end()) refuse(name, fmt::format("has {}, which is not from {} to {}", *bad, least, most));
  return values;
}

std::int64_t Snapshot::integer(const std::string& name) const {
  const Integers& values = integers(name);
  if (values.size() != 1) refuse(name, fmt::format("has {} numbers where one is expected", values.size()));
  return values.front();
}

std::vector<ContactStatus> Snapshot::statuses(const std::string& name, Index size) const {
  const Integers& values = integers(name, 0, static_cast<std::int64_t>(ContactStatus::slip));
  if (static_cast<Index>(values.size()) != size)
    refuse(name, fmt::format("has {} numbers where {} are expected", values.size(), size));
  std::vector<ContactStatus> result;
  result.reserve(values.size());
  for (const std::int64_t value : values) result.push_back(static_cast<ContactStatus>(value));
  return result;
}

const Snapshot::Texts& Snapshot::texts(const std::string& name) const {
  return find<Texts>(name, "texts");
}

const std::string& Snapshot::text(const std::string& name) const {
  const Texts& values = texts(name);
  if (values.size() != 1) refuse(name, fmt::format("has {} texts where one is expected", values.size()));
  return values.front();
}

}  // namespace ricochet
