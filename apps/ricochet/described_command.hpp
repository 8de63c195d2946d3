#pragma once

#include <string>
#include <string_view>
#include <vector>

/// @file The command line as data, for the manual page and the completion of shells. main.cpp derives it from the
/// parser's own tables, so that neither can describe anything that the program does not support.
namespace ricochet::program {

struct DescribedOption {
  std::vector<std::string> names;  ///< "-o", "--output"; empty for a positional
  std::string value;               ///< name of its value ("DIR"); empty for a flag
  std::string doc;
  bool required = false;
  bool many = false;  ///< a positional that accepts all following words

  [[nodiscard]] bool is_positional() const { return names.empty(); }
};

struct DescribedCommand {
  std::string name;
  std::string doc;
  std::string footer;
  std::vector<DescribedOption> options;
  std::vector<DescribedCommand> commands = {};
};

/// Returns the command or option of that name, or null.
[[nodiscard]] const DescribedCommand* find_command(const DescribedCommand& parent, std::string_view name);
[[nodiscard]] const DescribedOption* find_option(const DescribedCommand& command, std::string_view name);

}  // namespace ricochet::program
