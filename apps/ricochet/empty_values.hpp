#pragma once

#include <string>

namespace CLI {
class App;
}

/// @file Values on the command line that are empty, and words that are no command.
namespace ricochet::program {

/// Makes an empty value, as from an unset variable of the shell, a usage error: it must not stand for the default.
/// Titles and labels may be empty.
void refuse_empty_values(CLI::App& app);

/// Refuses a first word that is neither an option nor a command: a case file, or a command that is misspelt.
void refuse_unknown_command(CLI::App& app, const std::string& word);

}  // namespace ricochet::program
