#include "ricochet/io/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/file_version.hpp"
#include "ricochet/base/input_file.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view magic = "RICOCHET";
constexpr std::uint32_t format = 14;
constexpr std::size_t retained_checkpoints = 2;
constexpr std::size_t head_size = magic.size() + sizeof(std::uint32_t) + sizeof(std::uint64_t);

std::uint32_t checksum(std::string_view text) { return Checksum().add(text.data(), text.size()).value(); }

template <class Number>
void put(std::string& text, Number number) {
  text.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

void put_text(std::string& text, const std::string& value) {
  put(text, std::uint32_t(value.size()));
  text += value;
}

template <class Number>
void put_numbers(std::string& text, const Number* values, std::size_t count) {
  put(text, std::uint64_t(count));
  text.append(reinterpret_cast<const char*>(values), count * sizeof(Number));
}

/// Reads consecutive entries; throws if the text ends before a requested one.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) {}

  [[nodiscard]] bool at_end() const { return text_.empty(); }
  [[nodiscard]] std::string_view bytes(std::size_t count) {
    if (count > text_.size()) throw Error(ErrorKind::invalid_input, "it ends in the middle of a value");
    const std::string_view result = text_.substr(0, count);
    text_.remove_prefix(count);
    return result;
  }
  template <class Number>
  [[nodiscard]] Number number() {
    Number result;
    std::memcpy(&result, bytes(sizeof(Number)).data(), sizeof(Number));
    return result;
  }
  [[nodiscard]] std::string text() { return std::string(bytes(number<std::uint32_t>())); }
  /// Reads a number of entries of at least so many bytes each.
  [[nodiscard]] std::size_t count(std::size_t entry_size) {
    const auto result = number<std::uint64_t>();
    if (result > text_.size() / entry_size) throw Error(ErrorKind::invalid_input, "a value is longer than the file");
    return std::size_t(result);
  }

 private:
  std::string_view text_;
};

template <class Values>
Values read_numbers(Cursor& cursor) {
  constexpr std::size_t size = sizeof(*Values().data());
  const std::size_t count = cursor.count(size);
  Values values;
  values.resize(static_cast<decltype(values.size())>(count));
  if (count > 0) std::memcpy(values.data(), cursor.bytes(count * size).data(), count * size);
  return values;
}

Snapshot::Value read_value(Cursor& cursor) {
  switch (cursor.number<std::uint8_t>()) {
    case 0:
      return read_numbers<Vector>(cursor);
    case 1:
      return read_numbers<Snapshot::Integers>(cursor);
    case 2: {
      Snapshot::Texts values(cursor.count(sizeof(std::uint32_t)));
      for (std::string& value : values) value = cursor.text();
      return values;
    }
    default:
      throw Error(ErrorKind::invalid_input, "a value has an unknown type");
  }
}

void put_value(std::string& text, const Snapshot::Value& value) {
  put(text, std::uint8_t(value.index()));
  if (const auto* reals = std::get_if<Vector>(&value)) {
    put_numbers(text, reals->data(), std::size_t(reals->size()));
  } else if (const auto* integers = std::get_if<Snapshot::Integers>(&value)) {
    put_numbers(text, integers->data(), integers->size());
  } else {
    const auto& texts = std::get<Snapshot::Texts>(value);
    put(text, std::uint64_t(texts.size()));
    for (const std::string& each : texts) put_text(text, each);
  }
}

}  // namespace

std::string encode_snapshot(const Snapshot& snapshot) {
  std::string body;
  for (const auto& [name, value] : snapshot.values()) {
    put_text(body, name);
    put_value(body, value);
  }
  std::string text(magic);
  put(text, format);
  put(text, std::uint64_t(body.size()));
  text += body;
  put(text, checksum(text));
  return text;
}

Snapshot decode_snapshot(const std::string& text) {
  if (!text.starts_with(magic)) throw Error(ErrorKind::invalid_input, "it is not a checkpoint");
  if (text.size() < head_size + sizeof(std::uint32_t)) throw Error(ErrorKind::invalid_input, "it is truncated");
  Cursor head(std::string_view(text).substr(magic.size()));
  if (const auto found = head.number<std::uint32_t>(); found != format) {
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("written by another version of Ricochet (format {}); this is Ricochet {}, which reads format "
                    "{}: repeat the run, or continue it with the version that wrote it",
                    found, version, format));
  }
  if (head.number<std::uint64_t>() != text.size() - head_size - sizeof(std::uint32_t))
    throw Error(ErrorKind::invalid_input, "its length is wrong: it is truncated, or something was appended");
  const std::string_view content = std::string_view(text).substr(0, text.size() - sizeof(std::uint32_t));
  if (Cursor(std::string_view(text).substr(content.size())).number<std::uint32_t>() != checksum(content))
    throw Error(ErrorKind::invalid_input, "its checksum is wrong");
  Snapshot snapshot;
  Cursor cursor(content.substr(head_size));
  while (!cursor.at_end()) {
    const std::string name = cursor.text();
    snapshot.set(name, read_value(cursor));
  }
  return snapshot;
}

std::vector<CheckpointFile> checkpoint_files(const std::string& directory) {
  std::vector<CheckpointFile> result;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, problem)) {
    const std::string name = entry.path().filename().string();
    const auto step = between(name, "checkpoint-", ".ckpt");
    if (step && is_digits(*step, 9, 15)) result.push_back({entry.path().string(), std::stol(std::string(*step))});
  }
  std::ranges::sort(result, [](const auto& a, const auto& b) { return a.step < b.step; });
  return result;
}

void write_checkpoint(const std::string& directory, long step, const Snapshot& snapshot) {
  write_durably((fs::path(directory) / fmt::format("checkpoint-{:09}.ckpt", step)).string(), encode_snapshot(snapshot));
  const std::vector<CheckpointFile> files = checkpoint_files(directory);
  for (std::size_t i = 0; i + retained_checkpoints < files.size(); ++i) {
    std::error_code problem;
    fs::remove(files[i].path, problem);
    if (problem) log::warning(fmt::format("{}: cannot be removed: {}", files[i].path, problem.message()));
  }
}

Snapshot read_checkpoint(const std::string& path) {
  {
    // Reading a pipe would wait for a writer forever.
    std::error_code problem;
    const fs::file_status status = fs::status(path, problem);
    if (fs::exists(status) && !fs::is_regular_file(status))
      throw Error(ErrorKind::invalid_input, fmt::format("{}: it is not a regular file", path));
    char head[magic.size()] = {};
    std::ifstream file(path, std::ios::binary);
    // Files that are not checkpoints are not read completely.
    if (unreadable_reason(path).empty() && file.read(head, sizeof(head)) &&
        std::string_view(head, sizeof(head)) != magic)
      throw Error(ErrorKind::invalid_input, fmt::format("{}: it is not a checkpoint", path));
  }
  const std::string text = read_file(path);
  Snapshot snapshot;
  try {
    snapshot = decode_snapshot(text);
  } catch (const Error& problem) {
    throw Error(problem.kind(), fmt::format("{}: {}", path, problem.what()));
  }
  require_readable_version(path, snapshot.has("identity.version") ? snapshot.text("identity.version") : "",
                           "repeat the run with --force, or continue it with the version that wrote it");
  return snapshot;
}

std::optional<Snapshot> newest_checkpoint(const std::string& directory) {
  std::vector<CheckpointFile> files = checkpoint_files(directory);
  std::ranges::reverse(files);
  for (const CheckpointFile& file : files) {
    try {
      return read_checkpoint(file.path);
    } catch (const VersionError&) {
      throw;  // an earlier one belongs to the same run
    } catch (const Error& problem) {
      log::warning(fmt::format("this checkpoint cannot be used{}: {}",
                               &file != &files.back() ? ", the previous one is used" : "", problem.what()));
    }
  }
  return std::nullopt;
}

}  // namespace ricochet
