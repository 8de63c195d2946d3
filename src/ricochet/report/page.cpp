#include "ricochet/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/base/json.hpp"
#include "ricochet/fem/cell_rotations.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/report/body_part.hpp"
#include "ricochet/report/history_part.hpp"
#include "ricochet/report/judgement.hpp"
#include "ricochet/report/obstacle_part.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

/// Position of the data in the viewer's page, and the mark with which every report begins.
constexpr std::string_view data_begin = "<script type=\"application/json\" id=\"ricochet-runs\">";
constexpr std::string_view data_mark = "<!--RICOCHET-DATA-->", report_mark = "<!-- ricochet report -->";
/// Format of the data; the viewer's page begins with the one that it reads.
constexpr int data_format = 6;
/// Limit for all bodies together, and the number that each may have in any case.
constexpr Index most_triangles = 200'000, always_triangles = 20'000;

Json to_json(const PackedArray& array) {
  Json json{{"blob", array.blob}, {"rows", array.rows}, {"columns", array.columns}};
  switch (array.coding) {
    case Coding::reals:
      json["coding"] = "reals";
      break;
    case Coding::indices:
      json["coding"] = "indices";
      break;
    case Coding::levels:
      json["coding"] = "levels";
      json["bits"] = array.bits;
      json["prediction"] = array.prediction;
      json["low"] = array.low;
      json["step"] = array.step;
  }
  return json;
}

Json to_json(const ObstaclePart& part) {
  return {{"corners", part.corners},
          {"cells", to_json(part.cells)},
          {"obstacle", to_json(part.obstacle)},
          {"times", part.times},
          {"positions", to_json(part.positions)},
          {"offsets", part.offsets ? to_json(*part.offsets) : Json(nullptr)}};
}

/// Numbers that are not finite become words, as null stands for values that do not exist.
Json to_json(double value) { return Json::number(value); }

Json to_json(const std::optional<double>& value) { return value ? to_json(*value) : Json(nullptr); }

Json to_json(const Judgement& j) {
  return {{"energy_broken_at", to_json(j.energy_broken_at)},
          {"force_broken_at", to_json(j.force_broken_at)},
          {"penetration_broken_at", to_json(j.penetration_broken_at)},
          {"energy_scale", to_json(j.energy_scale)},
          {"is_isolated", j.is_isolated},
          {"energy_gain", to_json(j.energy_gain)},
          {"energy_loss", to_json(j.energy_loss)},
          {"energy_change", to_json(j.energy_change)},
          {"energy_residual", to_json(j.energy_residual)},
          {"force", j.force},
          {"force_largest", to_json(j.force_largest)},
          {"force_largest_at", to_json(j.force_largest_at)},
          {"force_variation", to_json(j.force_variation)},
          {"trend_variation", to_json(j.trend_variation)},
          {"roughness", to_json(j.roughness)},
          {"node_force", j.node_force},
          {"node_roughness", to_json(j.node_roughness)},
          {"penetration", to_json(j.penetration)},
          {"relative_penetration", to_json(j.relative_penetration)},
          {"penetration_not_watched", j.penetration_not_watched},
          {"unwatched_penetration", j.unwatched_penetration},
          {"contact_beyond_rim", j.contact_beyond_rim},
          {"rotation", to_json(j.rotation)},
          {"rotation_limit", std::isfinite(j.rotation_limit) ? to_json(j.rotation_limit) : Json(nullptr)},
          {"rotation_after_impacts", j.rotation_after_impacts}};
}

Json times_of(const std::vector<int>& frames, const ResultsReader& results) {
  Json times = Json::array();
  for (const int frame : frames) times.push_back(results.times()[std::size_t(frame)]);
  return times;
}

Json to_json(const ContactPart& part, const ResultsReader& results) {
  Json json{{"times", times_of(part.frames, results)}, {"nodes", to_json(part.nodes)}};
  if (!part.line.position.empty()) {
    json["position"] = to_json(part.position);
    json["pieces"] = part.line.pieces;
  }
  json["quantities"] = Json::array();
  for (const ContactQuantity& quantity : part.quantities)
    json["quantities"].push_back({{"name", quantity.name}, {"values", to_json(quantity.values)}});
  return json;
}

Json to_json(const BodyField& field) {
  return {{"name", field.name}, {"on_nodes", field.on_nodes}, {"values", to_json(field.values)}};
}

template <class Part>
Json list_of(const std::vector<Part>& parts) {
  Json list = Json::array();
  for (const Part& part : parts) list.push_back(to_json(part));
  return list;
}

Json to_json(const VolumePart& part) {
  return {{"nodes", part.nodes},
          {"tetrahedra", part.tetrahedra},
          {"positions", to_json(part.positions)},
          {"corners", to_json(part.corners)},
          {"cells", to_json(part.cells)},
          {"faces", to_json(part.faces)},
          {"deviations", list_of(part.deviations)},
          {"fields", list_of(part.fields)}};
}

Json to_json(const BodyPart& part, const ResultsReader& results) {
  return {{"nodes", part.nodes},
          {"triangles", part.triangles},
          {"times", times_of(part.frames, results)},
          {"positions", to_json(part.positions)},
          {"corners", to_json(part.corners)},
          {"triangle_cells", to_json(part.triangle_cells)},
          {"edges", to_json(part.edges)},
          {"mean", to_json(part.mean)},
          {"deviations", list_of(part.deviations)},
          {"fields", list_of(part.fields)},
          {"volume", part.volume ? to_json(*part.volume) : Json(nullptr)}};
}

class PageBuilder {
 public:
  PageBuilder(std::vector<RunData> runs, std::size_t most_bytes) : runs_(std::move(runs)), most_bytes_(most_bytes) {}

  /// Returns the data as they appear in the page.
  [[nodiscard]] std::string data();
  [[nodiscard]] std::vector<std::string> thinned() const { return thinned_; }

 private:
  Json start(const RunData& run, std::size_t number);
  void add_frames(const RunData& run, Json& json, std::size_t most_bytes);
  void note(const RunData& run, Json& json, const std::string& sentence) {
    json["thinned"].push_back(sentence);
    thinned_.push_back(run.name + ": " + sentence);
  }
  [[nodiscard]] std::size_t left() const {
    const std::size_t used = arrays_.page_bytes();
    return most_bytes_ > used ? most_bytes_ - used : 0;
  }

  std::vector<RunData> runs_;
  std::size_t most_bytes_;
  PackedArrays arrays_;
  std::vector<std::string> thinned_;
};

Json PageBuilder::start(const RunData& run, std::size_t number) {
  Json json{{"name", run.name}, {"directory", run.directory}, {"thinned", Json::array()}};
  json["summary"] = Json::parse(run.summary_json);
  json["judgement"] = to_json(judge(run));
  for (const std::string& sentence : run.notes) note(run, json, sentence);
  json["columns"] = run.history.names;
  // Two fifths are reserved for all histories; unused space is left to later ones.
  const std::size_t used = arrays_.page_bytes(), all = most_bytes_ / 5 * 2;
  const std::size_t share = (all - std::min(used, all)) / (runs_.size() - number);
  const HistoryPart history = pack_history(run.history, share, arrays_);
  json["history"] = to_json(history.table);
  json["tables"] = Json::array();
  for (const auto& [file, table] : run.probe_tables) {
    const HistoryPart part = pack_history(table, most_bytes_ / 16 / runs_.size(), arrays_);
    json["tables"].push_back({{"file", file}, {"columns", table.names}, {"values", to_json(part.table)}});
    if (part.rows_per_pair > 0)
      note(run, json, fmt::format("{}: two of every {} rows are kept", file, part.rows_per_pair));
  }
  json["rows_per_pair"] = history.rows_per_pair;
  if (history.rows_per_pair > 0) {
    note(run, json,
         fmt::format("curves show the smallest and the largest value of every {} rows of the history, to keep the file "
                     "small; history.csv has all {}",
                     history.rows_per_pair, run.column("time").size()));
  }
  json["obstacles"] = run.obstacles.empty() ? Json(nullptr) : to_json(pack_obstacles(run.obstacles, arrays_));
  return json;
}

void PageBuilder::add_frames(const RunData& run, Json& json, std::size_t most_bytes) {
  json["body"] = json["contact"] = nullptr;
  if (!run.results) return;
  const BodyFrames frames(*run.results, std::max(most_triangles / Index(runs_.size()), always_triangles),
                          most_bytes / 4);
  const std::size_t before = arrays_.page_bytes();
  const ContactPart contact = frames.pack_contact(most_bytes / 4, arrays_);
  const auto all = std::size_t(frames.frame_count());
  const auto say_frames = [&](const char* of_what, std::size_t there) {
    if (there == all) return;
    note(run, json, fmt::format("{}: {} of the {} frames, to keep the file small", of_what, there, all));
  };
  if (!contact.line.nodes.empty()) {
    say_frames("the contact boundary", contact.frames.size());
    json["contact"] = to_json(contact, *run.results);
  }
  const BodyPart body = frames.pack_body(most_bytes - std::min(arrays_.page_bytes() - before, most_bytes), arrays_);
  say_frames("the body", body.frames.size());
  if (body.deviations.empty())
    note(run, json, "the frames have no displacements (output.fields): the body is shown as it was at the start");
  if (body.is_coarse) {
    note(run, json,
         fmt::format("displacements are stored in {} steps from the smallest to the largest value, fields in {}",
                     (1 << body.displacement_bits) - 2, (1 << body.field_bits) - 2));
  }
  if (body.is_thinned) {
    note(run, json,
         fmt::format("the body is drawn with {} triangles, after nodes near one another were merged", body.triangles));
  }
  if (body.volume && body.volume->is_thinned) {
    note(run, json,
         fmt::format(
             "the interior, which cuts show, consists of {} tetrahedra, after nodes near one another were merged",
             body.volume->tetrahedra));
  }
  if (!body.volume && run.summary.dimension == 3)
    note(run, json, "the interior is omitted to keep the file small: there are no cuts");
  if (!body.left_out.empty()) {
    note(run, json,
         fmt::format("fields that are only in {}: {}", run.results->format().files.front(),
                     fmt::join(body.left_out, ", ")));
  }
  json["body"] = to_json(body, *run.results);
}

std::string PageBuilder::data() {
  Json page{{"format", data_format}, {"version", version}, {"runs", Json::array()}};
  for (std::size_t i = 0; i < runs_.size(); ++i) page["runs"].push_back(start(runs_[i], i));
  // The summaries are in the file as well, as text.
  std::size_t text = 65536;
  for (const RunData& run : runs_) text += run.summary_json.size();
  most_bytes_ -= std::min(most_bytes_, text);
  for (std::size_t i = 0; i < runs_.size(); ++i) add_frames(runs_[i], page["runs"][i], left() / (runs_.size() - i));
  std::string html(data_begin);
  for (const char c : page.dump()) {
    if (c == '<') {
      html += "\\u003c";  // "</script>" in a title ends nothing
    } else {
      html += c;
    }
  }
  html += "</script>\n";
  for (std::size_t i = 0; i < arrays_.blobs().size(); ++i) {
    html += fmt::format("<script type=\"text/plain\" id=\"ricochet-blob-{}\">", i);
    append_base64(arrays_.blobs()[i], html);
    html += "</script>\n";
  }
  return html;
}

}  // namespace

Report make_report(const std::vector<std::string>& directories, const ReportOptions& options) {
  const std::string viewer = read_file(options.viewer);
  const std::size_t mark_position = viewer.find(data_mark);
  if (mark_position == std::string::npos ||
      viewer.find(fmt::format("<!-- data format {} -->", data_format)) == std::string::npos) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: is not the viewer of this version: build or install Ricochet again", options.viewer));
  }
  PageBuilder builder(read_runs(directories, true), options.most_bytes - std::min(options.most_bytes, viewer.size()));
  Report report;
  report.html = viewer.substr(0, mark_position) + builder.data() + viewer.substr(mark_position + data_mark.size());
  report.thinned = builder.thinned();
  return report;
}

bool is_report_of(const std::string& path, const std::vector<std::string>& directories) {
  const std::string text = read_file(path);
  const std::size_t begin = text.find(data_begin), end = text.find("</script>", begin);
  if (begin == std::string::npos || end == std::string::npos) return false;
  const std::size_t first = begin + data_begin.size();
  Json page;
  try {
    page = Json::parse(text.substr(first, end - first));
  } catch (const Json::Exception&) {
    return false;
  }
  const auto absolute_path = [](const std::string& directory) {
    return (std::filesystem::absolute(directory) / "").lexically_normal();
  };
  std::set<std::filesystem::path> shown, requested;
  if (page.is_object() && page.contains("runs")) {
    for (const Json& run : page.at("runs")) shown.insert(absolute_path(run.value("directory", "")));
  }
  for (const std::string& directory : directories) requested.insert(absolute_path(directory));
  return shown == requested;
}

bool is_report(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string begin(1024, '\0');
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(std::size_t(file.gcount()));
  return begin.find(report_mark) != std::string::npos;
}

}  // namespace ricochet
