#include "completion_of_keys.hpp"

#include <algorithm>
#include <fstream>

#include "ricochet/base/error.hpp"
#include "ricochet/base/input_file.hpp"
#include "ricochet/case/keys.hpp"

namespace ricochet::program {

namespace {

/// Returns the entries of a list or a named section in a case file, as in key paths. The file may be incomplete and is
/// not parsed: only its headings are searched.
std::vector<std::string> entries_of(const Section& section, const std::string& case_file) {
  std::vector<std::string> result;
  if (!unreadable_reason(case_file).empty()) return result;
  std::ifstream file(case_file);
  for (std::string line; std::getline(file, line);) {
    line.erase(std::remove_if(line.begin(), line.end(), [](char c) { return c == ' ' || c == '\t'; }), line.end());
    if (section.kind == SectionKind::list && line.starts_with("[[" + section.name + "]]"))
      result.push_back(std::to_string(result.size()));
    if (section.kind != SectionKind::named || !line.starts_with("[" + section.name + ".")) continue;
    const std::string name = line.substr(section.name.size() + 2,
                                         line.find_first_of(".]", section.name.size() + 2) - section.name.size() - 2);
    if (std::ranges::find(result, name) == result.end()) result.push_back(name);
  }
  return result;
}

void add_keys(const std::string& path, const std::vector<Key>& keys, std::vector<Candidate>& result) {
  for (const Key& key : keys) {
    if (key.type == KeyType::table) {
      add_keys(path + key.name + ".", key.keys, result);
    } else if (key.type == KeyType::parameters || key.type == KeyType::conditions) {
      result.push_back({path + key.name + ".", key.doc});
    } else {
      result.push_back({path + key.name, key.doc});
    }
  }
}

std::vector<std::string> named_values(const Key& key) {
  if (key.type == KeyType::flag) return {"true", "false"};
  return key.type == KeyType::components || key.type == KeyType::names ? std::vector<std::string>{} : key.choices;
}

/// `equals` is the position of the equals sign. `--vary` accepts several values, separated by commas.
std::vector<Candidate> values_of(const std::string& typed, std::size_t equals) try {
  std::vector<Candidate> result;
  const KeyPath found = parse_key_path(typed.substr(0, equals));
  if (found.key == nullptr || !found.member.empty()) return result;
  const std::string before = typed.substr(0, typed.find_last_of("=,") + 1);
  for (const std::string& value : named_values(*found.key)) result.push_back({before + value});
  return result;
} catch (const Error&) {
  return {};  // no such key: the run will report it
}

}  // namespace

std::vector<Candidate> keys_of(const std::string& case_file) {
  std::vector<Candidate> result;
  for (const Section& section : case_sections()) {
    if (section.kind == SectionKind::top || section.kind == SectionKind::table) {
      add_keys(section.kind == SectionKind::top ? "" : section.name + ".", section.keys, result);
      continue;
    }
    for (const std::string& entry : entries_of(section, case_file))
      add_keys(section.name + "." + entry + ".", section.keys, result);
  }
  return result;
}

std::vector<Candidate> settings_of(const std::string& case_file, const std::string& typed) {
  if (const std::size_t equals = typed.find('='); equals != std::string::npos) return values_of(typed, equals);
  std::vector<Candidate> result = keys_of(case_file);
  for (Candidate& candidate : result) {
    if (!candidate.word.ends_with('.')) candidate.word += '=';
  }
  return result;
}

}  // namespace ricochet::program
