#include "ricochet/base/checksum.hpp"

#include <fmt/format.h>
#include <zlib.h>

namespace ricochet {

Checksum& Checksum::add_bytes(const void* bytes, std::size_t size) {
  if (size > 0) value_ = std::uint32_t(crc32_z(value_, static_cast<const unsigned char*>(bytes), size));
  size_ += size;
  return *this;
}

std::string Checksum::text() const { return fmt::format("{:08x} of {} bytes", value_, size_); }

}  // namespace ricochet
