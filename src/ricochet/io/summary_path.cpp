#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/json.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/io/summary.hpp"

namespace ricochet {

namespace {

bool allows(const Json& schema, std::string_view type) {
  const Json& types = schema.at("type");
  if (!types.is_array()) return types.get<std::string>() == type;
  return std::ranges::any_of(types, [&](const Json& one) { return one.get<std::string>() == type; });
}

/// Returns the paths that continue one by an entry and a rest; `rest` begins with a dot or is empty.
std::vector<std::string> continued(const std::string& done, const Json& entries, const std::string& rest) {
  std::vector<std::string> paths;
  for (const auto& [name, schema] : entries.items()) paths.push_back(done + name + rest);
  return paths;
}

std::string no_entry(const std::string& path, const std::string& near, const std::string& otherwise) {
  return fmt::format("summary.json has no entry \"{}\"; {}", path,
                     near.empty() ? otherwise : fmt::format("did you mean \"{}\"?", near));
}

std::string problem_from(const std::string& path, std::size_t at, const Json& schema);

/// Returns the problem of a path whose part between these positions is not the number of an entry of a list, with an
/// example that has no problem if there is one.
std::string no_number(const std::string& path, std::size_t begin, std::size_t end, const Json& entry) {
  const bool is_negative = path[begin] == '-' && is_digits(path.substr(begin + 1, end - begin - 1), 1);
  const std::string problem = fmt::format("summary.{} is a list: specify the entry, counted from 0{}",
                                          path.substr(0, begin - 1), is_negative ? ", not from the end" : "");
  for (const std::string& rest : {"." + path.substr(begin), path.substr(end)}) {
    const std::string example = path.substr(0, begin) + "0" + rest;
    if (problem_from(example, begin + 2, entry).empty()) return fmt::format("{}, as in summary.{}", problem, example);
  }
  return problem;
}

/// Follows a path from the part at `at`, which `schema` outlines.
std::string problem_from(const std::string& path, std::size_t at, const Json& schema) {
  if (at > path.size())
    return allows(schema, "number") || allows(schema, "integer") ? "" : fmt::format("summary.{} is not a number", path);
  const std::string done = path.substr(0, at);
  const std::size_t end = std::min(path.find('.', at), path.size());
  const std::string name = path.substr(at, end - at), rest = path.substr(end);
  if (schema.contains("properties")) {
    const Json& entries = schema.at("properties");
    if (entries.contains(name)) return problem_from(path, end + 1, entries.at(name));
    std::vector<std::string> names;
    for (const auto& [known, ignored] : entries.items()) names.push_back(known);
    return no_entry(path, nearest_name(path, continued(done, entries, rest)),
                    fmt::format("{} has {}", at == 0 ? "it" : done.substr(0, at - 1), join_names(names)));
  }
  if (schema.contains("items")) {
    if (is_digits(name, 1, 9)) return problem_from(path, end + 1, schema.at("items"));
    return no_number(path, at, end, schema.at("items"));
  }
  if (!schema.contains("additionalProperties"))
    return no_entry(path, "", fmt::format("{} has no entries", done.substr(0, at - 1)));
  // The name of a column contains dots; it ends at one of them.
  std::string problem = problem_from(path, end + 1, schema.at("additionalProperties"));
  for (std::size_t dot = end; !problem.empty() && dot < path.size();) {
    dot = std::min(path.find('.', dot + 1), path.size());
    if (dot < path.size()) problem = problem_from(path, dot + 1, schema.at("additionalProperties"));
  }
  return problem;
}

}  // namespace

std::string summary_path_problem(const std::string& path) {
  return problem_from(path, 0, Json::parse(summary_schema()));
}

}  // namespace ricochet
