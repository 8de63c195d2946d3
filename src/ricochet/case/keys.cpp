#include "ricochet/case/keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> parts{""};
  for (const char character : path) {
    if (character == '.') {
      parts.emplace_back();
    } else {
      parts.back() += character;
    }
  }
  return parts;
}

std::string join_rest(const std::vector<std::string>& parts, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < parts.size(); ++i) text += (i > first ? "." : "") + parts[i];
  return text;
}

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::invalid_input, message); }

// Reads the part of a path that selects one entry of a list or one named section.
std::string entry_of(const Section& section, const std::vector<std::string>& parts) {
  if (section.kind == SectionKind::list) {
    const bool is_number = parts.size() > 1 && is_digits(parts[1], 1, 9);
    if (!is_number) {
      refuse(fmt::format("{} is a list: specify the entry, counted from 0, as in {}.0.{}", section_title(section),
                         section.name, section.keys.front().name));
    }
    // One entry has one name: otherwise two keys of a study, or of `when`, could be the same unnoticed.
    const std::string number = std::to_string(std::stol(parts[1]));
    if (number != parts[1]) {
      refuse(fmt::format("\"{}\" is not a valid number of an entry of {}: write {}, as in {}.{}.{}", parts[1],
                         section_title(section), number, section.name, number,
                         parts.size() > 2 ? join_rest(parts, 2) : section.keys.front().name));
    }
    return number;
  }
  if (parts.size() < 2 || !is_plain_name(parts[1])) {
    refuse(fmt::format("the sections {} have names: specify one, as in {}.floor.{}", section_title(section),
                       section.name, section.keys.front().name));
  }
  return parts[1];
}

// Follows a path from the key at parts[at].
void enter_key(const std::vector<std::string>& parts, std::size_t at, KeyPath& path) {
  const Key& key = *path.key;
  if (at + 1 == parts.size()) return;
  if (key.type == KeyType::table || key.type == KeyType::tables) {
    path.sub_table = key.name;
    if (key.type == KeyType::tables && is_digits(parts[at + 1], 1, 9) && at + 2 < parts.size())
      path.sub_entry = std::to_string(std::stol(parts[++at]));
    path.key = find_key(key.keys, parts[at + 1]);
    if (path.key == nullptr) {
      refuse(unknown_key_message(parts[at + 1], fmt::format("{}.{}", path.section->name, key.name), key.keys));
    }
    if (at + 2 == parts.size()) return;
  } else if (key.type == KeyType::parameters || key.type == KeyType::conditions) {
    path.sub_table = key.name;
    path.member = join_rest(parts, at + 1);
    return;
  }
  refuse(fmt::format("\"{}\" is {}: it has no key \"{}\"", path.key->name, admissible_values(*path.key), parts.back()));
}

}  // namespace

const Section* find_section(std::string_view name) {
  const std::vector<Section>& sections = case_sections();
  const auto found = std::ranges::find_if(
      sections, [name](const Section& section) { return section.kind != SectionKind::top && section.name == name; });
  return found != sections.end() ? &*found : nullptr;
}

const TypeKeys* find_type(const Section& section, std::string_view name) {
  const auto found = std::ranges::find_if(section.types, [name](const TypeKeys& type) { return type.name == name; });
  return found != section.types.end() ? &*found : nullptr;
}

const Key* find_key(const std::vector<Key>& keys, std::string_view name) {
  const auto found = std::ranges::find_if(keys, [name](const Key& key) { return key.name == name; });
  return found != keys.end() ? &*found : nullptr;
}

std::string section_title(const Section& section) {
  switch (section.kind) {
    case SectionKind::top:
      return "the top level of the file";
    case SectionKind::table:
      return fmt::format("[{}]", section.name);
    case SectionKind::list:
      return fmt::format("[[{}]]", section.name);
    case SectionKind::named:
      return fmt::format("[{}.NAME]", section.name);
  }
  return "";
}

std::string admissible_with_unit(const Key& key) {
  return key.unit.empty() || key.unit == "1" ? admissible_values(key)
                                             : fmt::format("{} (unit: {})", admissible_values(key), key.unit);
}

std::string nearest_key(std::string_view name, const std::vector<Key>& keys) {
  return nearest_name(name, names_of(keys));
}

std::string nearest_section(std::string_view name) {
  std::vector<std::string> names;
  for (const Section& section : case_sections()) {
    if (section.kind != SectionKind::top) names.push_back(section.name);
  }
  return nearest_name(name, names);
}

namespace {

/// Returns ` ("friction" is a key of [[contact]])` if one or two sections have a key of that name; else "". A name that
/// is also that of a section was not meant as a key.
std::string owners_of_key(std::string_view name) {
  constexpr std::size_t most_owners = 2;
  std::vector<std::string> titles;
  for (const Section& section : case_sections()) {
    if (section.kind != SectionKind::top && find_key(section.keys, name) != nullptr)
      titles.push_back(section_title(section));
  }
  if (titles.empty() || titles.size() > most_owners || find_section(name) != nullptr) return "";
  return fmt::format(" (\"{}\" is a key of {})", name, join_names(titles, " and of ", false));
}

}  // namespace

std::string unknown_key_message(std::string_view name, const std::string& title, const std::vector<Key>& keys) {
  const std::string near = nearest_key(name, keys);
  const std::string hint = near.empty() ? fmt::format("{} {}", keys.size() == 1 ? "its only key is" : "its keys are",
                                                      join_names(names_of(keys)))
                                        : fmt::format("did you mean \"{}\"?", near);
  return fmt::format("unknown key \"{}\" in {}{}; {}", name, title, owners_of_key(name), hint);
}

std::string unknown_section_message(std::string_view name) {
  std::vector<std::string> titles;
  for (const Section& section : case_sections()) {
    if (section.kind != SectionKind::top) titles.push_back(section_title(section));
  }
  const std::string near = nearest_section(name);
  const std::string hint = near.empty() ? fmt::format("the sections are {}", join_names(titles, " and ", false))
                                        : fmt::format("did you mean {}?", section_title(*find_section(near)));
  return fmt::format("unknown section \"{}\"; {}", name, hint);
}

std::string with_dotted_numbers(std::string_view path) {
  std::string text;
  while (true) {
    const std::size_t opening = path.find('['), closing = path.find(']', opening);
    if (closing == std::string_view::npos) return text + std::string(path);
    const std::string_view number = path.substr(opening + 1, closing - opening - 1);
    const bool is_number = is_digits(number, 1, 9);
    text += path.substr(0, is_number ? opening : closing + 1);
    if (is_number) text.append(".").append(number);
    path.remove_prefix(closing + 1);
  }
}

KeyPath parse_key_path(const std::string& text) {
  if (const std::string dotted = with_dotted_numbers(text); dotted != text)
    refuse(fmt::format("the number of an entry, counted from 0, follows a dot: write {}", dotted));
  const std::vector<std::string> parts = split(text);
  KeyPath path;
  path.section = find_section(parts[0]);
  std::size_t at = 0;
  if (path.section == nullptr) {
    path.section = &case_sections().front();
    if (find_key(path.section->keys, parts[0]) == nullptr) refuse(unknown_section_message(parts[0]));
  } else {
    at = 1;
    if (path.section->kind == SectionKind::list || path.section->kind == SectionKind::named) {
      path.entry = entry_of(*path.section, parts);
      at = 2;
    }
  }
  if (at >= parts.size()) {
    refuse(fmt::format("\"{}\" is a section: specify one of its keys, as in {}.{}", text, text,
                       path.section->keys.front().name));
  }
  path.key = find_key(path.section->keys, parts[at]);
  if (path.key == nullptr) refuse(unknown_key_message(parts[at], section_title(*path.section), path.section->keys));
  enter_key(parts, at, path);
  return path;
}

bool is_plain_name(std::string_view name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && std::ranges::all_of(name, is_plain);
}

}  // namespace ricochet
