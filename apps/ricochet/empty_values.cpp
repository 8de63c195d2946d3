#include "empty_values.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet::program {

void refuse_empty_values(CLI::App& app) {
  const CLI::Validator given([](const std::string& value) { return value.empty() ? "the value is empty" : ""; }, "");
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() > 0 && option->get_type_name() != "TEXT") option->check(given);
    }
  }
}

void refuse_unknown_command(CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  if (word.empty() || word.starts_with('-') || std::find(names.begin(), names.end(), word) != names.end()) return;
  if (word.ends_with(".toml")) {
    throw Error(ErrorKind::usage,
                fmt::format("a command is missing: write `ricochet run {0}`, or one of the commands that "
                            "`ricochet --help` lists",
                            word));
  }
  const std::string near = nearest_name(word, names);
  throw Error(ErrorKind::usage, fmt::format("there is no command \"{}\"; {}", word,
                                            near.empty() ? "the commands are " + join_names(names)
                                                         : fmt::format("did you mean \"{}\"?", near)));
}

}  // namespace ricochet::program
