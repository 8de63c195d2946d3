#pragma once

#include <string>

#include "described_command.hpp"

/// @file The part of ricochet(1) that describes commands and options, in roff's man macros.
namespace ricochet::program {

/// Returns a section for the program's own options and one for all commands, each with its synopsis, options and exit
/// statuses.
[[nodiscard]] std::string manual_of_commands(const DescribedCommand& program);

}  // namespace ricochet::program
