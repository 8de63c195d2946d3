#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ricochet/base/text.hpp"
#include "ricochet/case/read_sections.hpp"
#include "ricochet/case/section_reader.hpp"

namespace ricochet {

namespace {

constexpr double most_steps = 1e9;

const std::array<std::string, 3> newmark_keys{"beta", "gamma", "preset"};

// Keys of Newmark's scheme in a file whose scheme was replaced by --set mean nothing; otherwise they are a mistake.
void refuse_newmark_keys(const SectionReader& reader, const std::string& scheme, Remarks& remarks) {
  for (const std::string& name : newmark_keys) {
    if (!reader.is_given(name)) continue;
    if (reader.is_override("scheme") && !reader.is_override(name)) {
      remarks.infos.push_back(
          fmt::format("{}: \"{}\" is ignored: the scheme is \"{}\"", reader.where(name).text(), name, scheme));
      remarks.ignored.push_back("time." + name);
    } else {
      reader.add_problem(name,
                         fmt::format("\"{}\" is for the scheme \"newmark\" only; the scheme is \"{}\"", name, scheme));
    }
  }
}

std::string preset_help() {
  std::vector<std::string> texts;
  for (const NewmarkPreset& preset : newmark_presets()) {
    texts.push_back(fmt::format("\"{}\" (beta = {}, gamma = {})", preset.name, preset.beta, preset.gamma));
  }
  return join_names(texts, " or ", false);
}

// One of beta and gamma: its own value or the preset's. Of two, that of --set counts.
double read_newmark_parameter(const SectionReader& reader, const std::string& name, double of_preset, TimeSection& time,
                              Remarks& remarks) {
  if (!reader.is_usable(name)) return of_preset;
  if (!reader.is_usable("preset")) return reader.number(name);
  const bool own_counts = reader.is_override(name);
  const std::string loser = own_counts ? "preset" : name;
  remarks.infos.push_back(fmt::format("{}: \"{}\" is overridden by {}", reader.where(loser).text(), loser,
                                      reader.where(own_counts ? name : "preset").text()));
  if (!own_counts) return of_preset;
  time.preset.clear();
  return reader.number(name);
}

void advise(const TimeSection& time, const SourceLocation& where, Remarks& remarks) {
  if (time.gamma < 0.5) {
    remarks.warnings.push_back(
        fmt::format("{}: Newmark's scheme is unstable with gamma = {} (below 1/2)", where.text(), time.gamma));
  } else if (2.0 * time.beta < time.gamma) {
    remarks.warnings.push_back(fmt::format(
        "{}: Newmark's scheme is only conditionally stable with beta = {}, gamma = {} (2 beta < gamma): the step "
        "must be small enough",
        where.text(), time.beta, time.gamma));
  }
}

void read_newmark(const SectionReader& reader, TimeSection& time, Remarks& remarks) {
  const bool has_preset = reader.is_given("preset");
  for (const std::string name : {"beta", "gamma"}) {
    if (has_preset && reader.is_given(name) && reader.is_override(name) == reader.is_override("preset")) {
      reader.add_problem("preset",
                         fmt::format("\"preset\" and \"{}\" are given together: \"preset\" stands for beta and "
                                     "gamma, leave out one or the other",
                                     name));
      return;
    }
    if (!has_preset && !reader.is_given(name)) {
      reader.add_problem("scheme",
                         fmt::format("the scheme \"newmark\" needs \"beta\" and \"gamma\", or a \"preset\": {}; "
                                     "\"{}\" is missing",
                                     preset_help(), name));
      return;
    }
  }
  time.preset = reader.text("preset");
  const std::vector<NewmarkPreset>& presets = newmark_presets();
  const auto preset = std::find_if(presets.begin(), presets.end(),
                                   [&](const NewmarkPreset& candidate) { return candidate.name == time.preset; });
  const NewmarkPreset fallback = preset != presets.end() ? *preset : NewmarkPreset{"", time.beta, time.gamma};
  time.beta = read_newmark_parameter(reader, "beta", fallback.beta, time, remarks);
  time.gamma = read_newmark_parameter(reader, "gamma", fallback.gamma, time, remarks);
  advise(time, reader.where(reader.is_given("gamma") ? "gamma" : "preset"), remarks);
}

}  // namespace

TimeSection read_time(const SectionReader& reader, Remarks& remarks) {
  TimeSection time;
  time.scheme = reader.text("scheme");
  time.step = reader.number("step");
  time.end = reader.number("end");
  if (time.scheme == "newmark") {
    read_newmark(reader, time, remarks);
  } else if (reader.is_usable("scheme")) {
    refuse_newmark_keys(reader, time.scheme, remarks);
  }
  if (!reader.is_usable("step") || !reader.is_usable("end")) return time;
  if (time.end < time.step) {
    reader.add_problem("end",
                       fmt::format("\"end\" is {}, before the end of the first step of {}", time.end, time.step));
  } else if (time.end / time.step > most_steps) {
    reader.add_problem(
        "step", fmt::format("a step of {} up to the end {} makes {:.3g} steps; at most {:.0e} are possible", time.step,
                            time.end, time.end / time.step, most_steps));
  }
  return time;
}

}  // namespace ricochet
