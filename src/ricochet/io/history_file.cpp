#include "ricochet/io/history_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <iterator>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/io/durable_file.hpp"

namespace ricochet {

/// Bytes that are written at once.
constexpr std::size_t piece = 8192;

HistoryWriter::HistoryWriter(const std::string& path, const std::vector<std::string>& columns,
                             const std::optional<SnapshotVisitor>& saved)
    : path_(path) {
  if (saved) {
    checksums_ = LineChecksums(*saved);
    truncate_file(path_, checksums_.length());
  } else {
    std::ofstream(path_, std::ios::binary | std::ios::trunc).close();
  }
  errno = 0;
  // In append mode no hole is left if the file is truncated between check and write.
  file_.open(path_, std::ios::binary | std::ios::app);
  if (!file_) throw_file_error(path_, "write", errno);
  change_detector_.emplace(path_);
  waiting_.reserve(2 * piece);
  if (saved) return;
  for (std::size_t i = 0; i < columns.size(); ++i) line_ += (i == 0 ? "" : ",") + columns[i];
  put_line();
}

HistoryWriter::~HistoryWriter() {
  try {
    flush();
  } catch (const Error&) {  // the run that has ended has reported it
  }
}

void HistoryWriter::save(const SnapshotVisitor& visit) {
  checksums_.persist(visit, std::filesystem::path(path_).filename().string());
}

void HistoryWriter::put_line() {
  line_ += '\n';
  waiting_ += line_;
  checksums_.add(line_);
  if (waiting_.size() >= piece) flush();
}

void HistoryWriter::write(const std::vector<double>& row) {
  line_.clear();
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) line_ += ',';
    fmt::format_to(std::back_inserter(line_), "{:.17g}", row[i]);
  }
  put_line();
}

void HistoryWriter::flush() {
  change_detector_->require_unchanged();
  if (waiting_.empty()) return;
  errno = 0;
  file_.write(waiting_.data(), static_cast<std::streamsize>(waiting_.size()));
  if (!file_.flush()) throw_file_error(path_, "write", errno);
  waiting_.clear();
  change_detector_->expect_size(checksums_.length());
}

void HistoryWriter::sync() {
  flush();
  sync_to_disk(path_);
}

long last_history_step(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = std::int64_t(file.tellg());
  std::string tail;
  // Reads increasing parts of the end until they contain a whole row.
  for (std::int64_t length = 0; length < size;) {
    length = std::min<std::int64_t>(std::max<std::int64_t>(8 * length, 4096), size);
    tail.resize(std::size_t(length));
    file.seekg(size - length);
    if (!file.read(tail.data(), length)) return 0;
    const std::size_t end = tail.rfind('\n');
    const std::size_t before = end == std::string::npos || end == 0 ? std::string::npos : tail.rfind('\n', end - 1);
    if (before == std::string::npos) continue;
    long step = 0;
    std::from_chars(tail.data() + before + 1, tail.data() + end, step);
    return step;
  }
  return 0;
}

HistoryTable read_history(const std::string& path, bool may_grow) {
  std::ifstream file(path);
  if (!file) throw Error(ErrorKind::file_access, fmt::format("{}: cannot read: {}", path, std::strerror(errno)));
  HistoryTable table;
  std::string line;
  if (!std::getline(file, line)) throw Error(ErrorKind::invalid_input, fmt::format("{}:1: no header row", path));
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    table.names.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  // The row of names may be missing: a row of numbers is not accepted as one.
  if (std::ranges::any_of(table.names, [](const auto& name) { return number_in(name).has_value(); }))
    throw Error(
        ErrorKind::invalid_input,
        fmt::format(
            "{}:1: the first row must hold the names of the columns, but begins with \"{}\": the file is damaged", path,
            table.names.front()));
  std::vector<std::vector<double>*> columns;
  for (const std::string& name : table.names) columns.push_back(&table.columns[name]);
  for (long number = 2; std::getline(file, line); ++number) {
    if (may_grow && file.eof()) break;  // no end of line: it is being written
    const char* at = line.data();
    const char* const end = line.data() + line.size();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      double value = 0.0;
      const auto [next, problem] = std::from_chars(at, end, value);
      const bool separated = i + 1 == columns.size() ? next == end : next != end && *next == ',';
      if (problem != std::errc() || !separated) {
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{}:{}: column {} (\"{}\") is not a number", path, number, i + 1, table.names[i]));
      }
      columns[i]->push_back(value);
      at = next == end ? end : next + 1;
    }
  }
  return table;
}

}  // namespace ricochet
