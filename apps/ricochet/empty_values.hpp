#pragma once

namespace CLI {
class App;
}

/// @file Values that are empty on the command line.
namespace ricochet::program {

/// An empty value, as of a variable of the shell that is not set, is wrong use: it must not stand for the default.
/// Titles and labels may be empty.
void refuse_empty_values(CLI::App& app);

}  // namespace ricochet::program
