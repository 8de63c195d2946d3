#include "ricochet/study/benchmark/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/case/toml_tree.hpp"
#include "ricochet/io/durable_file.hpp"

namespace ricochet {

namespace {

namespace fs = std::filesystem;

const std::array<std::pair<std::string, std::string Benchmark::*>, 4> manifest_keys{
    {{"name", &Benchmark::name},
     {"case", &Benchmark::case_path},
     {"group", &Benchmark::group},
     {"description", &Benchmark::description}}};

std::vector<std::string> known_keys() {
  std::vector<std::string> names;
  for (const auto& [name, member] : manifest_keys) names.push_back(name);
  return names;
}

void add_unknown(const TomlNode& node, const std::vector<std::string>& known, Problems& problems) {
  const std::string meant = nearest_name(node.key, known);
  problems.add(node.key_location,
               fmt::format("unknown key \"{}\"{}; known: {}", node.key,
                           meant.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", meant), join_names(known)));
}

/// Returns true if a text can be a name, which becomes part of the names of directories.
bool is_name(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

Benchmark read_benchmark(const TomlNode& entry, const fs::path& folder, Problems& problems) {
  Benchmark benchmark;
  for (const TomlNode& value : entry.children) {
    const auto key = std::ranges::find_if(manifest_keys, [&](const auto& known) { return known.first == value.key; });
    if (key == manifest_keys.end()) {
      add_unknown(value, known_keys(), problems);
    } else if (value.kind != TomlNode::Kind::text) {
      problems.add(value.location, fmt::format("\"{}\" must be a text; found {}", value.key, describe(value)));
    } else {
      benchmark.*key->second = value.text;
    }
  }
  const TomlNode *name = entry.find("name"), *file = entry.find("case");
  if (name == nullptr || !is_name(benchmark.name)) {
    problems.add(name != nullptr ? name->location : entry.location,
                 "a benchmark needs a \"name\" of letters, digits, hyphens and underscores");
  }
  std::error_code ignored;
  if (file == nullptr || benchmark.case_path.empty()) {
    problems.add(entry.location, "a benchmark needs a \"case\": its case file, relative to this file");
    return benchmark;
  }
  benchmark.case_path = fs::absolute(folder / benchmark.case_path).lexically_normal().string();
  if (!fs::is_regular_file(benchmark.case_path, ignored))
    problems.add(file->location, fmt::format("there is no file {}", benchmark.case_path));
  return benchmark;
}

}  // namespace

std::vector<Benchmark> read_benchmarks(const std::string& path) {
  const TomlNode document = parse_toml(read_file(path), path);
  std::vector<Benchmark> benchmarks;
  Problems problems;
  for (const TomlNode& section : document.children) {
    if (section.key != "benchmark" || !section.is_list_of_tables()) {
      add_unknown(section, {"[[benchmark]]"}, problems);
      continue;
    }
    for (const TomlNode& entry : section.children) {
      Benchmark benchmark = read_benchmark(entry, fs::path(path).parent_path(), problems);
      const bool is_there =
          std::ranges::any_of(benchmarks, [&](const Benchmark& other) { return other.name == benchmark.name; });
      if (is_there && !benchmark.name.empty())
        problems.add(entry.location, fmt::format("two benchmarks have the name \"{}\"", benchmark.name));
      benchmarks.push_back(std::move(benchmark));
    }
  }
  problems.raise();
  if (benchmarks.empty())
    throw Error(ErrorKind::invalid_input, fmt::format("{}: lists no benchmarks: add a [[benchmark]]", path));
  return benchmarks;
}

std::vector<Benchmark> choose_benchmarks(const std::vector<Benchmark>& all, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Benchmark& benchmark : all) known.push_back(benchmark.name);
  for (const std::string& name : names) {
    if (std::ranges::count(known, name) > 0) continue;
    const std::string meant = nearest_name(name, known);
    throw Error(ErrorKind::usage, fmt::format("benchmark: there is no \"{}\"{}; available: {}", name,
                                              meant.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", meant),
                                              join_names(known, " and ", false)));
  }
  if (names.empty()) return all;
  std::vector<Benchmark> chosen;
  for (const Benchmark& benchmark : all) {
    if (std::ranges::count(names, benchmark.name) > 0) chosen.push_back(benchmark);
  }
  return chosen;
}

}  // namespace ricochet
