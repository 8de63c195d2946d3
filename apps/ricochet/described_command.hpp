#pragma once

#include <string>
#include <string_view>
#include <vector>

/// @file The command line as data, for what is made from it: the manual page and the completion of shells. main.cpp
/// makes it from the parser's own tables, so that neither can say what the program does not know.
namespace ricochet::program {

struct DescribedOption {
  std::vector<std::string> names;  ///< "-o", "--output"; empty for a positional
  std::string value;               ///< what its value is called ("DIR"); empty for a flag
  std::string doc;
  bool required = false;
  bool many = false;  ///< a positional that takes all that follow

  [[nodiscard]] bool is_positional() const { return names.empty(); }
};

struct DescribedCommand {
  std::string name;
  std::string doc;
  std::string footer;
  std::vector<DescribedOption> options;
  std::vector<DescribedCommand> commands = {};
};

/// The command or option of that name, or nullptr.
[[nodiscard]] const DescribedCommand* find_command(const DescribedCommand& parent, std::string_view name);
[[nodiscard]] const DescribedOption* find_option(const DescribedCommand& command, std::string_view name);

}  // namespace ricochet::program
