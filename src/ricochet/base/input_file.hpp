#pragma once

#include <string>

/// @file Is there something to be read from a path?
namespace ricochet {

/// Why a file is not to be read at all: it is a directory, a device (which may have no end), a pipe or a socket (where
/// the reading would wait for who writes, for ever perhaps, and which cannot be read twice), or begins with nothing but
/// zeros, which no format does but binary STL, whose `header` of so many bytes may be anything, and may have gigabytes
/// of them. Empty: it may be read, as far as this can tell; a
/// file that is not there or may not be read says so when it is opened.
[[nodiscard]] std::string why_no_input(const std::string& path, int header = 0);

}  // namespace ricochet
