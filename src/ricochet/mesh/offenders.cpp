#include "ricochet/mesh/offenders.hpp"

#include <fmt/format.h>

#include "ricochet/base/error.hpp"

namespace ricochet {

std::string Offenders::text(const std::string& singular) const {
  if (count_ == 1) return fmt::format("{} {}", singular, first_.front());
  const std::string more = count_ > std::int64_t(first_.size()) ? ", …" : "";
  return fmt::format("{} {}s ({}{})", count_, singular, fmt::join(first_, ", "), more);
}

void fail_mesh(const std::string& source, const std::string& message) {
  throw Error(ErrorKind::invalid_input, source + ": " + message);
}

}  // namespace ricochet
