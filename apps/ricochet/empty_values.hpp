#pragma once

namespace CLI {
class App;
}

/// @file Values that are empty on the command line.
namespace ricochet::program {

/// Makes an empty value, as from an unset variable of the shell, a usage error: it must not stand for the default.
/// Titles and labels may be empty.
void refuse_empty_values(CLI::App& app);

}  // namespace ricochet::program
