#include "completion.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "completion_of_keys.hpp"
#include "installed_files.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/study/benchmark/manifest.hpp"
#include "ricochet/study/study_files.hpp"

namespace ricochet::program {

namespace {

namespace fs = std::filesystem;
using Candidates = std::vector<Candidate>;

Candidates words_of(const std::vector<std::string>& names) {
  Candidates result;
  for (const std::string& name : names) result.push_back({name});
  return result;
}

/// Returns a path as typed, with "~/" replaced by the user's home folder.
fs::path expanded(const std::string& typed) {
  const char* const home = std::getenv("HOME");
  return typed.starts_with("~/") && home != nullptr ? fs::path(home) / typed.substr(2) : fs::path(typed);
}

/// Returns the entries of the folder being typed, each as the whole word: folders with a "/", and matching files.
Candidates entries(const std::string& typed, const std::function<bool(const fs::path&)>& wants_file,
                   const std::function<bool(const std::string&)>& ends_at) {
  const std::string folder = typed.substr(0, typed.rfind('/') + 1);
  const bool hidden = typed.substr(folder.size()).starts_with('.');
  Candidates result;
  std::error_code problem;
  const fs::directory_iterator all(folder.empty() ? fs::path(".") : expanded(folder), problem);
  for (auto entry = begin(all); !problem && entry != end(all); entry.increment(problem)) {
    const std::string name = entry->path().filename().string();
    std::error_code unknown;
    if (name.starts_with('.') && !hidden) continue;
    if (entry->is_directory(unknown)) {
      result.push_back({folder + name + (ends_at(entry->path().string()) ? "" : "/")});
    } else if (wants_file(entry->path())) {
      result.push_back({folder + name});
    }
  }
  return result;
}

Candidates files(const std::string& typed, const std::vector<std::string>& extensions) {
  const auto is_candidate = [&](const fs::path& path) {
    return extensions.empty() || std::ranges::find(extensions, path.extension().string()) != extensions.end();
  };
  return entries(typed, is_candidate, [](const std::string&) { return false; });
}

/// Returns folders. One that holds a run or a study is complete, as nothing inside it can follow.
Candidates folders(const std::string& typed) {
  const auto is_result = [](const std::string& path) { return holds_run(path) || holds_study(path); };
  return entries(
      typed, [](const fs::path&) { return false; }, is_result);
}

Candidates benchmark_names() {
  Candidates result;
  try {
    for (const Benchmark& benchmark : read_benchmarks(benchmark_manifest()))
      result.push_back({benchmark.name, benchmark.description});
  } catch (const Error&) {  // they are not installed: there is nothing to suggest
  }
  return result;
}

/// Completes the last of names separated by commas.
Candidates listed(const std::string& typed, std::vector<std::string> names) {
  const std::string before = typed.substr(0, typed.rfind(',') + 1);
  for (std::string& name : names) name.insert(0, before);
  return words_of(names);
}

/// Returns the possible values of an option, according to the name of its value in the help.
Candidates values_of(const DescribedOption& option, const std::string& typed, const std::string& case_file) {
  const std::string& value = option.value;
  if (value == "CASE.toml") return files(typed, {".toml"});
  if (value == "PROBLEM.hdf5" || value == "SOLUTION.hdf5") return files(typed, {".hdf5", ".h5"});
  if (value == "FILE.html") return files(typed, {".html"});
  if (value == "FILE") return files(typed, {".svg", ".pdf", ".png", ".gif", ".mp4"});
  if (value == "FILE_OR_DIR") return files(typed, {});
  if (value == "DIR" || value == "RUN") return folders(typed);
  if (value == "LEVEL") return words_of({"trace", "debug", "info", "warning", "error", "off"});
  if (value == "SHELL") return words_of({"bash", "zsh", "fish"});
  if (value == "SOLVER") return words_of(contact_solver_registry().names());
  if (value == "BENCHMARK") return benchmark_names();
  if (value == "WHAT") return words_of({"energy", "force", "momentum", "pressure", "pressure-map"});
  if (value == "key.path=value" || value == "KEY=V1,V2,...") return settings_of(case_file, typed);
  if (value == "KEY") return keys_of(case_file);
  if (value == "SCHEME,...|all") {
    std::vector<std::string> names = scheme_registry().names();
    names.emplace_back("all");
    return listed(typed, names);
  }
  return {};  // a number, a text
}

Candidates options_of(const DescribedCommand& command) {
  Candidates result;
  for (const DescribedOption& option : command.options) {
    for (const std::string& name : option.names) result.push_back({name, option.doc});
  }
  return result;
}

/// The words before the last, as the command interprets them.
struct Typed {
  const DescribedOption* open = nullptr;  ///< option whose value comes next
  std::vector<std::string> positionals;
};

Typed parsed(const DescribedCommand& command, const std::vector<std::string>& words) {
  Typed result;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (result.open != nullptr) {
      result.open = nullptr;
    } else if (const DescribedOption* option = find_option(command, words[i])) {
      if (!option->value.empty()) result.open = option;
    } else if (!words[i].starts_with('-')) {
      result.positionals.push_back(words[i]);
    }
  }
  return result;
}

Candidates of_command(const DescribedCommand& command, const std::vector<std::string>& words) {
  const std::string& typed = words.back();
  const Typed before = parsed(command, words);
  const std::string case_file = before.positionals.empty() ? "" : before.positionals.front();
  if (before.open != nullptr) return values_of(*before.open, typed, case_file);
  // "--set=KEY": the value is a part of the word.
  if (const std::size_t equals = typed.find('='); typed.starts_with("--") && equals != std::string::npos) {
    const DescribedOption* const option = find_option(command, typed.substr(0, equals));
    if (option == nullptr || option->value.empty()) return {};
    Candidates result = values_of(*option, typed.substr(equals + 1), case_file);
    for (Candidate& candidate : result) candidate.word.insert(0, typed.substr(0, equals + 1));
    return result;
  }
  if (typed.starts_with('-')) return options_of(command);
  const auto positional = std::ranges::find_if(command.options, &DescribedOption::is_positional);
  if (positional == command.options.end() || (!positional->many && !before.positionals.empty())) return {};
  const bool resumes = std::ranges::find(words, "--resume") != words.end();
  if (resumes && positional->value == "CASE.toml") return folders(typed);
  return values_of(*positional, typed, case_file);
}

}  // namespace

std::vector<Candidate> complete(const DescribedCommand& program, const std::vector<std::string>& words) {
  const std::string typed = words.empty() ? "" : words.back();
  Candidates result;
  if (words.size() > 1) {
    if (const DescribedCommand* command = find_command(program, words.front()))
      result = of_command(*command, {words.begin() + 1, words.end()});
  } else if (typed.starts_with('-')) {
    result = options_of(program);
  } else {
    for (const DescribedCommand& command : program.commands) result.push_back({command.name, command.doc});
  }
  std::erase_if(result, [&](const Candidate& candidate) { return !candidate.word.starts_with(typed); });
  std::ranges::sort(result, {}, &Candidate::word);
  return result;
}

}  // namespace ricochet::program
