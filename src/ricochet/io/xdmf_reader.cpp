#include "ricochet/io/xdmf_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "ricochet/base/error.hpp"
#include "ricochet/base/file_version.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/results_storage.hpp"

namespace ricochet {

namespace {

/// Sequential scanner for documents written by XdmfFile.
class Scanner {
 public:
  explicit Scanner(const std::string& path) : path_(path), text_(read_file(path)) {
    if (!find("<Domain>")) return;  // the run has not written anything yet
    const bool is_stated = find(fmt::format("<Information Name=\"{}\" Value=\"", version_attribute), next("<Grid"));
    require_readable_version(path, is_stated ? std::string(until("\"")) : "");
  }

  /// Moves behind the next occurrence; returns false (and does not move) if there is none before `end`.
  bool find(std::string_view what, std::size_t end = std::string::npos) {
    const std::size_t found = text_.find(what, at_);
    if (found == std::string::npos || found >= end) return false;
    at_ = found + what.size();
    return true;
  }
  [[nodiscard]] bool has_next(std::string_view what) const { return text_.find(what, at_) != std::string::npos; }
  /// Position of the next occurrence; the end of the text if there is none.
  [[nodiscard]] std::size_t next(std::string_view what) const { return std::min(text_.find(what, at_), text_.size()); }
  /// Text before the next occurrence of `end`, which must exist.
  std::string_view until(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string::npos) fail(fmt::format("'{}' is missing", end));
    const std::string_view result = std::string_view(text_).substr(at_, found - at_);
    at_ = found + end.size();
    return result;
  }
  void expect(std::string_view what) {
    if (!find(what)) fail(fmt::format("'{}' is missing", what));
  }
  [[nodiscard]] double number(std::string_view text) const {
    const std::optional<double> value = number_in(text);
    if (!value) fail(fmt::format("'{}' is not a number", text));
    return *value;
  }
  [[nodiscard]] std::vector<double> numbers(std::string_view text) const {
    std::vector<double> result;
    for (std::size_t begin = text.find_first_not_of(" \n"); begin < text.size();) {
      const std::size_t end = std::min(text.find_first_of(" \n", begin), text.size());
      result.push_back(number(text.substr(begin, end - begin)));
      begin = text.find_first_not_of(" \n", end);
    }
    return result;
  }
  [[nodiscard]] std::vector<int> whole_numbers(std::string_view text, double limit) const {
    std::vector<int> result;
    for (const double value : numbers(text)) {
      if (!(value >= 0.0 && value < limit) || value != std::trunc(value))
        fail(fmt::format("{} is not a valid index", value));
      result.push_back(int(value));
    }
    return result;
  }
  [[noreturn]] void fail(const std::string& problem) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at_), '\n');
    throw Error(ErrorKind::invalid_input, fmt::format("{}:{}: {}: the file is damaged", path_, line, problem));
  }

 private:
  std::string path_, text_;
  std::size_t at_ = 0;
};

constexpr std::string_view grid = "<Grid Name=\"body\" GridType=\"Uniform\">";
constexpr std::string_view obstacle_grid = "<Grid Name=\"obstacles\" GridType=\"Uniform\">";

ResultField field_of(Scanner& file) {
  ResultField field;
  field.name = file.until("\"");
  file.expect("AttributeType=\"");
  const std::string_view type = file.until("\"");
  field.components = type == "Scalar" ? 1 : type == "Vector" ? 3 : 6;
  file.expect("Center=\"");
  field.on_nodes = file.until("\"") == "Node";
  return field;
}

ResultFrames read_xdmf_frames(const std::string& path) {
  Scanner file(path);
  ResultFrames result;
  while (file.find(grid) && file.has_next("</Grid>")) {
    file.expect("<Time Value=\"");
    result.times.push_back(file.number(file.until("\"")));
    if (result.times.size() > 1) continue;
    const std::size_t end = file.next("</Grid>");
    while (file.find("<Attribute Name=\"", end)) result.fields.push_back(field_of(file));
  }
  return result;
}

/// results.h5, one group per frame; results.xdmf describes their content. Groups do not move in the file.
class GroupsStorage : public ResultsStorage {
 public:
  GroupsStorage(const std::string& directory, const ResultsFormat& format) : ResultsStorage(directory, format) {
    frames_ = read_xdmf_frames(directory + "/results.xdmf");
    groups_ = file().members("/frames");
    if (groups_.size() < frames_.times.size()) {
      file().fail("/frames",
                  fmt::format("has {} frames, but results.xdmf has {}", groups_.size(), frames_.times.size()));
    }
  }

  void read(Index frame, const ResultField& field, Index rows, Values values) override {
    const int columns = field.components > 1 ? field.components : 0;
    const auto read_table = [&](auto* numbers) {
      file().table(groups_[std::size_t(frame)], field.name, rows, columns, *numbers);
    };
    std::visit(read_table, values);
  }

 private:
  void look_up(const Hdf5Reader& /*file*/) override {}

  std::vector<Hdf5Member> groups_;
};

}  // namespace

std::unique_ptr<ResultsStorage> open_xdmf_results(const std::string& directory, const ResultsFormat& format) {
  return std::make_unique<GroupsStorage>(directory, format);
}

std::vector<ObstacleFrame> read_xdmf_obstacles(const std::string& directory, const ResultsFormat& format) {
  Scanner file(directory + "/" + format.obstacles);
  std::vector<ObstacleFrame> result;
  while (file.find(obstacle_grid) && file.has_next("</Grid>")) {
    ObstacleFrame frame;
    file.expect("<Time Value=\"");
    frame.time = file.number(file.until("\""));
    file.expect("NodesPerElement=\"");
    frame.corners = int(file.number(file.until("\"")));
    const auto item = [&file] {
      file.expect("<DataItem");
      file.expect(">");
      return file.until("</DataItem>");
    };
    const std::string_view cells = item();
    frame.positions = file.numbers(item());
    frame.cells = file.whole_numbers(cells, double(frame.positions.size() / 3));
    frame.obstacle = file.whole_numbers(item(), 1e6);
    if (frame.corners < 2 || frame.corners > 4 || frame.positions.size() % 3 != 0 ||
        frame.cells.size() != frame.obstacle.size() * std::size_t(frame.corners)) {
      file.fail("points, cells and obstacles are inconsistent");
    }
    result.push_back(std::move(frame));
  }
  return result;
}

}  // namespace ricochet
