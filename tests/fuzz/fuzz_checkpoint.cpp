#include <cstdint>
#include <cstring>
#include <string>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/io/checkpoint.hpp"

/// @file Any bytes as a checkpoint yield values that can be written and read again, or an error of the library. No
/// fuzzer guesses a checksum: the bytes are also used as the values of a file with correct length and checksum.

namespace {

using ricochet::Snapshot;

void try_file(const std::string& text) {
  try {
    const std::string again = ricochet::encode_snapshot(ricochet::decode_snapshot(text));
    // Duplicate or unordered names are corrected.
    if (ricochet::encode_snapshot(ricochet::decode_snapshot(again)) != again) __builtin_trap();
    if (again.size() > text.size()) __builtin_trap();
  } catch (const ricochet::Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
}

std::string file_of_values(const std::string& values) {
  // A file without values: the head (magic, format, length), and the checksum.
  std::string file = ricochet::encode_snapshot(Snapshot());
  file.resize(file.size() - sizeof(std::uint32_t));
  const std::uint64_t length = values.size();
  std::memcpy(file.data() + file.size() - sizeof(length), &length, sizeof(length));
  file += values;
  const std::uint32_t checksum = ricochet::Checksum().add(file.data(), file.size()).value();
  return file.append(reinterpret_cast<const char*>(&checksum), sizeof(checksum));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try_file(text);
  try_file(file_of_values(text));
  // The seeds are whole files: their values are mutated as well.
  constexpr std::size_t head = 20, tail = sizeof(std::uint32_t);
  if (size >= head + tail) try_file(file_of_values(text.substr(head, size - head - tail)));
  return 0;
}
