#include "ricochet/report/animation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/json.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/report/reading_runs.hpp"
#include "ricochet/report/run_data.hpp"
#include "ricochet/report/simplices.hpp"

namespace ricochet {

namespace {

/// Limits of the triangles of a picture, and of all pictures of an animation together: more take minutes to draw.
constexpr Index drawn_triangles = 20'000;
constexpr double drawn_in_all = 1e6;
constexpr std::size_t drawn_frames = 200;

[[noreturn]] void refuse_animation(const std::string& message) { throw Error(ErrorKind::usage, message); }

std::string number_text(int value) { return std::to_string(value); }
/// Returns a number with nine digits, which suffice for pictures; "null" if it is not finite.
std::string number_text(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : "null"; }
std::string number_text(float value) { return number_text(double(value)); }

template <class Values>
std::string list_text(const Values& values) {
  std::string text = "[";
  for (const auto value : values) {
    if (text.size() > 1) text += ',';
    text += number_text(value);
  }
  return text + "]";
}

std::vector<std::size_t> frames_of(const RunData& run, const AnimationOptions& options) {
  const std::vector<double>& times = run.results->times();
  if (times.empty()) refuse_animation(fmt::format("{}: the run has written no frames", run.directory));
  if (options.time) {
    const double rounding = 1e-9 * std::abs(times.back());
    if (!(*options.time >= times.front() - rounding && *options.time <= times.back() + rounding))
      refuse_animation(fmt::format("--at {:g}: the frames of {} cover times from {:.9g} to {:.9g}", *options.time,
                                   run.directory, times.front(), times.back()));
    const auto nearest = std::ranges::min_element(
        times, [&](double a, double b) { return std::abs(a - *options.time) < std::abs(b - *options.time); });
    return {std::size_t(nearest - times.begin())};
  }
  std::vector<std::size_t> frames;
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (!options.interval || (times[k] >= options.interval->first && times[k] <= options.interval->second))
      frames.push_back(k);
  }
  if (frames.size() < 2)
    refuse_animation(
        fmt::format("{}: there are fewer than two frames{}: an animation needs more (output.fields_every); use --at T "
                    "to draw a single frame",
                    run.directory, options.interval ? " in this time interval" : ""));
  const std::size_t every = (frames.size() + drawn_frames - 1) / drawn_frames;
  std::vector<std::size_t> shown;
  for (std::size_t k = 0; k < frames.size(); k += every) shown.push_back(frames[k]);
  // The final state is always shown.
  if (shown.back() != frames.back()) shown.push_back(frames.back());
  return shown;
}

const ResultField& field_of(const RunData& run, const std::string& name) {
  if (const ResultField* const field = run.results->find_field(name)) return *field;
  std::vector<std::string> names;
  for (const ResultField& field : run.results->fields()) names.push_back(field.name);
  const std::string near = nearest_name(name, names);
  refuse_animation(fmt::format("--field {}: {} has no such field{}; it has {}", name, run.directory,
                               near.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", near), join_names(names)));
}

/// Returns one number for each node or cell: the value of a scalar, the length of a vector.
std::vector<float> sizes_of(const std::vector<float>& values, int components) {
  std::vector<float> sizes;
  for (std::size_t i = 0; i < values.size(); i += std::size_t(components)) {
    if (components == 1) {
      sizes.push_back(values[i]);
      continue;
    }
    float sum = 0.0F;
    for (int k = 0; k < components; ++k) sum = std::hypot(sum, values[i + std::size_t(k)]);
    sizes.push_back(sum);
  }
  return sizes;
}

class SceneWriter {
 public:
  SceneWriter(const RunData& run, const AnimationOptions& options, std::size_t frames)
      : run_(run),
        field_(field_of(run, options.field)),
        displacement_(field_of(run, "displacement")),
        pressure_(options.zoom ? run.results->find_field("contact_pressure") : nullptr) {
    if (field_.components > 3)
      refuse_animation(fmt::format("--field {}: this field is a tensor; choose a scalar or a vector", options.field));
    if (options.zoom && pressure_ == nullptr)
      refuse_animation(fmt::format(
          "{}: --zoom shows the contact, but the run wrote no contact_pressure (output.fields)", run.directory));
    const Index most = std::min(drawn_triangles, Index(drawn_in_all / double(frames)));
    surface_ = make_surface(run.results->nodes(), run.results->cells(), most);
  }

  [[nodiscard]] std::string surface_text() const {
    std::string text =
        fmt::format(R"("triangles":{},"reference":{})", list_text(surface_.corners), list_text(positions_of({})));
    if (!run_.obstacles.empty()) {
      text += fmt::format(R"(,"obstacles":{{"corners":{},"cells":{},"obstacle":{}}})", run_.obstacles.front().corners,
                          list_text(run_.obstacles.front().cells), list_text(run_.obstacles.front().obstacle));
    }
    return text;
  }

  std::string frame_text(std::size_t frame) {
    run_.results->read(Index(frame), displacement_, values_);
    const std::vector<double> positions = positions_of(values_);
    run_.results->read(Index(frame), field_, values_);
    const std::vector<float> sizes = sizes_of(values_, field_.components);
    std::vector<float> shown;
    for (std::size_t t = 0; t < surface_.cells.size(); ++t) {
      if (!field_.on_nodes) {
        shown.push_back(sizes[std::size_t(surface_.cells[t])]);
        continue;
      }
      float sum = 0.0F;
      for (std::size_t k = 0; k < 3; ++k)
        sum += sizes[std::size_t(surface_.nodes[std::size_t(surface_.corners[3 * t + k])])];
      shown.push_back(sum / 3.0F);
    }
    std::string text = fmt::format(R"({{"time":{:.9g},"points":{},"values":{})", run_.results->times()[frame],
                                   list_text(positions), list_text(shown));
    if (pressure_ != nullptr) text += fmt::format(R"(,"touching":{})", list_text(touching_in(frame)));
    if (frame < run_.obstacles.size())
      text += fmt::format(R"(,"obstacles":{})", list_text(run_.obstacles[frame].positions));
    return text + "}";
  }

 private:
  /// Returns the positions of the surface's nodes, displaced by values with as many components as the field has.
  [[nodiscard]] std::vector<double> positions_of(const std::vector<float>& displacement) const {
    std::vector<double> result;
    const auto width = std::size_t(displacement_.components);
    for (const Index node : surface_.nodes) {
      for (std::size_t k = 0; k < 3; ++k) {
        const bool moves = !displacement.empty() && k < width;
        result.push_back(run_.results->nodes()(Index(k), node) +
                         (moves ? double(displacement[std::size_t(node) * width + k]) : 0.0));
      }
    }
    return result;
  }

  /// Returns the indices of the surface's nodes that are pressed.
  std::vector<int> touching_in(std::size_t frame) {
    run_.results->read(Index(frame), *pressure_, values_);
    std::vector<int> result;
    for (std::size_t i = 0; i < surface_.nodes.size(); ++i) {
      if (values_[std::size_t(surface_.nodes[i])] > 0.0F) result.push_back(int(i));
    }
    return result;
  }

  const RunData& run_;
  const ResultField& field_;
  const ResultField& displacement_;
  const ResultField* pressure_;
  Simplices surface_;
  std::vector<float> values_;
};

std::string describe(const RunData& run, const AnimationOptions& options) {
  if (run.results == nullptr) {
    refuse_animation(
        fmt::format("{}: the run wrote no fields (output.fields_every), so there is no body to draw", run.directory));
  }
  const std::vector<std::size_t> frames = frames_of(run, options);
  SceneWriter scene(run, options, frames.size());
  std::string frames_text;
  for (const std::size_t frame : frames) {
    if (!frames_text.empty()) frames_text += ',';
    frames_text += scene.frame_text(frame);
  }
  const auto plane = run.summary.parameters.find("mesh.plane");
  Json head{{"title", options.title},
            {"width", options.width},
            {"height", options.height},
            {"dimension", run.summary.dimension},
            {"axisymmetric", plane != run.summary.parameters.end() && plane->second == "axisymmetric"},
            {"half", options.half},
            {"zoom", options.zoom},
            {"field", options.field}};
  std::string text = head.dump();
  text.pop_back();
  return fmt::format("{},{},\"frames\":[{}]}}", text, scene.surface_text(), frames_text);
}

}  // namespace

std::string describe_animation(const std::string& directory, const AnimationOptions& options) {
  std::string description;
  read_with_retries({directory}, [&] {
    const std::vector<RunData> runs = read_runs({directory}, true);
    description = describe(runs.front(), options);
  });
  return description;
}

}  // namespace ricochet
