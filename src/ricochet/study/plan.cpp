#include "ricochet/study/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <string_view>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/keys.hpp"
#include "ricochet/case/keys_override.hpp"

namespace ricochet {

namespace {

/// Value of a key that a run leaves as in the case.
constexpr std::string_view left_out = "-";
constexpr std::size_t most_runs = 10'000, longest_name = 80;

[[noreturn]] void refuse_axis(const std::string& text, const std::string& reason) {
  throw Error(ErrorKind::usage,
              fmt::format("--vary {}: {}; write --vary KEY=V1,V2,... or, for keys that change together, --vary "
                          "KEY1,KEY2=V1/W1,V2/W2,...",
                          text, reason));
}

std::string trimmed_value(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

/// Splits a text at separators outside brackets and quotes.
std::vector<std::string> split(const std::string& text, char separator, const std::string& list) {
  std::vector<std::string> parts;
  std::string part;
  int depth = 0;
  char quote = '\0';
  for (const char c : text) {
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '(' || c == '{') {
      ++depth;
    } else if (c == ']' || c == ')' || c == '}') {
      --depth;
    }
    if (c == separator && depth == 0 && quote == '\0') {
      parts.push_back(trimmed_value(part));
      part.clear();
    } else {
      part += c;
    }
  }
  if (depth != 0 || quote != '\0') refuse_axis(list, "a bracket or a quote is not closed");
  parts.push_back(trimmed_value(part));
  return parts;
}

/// Returns the keys as short as possible while unambiguous: the part after the last dot, else the whole.
std::vector<std::string> short_names(const std::vector<std::string>& keys) {
  const auto last_part = [](const std::string& key) { return key.substr(key.rfind('.') + 1); };
  std::vector<std::string> names;
  for (const std::string& key : keys) {
    const auto same = [&](const std::string& other) { return last_part(other) == last_part(key); };
    names.push_back(std::ranges::count_if(keys, same) > 1 ? key : last_part(key));
  }
  return names;
}

std::string name_of(const std::vector<std::string>& short_keys, const std::vector<std::string>& values) {
  std::string name;
  for (std::size_t k = 0; k < values.size(); ++k)
    name += fmt::format("{}{}={}", k > 0 ? "_" : "", short_keys[k], values[k]);
  for (char& c : name) {
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string_view("._=+-").find(c) != std::string_view::npos;
    if (!is_plain) c = '_';
  }
  return name.substr(0, longest_name);
}

}  // namespace

StudyAxis parse_axis(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) refuse_axis(text, "\"=\" is missing");
  StudyAxis axis;
  axis.keys = split(text.substr(0, equals), ',', text);
  for (const std::string& key : axis.keys) {
    if (key.empty()) refuse_axis(text, "a key is empty");
    try {
      static_cast<void>(parse_key_path(key));
    } catch (const Error& problem) {
      throw Error(ErrorKind::usage, fmt::format("--vary {}: {}", text, problem.what()));
    }
  }
  std::map<std::vector<std::string>, std::string> spellings;  // entries by meaning, not by spelling
  for (const std::string& entry : split(text.substr(equals + 1), ',', text)) {
    axis.values.push_back(axis.keys.size() > 1 ? split(entry, '/', text) : std::vector{entry});
    const std::vector<std::string>& values = axis.values.back();
    if (values.size() != axis.keys.size()) {
      refuse_axis(text, fmt::format("\"{}\" has {} for {}", entry, counted(values.size(), "value"),
                                    counted(axis.keys.size(), "key")));
    }
    if (std::ranges::count(values, "") > 0) refuse_axis(text, "a value is empty");
    std::vector<std::string> meant;
    for (const std::string& value : values) meant.push_back(override_value_text(value));
    const auto [same, is_new] = spellings.emplace(meant, entry);
    if (is_new) continue;
    refuse_axis(text, same->second == entry
                          ? fmt::format("\"{}\" appears twice", entry)
                          : fmt::format("\"{}\" and \"{}\" are the same value: remove one", same->second, entry));
  }
  return axis;
}

void check_plan(const StudyPlan& plan) {
  if (plan.axes.empty()) throw Error(ErrorKind::usage, "study: nothing varies: add --vary KEY=V1,V2,...");
  std::set<std::string> keys;
  for (const std::string& key : varied_keys(plan)) {
    if (!keys.insert(key).second) throw Error(ErrorKind::usage, fmt::format("study: --vary lists {} twice", key));
  }
  for (const std::string& setting : plan.settings) {
    const std::string key = trimmed_value(setting.substr(0, setting.find('=')));
    if (keys.contains(key)) throw Error(ErrorKind::usage, fmt::format("study: {} is in both --vary and --set", key));
  }
  std::size_t count = 1;
  for (const StudyAxis& axis : plan.axes) {
    count *= axis.values.size();
    if (count > most_runs)
      throw Error(ErrorKind::usage,
                  fmt::format("study: there are more than {} runs: vary fewer keys or values at a time", most_runs));
  }
}

std::vector<std::string> varied_keys(const StudyPlan& plan) {
  std::vector<std::string> keys;
  for (const StudyAxis& axis : plan.axes) keys.insert(keys.end(), axis.keys.begin(), axis.keys.end());
  return keys;
}

std::vector<PlannedRun> runs_of(const StudyPlan& plan) {
  const std::vector<std::string> keys = varied_keys(plan), short_keys = short_names(keys);
  std::size_t count = 1;
  for (const StudyAxis& axis : plan.axes) count *= axis.values.size();
  std::vector<PlannedRun> runs(count);
  for (std::size_t i = 0; i < count; ++i) {
    PlannedRun& run = runs[i];
    std::size_t repeats = count;
    for (const StudyAxis& axis : plan.axes) {
      repeats /= axis.values.size();
      run.at.push_back(i / repeats % axis.values.size());
      const std::vector<std::string>& values = axis.values[run.at.back()];
      run.values.insert(run.values.end(), values.begin(), values.end());
    }
    run.settings = plan.settings;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      if (run.values[k] != left_out) run.settings.push_back(keys[k] + "=" + run.values[k]);
    }
    run.name = name_of(short_keys, run.values);
  }
  return runs;
}

bool counts_halvings(const std::string& key) { return key.ends_with(".refine"); }

double step_of(const std::string& key, double value) { return counts_halvings(key) ? std::exp2(-value) : value; }

KeyPosition find_varied(const StudyPlan& plan, const std::string& key, const std::string& option) {
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const std::vector<std::string>& keys = plan.axes[a].keys;
    const auto found = std::ranges::find(keys, key);
    if (found != keys.end()) return {a, std::size_t(found - keys.begin())};
  }
  throw Error(ErrorKind::usage,
              fmt::format("{}: \"{}\" does not vary; keys that vary: {}", option, key, join_names(varied_keys(plan))));
}

bool is_numeric(const StudyPlan& plan, KeyPosition position) {
  const auto& values = plan.axes[position.axis].values;
  return values.size() > 1 &&
         std::ranges::all_of(values, [&](const auto& entry) { return number_in(entry[position.key]).has_value(); });
}

}  // namespace ricochet
