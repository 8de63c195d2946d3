#include "ricochet/io/line_checksums.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include "ricochet/base/error.hpp"
#include "ricochet/io/durable_file.hpp"

namespace ricochet {

namespace {

constexpr std::size_t most_blocks = 512;
constexpr const char* file_suffix = ".lines.file";

[[noreturn]] void refuse(const std::string& path, const std::string& lines, bool windows) {
  throw Error(
      ErrorKind::file_access,
      fmt::format("{}: {} from the data written before the checkpoint{}; restore the file, or start anew with --force",
                  path, lines, windows ? ": carriage returns were added, as editors do" : ""));
}

}  // namespace

LineChecksums::LineChecksums() { blocks_.reserve(most_blocks); }

void LineChecksums::persist(const SnapshotVisitor& visit, std::string file_name) {
  const SnapshotVisitor lines = visit.part("lines");
  Snapshot::Integers sums, lengths;
  for (const Block& block : blocks_) {
    sums.push_back(block.sum);
    lengths.push_back(block.length);
  }
  lines("file", file_name);
  lines("sums", sums, {0, 0xffffffff});
  lines("lengths", lengths, {0, std::int64_t{1} << 50}, Index(sums.size()));
  lines("pieces", pieces_);
  lines("per_block", pieces_per_block_);
  if (!visit.loads()) return;
  const auto count = std::int64_t(sums.size());
  lines.require(sums.size() <= most_blocks && pieces_per_block_ >= 1 && pieces_ <= count * pieces_per_block_ &&
                    pieces_ > (count - 1) * pieces_per_block_,
                "sums", "do not belong to so many lines");
  blocks_.clear();
  length_ = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    blocks_.push_back({std::uint32_t(sums[i]), lengths[i]});
    length_ += lengths[i];
  }
}

void LineChecksums::add(std::string_view piece) {
  if (pieces_ == std::int64_t(blocks_.size()) * pieces_per_block_) {
    if (blocks_.size() == most_blocks) merge_blocks();
    if (pieces_ == std::int64_t(blocks_.size()) * pieces_per_block_) blocks_.emplace_back();
  }
  Block& block = blocks_.back();
  const auto* const bytes = reinterpret_cast<const unsigned char*>(piece.data());
  block.sum = std::uint32_t(crc32_z(block.sum, bytes, piece.size()));
  block.length += std::int64_t(piece.size());
  length_ += std::int64_t(piece.size());
  ++pieces_;
}

/// Merges pairs of blocks once all are full.
void LineChecksums::merge_blocks() {
  for (std::size_t i = 0; i < most_blocks / 2; ++i) {
    const Block first = blocks_[2 * i], second = blocks_[2 * i + 1];
    blocks_[i] = {std::uint32_t(crc32_combine(first.sum, second.sum, second.length)), first.length + second.length};
  }
  blocks_.resize(most_blocks / 2);
  pieces_per_block_ *= 2;
}

void LineChecksums::require_same(const std::string& path) const {
  require_length(path, length_);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw_file_error(path, "read", errno);
  std::string block;
  std::int64_t line = 1;
  for (const Block& expected : blocks_) {
    block.resize(std::size_t(expected.length));
    if (!file.read(block.data(), expected.length)) throw_file_error(path, "read", errno);
    const std::int64_t last = std::max(line, line + std::ranges::count(block, '\n') - 1);
    if (Checksum().add(block.data(), block.size()).value() != expected.sum) {
      refuse(path,
             line == last ? fmt::format("line {} differs", line)
                          : fmt::format("something in lines {} to {} differs", line, last),
             block.find('\r') != std::string::npos);
    }
    line = last + 1;
  }
}

void require_same_files(const std::string& directory, const Snapshot& snapshot) {
  for (const auto& [key, value] : snapshot.values()) {
    if (!key.ends_with(file_suffix)) continue;
    const std::string name = key.substr(0, key.size() - std::string_view(file_suffix).size());
    LineChecksums(snapshot.loader(name)).require_same((std::filesystem::path(directory) / snapshot.text(key)).string());
  }
}

}  // namespace ricochet
