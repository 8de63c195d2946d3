#pragma once

/// @file Standard input, output and error: those that the caller has closed, and output that cannot be written.
namespace ricochet::program {

/// In main(), before any file is opened. Opens /dev/null as each of the descriptors 0 to 2 that is closed: else the
/// next file that is opened has this descriptor, and messages are written into results.
void open_closed_streams();

/// For commands whose answer goes to standard output. Throws Error(file_access) where that was closed.
void require_standard_output();

/// Hands over what has been printed. Throws Error(file_access) where it cannot be written.
void flush_standard_output();
/// Could something not be written to standard output?
[[nodiscard]] bool standard_output_failed();

}  // namespace ricochet::program
