#pragma once

#include <string>

/// @file Checks whether a path can be read as a file, and reading of whole files.
namespace ricochet {

/// Returns why a file must not be read at all: it is a directory, a device (which may have no end), a pipe or a socket
/// (where reading may wait for a writer forever, and which cannot be read twice), or begins with zeros alone. No format
/// does so except binary STL, whose `header` of so many bytes may be anything; a damaged file may hold gigabytes of
/// zeros. Empty if none of these is found; opening the file reports one that is missing or may not be read.
[[nodiscard]] std::string unreadable_reason(const std::string& path, int header = 0);

/// Returns the content of a file that the message calls `noun`. Throws Error(file_access).
[[nodiscard]] std::string read_input(const std::string& path, const std::string& noun, int header = 0);

}  // namespace ricochet
