#include "ricochet/case/read_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "ricochet/base/error.hpp"
#include "ricochet/base/input_file.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/case/keys_check.hpp"
#include "ricochet/case/keys_override.hpp"
#include "ricochet/case/read_sections.hpp"
#include "ricochet/mesh/read_mesh.hpp"

namespace ricochet {

namespace {

std::string read_text(const std::string& path) {
  const auto fail = [&path](const std::string& why) {
    throw Error(ErrorKind::file_access, fmt::format("{}: cannot be read: {}", path, why));
  };
  if (const std::string why = unreadable_reason(path); !why.empty()) fail(why + ", not a case file");
  constexpr std::uintmax_t longest = 64u << 20;
  std::error_code unknown;
  if (const std::uintmax_t size = std::filesystem::file_size(path, unknown); !unknown && size > longest)
    fail(fmt::format("its size is {} MB: case files are texts of a few kB", size >> 20));
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail(std::strerror(errno));
  std::string text(std::istreambuf_iterator<char>(stream), {});
  return text;
}

/// Refuses a mesh in place of a case.
void refuse_mesh(const std::string& path) {
  const bool is_mesh =
      std::filesystem::path(path).extension() == ".msh" || is_foreign_mesh(path) || needs_gmsh_program(path);
  if (!is_mesh) return;
  throw Error(ErrorKind::invalid_input,
              fmt::format("{0}: a mesh or a geometry, not a case: a case file names it as \"file\" of its [mesh]; "
                          "`ricochet info {0}` describes it",
                          path));
}

// Lists locations and texts below a node. Vectors and lists of names are one value, lists of tables are not.
void list_values(const TomlNode& node, const std::string& path, Case& result) {
  if (node.is_ignored) return;
  if (!path.empty() && !node.is_default) result.locations[path] = node.location;
  if (!node.is_table() && !node.is_list_of_tables()) {
    result.values[path] = value_text(node);
    return;
  }
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    const TomlNode& child = node.children[i];
    const std::string name = node.is_table() ? child.key : std::to_string(i);
    list_values(child, path.empty() ? name : path + "." + name, result);
  }
}

bool is_identifier(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Returns whether the name is a word of a text below a node.
bool mentions(const TomlNode& node, const std::string& name) {
  for (std::size_t at = node.text.find(name); at != std::string::npos; at = node.text.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if ((at == 0 || !is_identifier(node.text[at - 1])) && (end == node.text.size() || !is_identifier(node.text[end])))
      return true;
  }
  return std::ranges::any_of(node.children,
                             [&](const TomlNode& child) { return child.key != "parameters" && mentions(child, name); });
}

/// Warns, as a misspelt parameter of --set would leave the old value in effect.
void warn_of_unused_parameters(const TomlNode& node, Problems& problems) {
  for (const TomlNode& child : node.children) {
    if (child.key != "parameters" || !child.is_table()) {
      warn_of_unused_parameters(child, problems);
      continue;
    }
    for (const TomlNode& parameter : child.children) {
      if (mentions(node, parameter.key)) continue;
      problems.add_warning(parameter.key_location,
                           fmt::format("no formula of this section uses the parameter \"{}\"", parameter.key));
    }
  }
}

// `when` compares with the values in effect, wherever they come from.
void list_effective_values(const std::string& path, const Section& section, const Parameters& parameters,
                           Case& result) {
  for (const TypeKeys& type : section.types) {
    for (const Key& key : type.keys) {
      if (!parameters.has(key.name)) result.values.erase(path + "." + key.name);
    }
  }
  for (const auto& [name, value] : parameters.values()) result.values[path + "." + name] = as_text(value);
}

}  // namespace

Case read_case(const std::string& path, const std::vector<std::string>& overrides) {
  const std::string text = read_text(path);
  refuse_mesh(path);
  return read_case_text(text, path, overrides);
}

Case read_case_text(const std::string& text, const std::string& path, const std::vector<std::string>& overrides) {
  Case result;
  result.path = path;
  TomlNode root = parse_toml(text, path);
  Problems problems;
  result.overridden = apply_overrides(root, overrides, problems);
  check_tree(root, problems);
  read_sections(root, result, problems);
  problems.raise();
  warn_of_unused_parameters(root, problems);
  list_values(root, "", result);
  list_effective_values("time", *find_section("time"), result.time.parameters, result);
  for (std::size_t i = 0; i < result.contacts.size(); ++i)
    result.values[fmt::format("contact.{}.sliding", i)] = result.contacts[i].large_sliding ? "large" : "small";
  problems.log_remarks();
  return result;
}

}  // namespace ricochet
