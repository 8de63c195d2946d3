#pragma once

/// @file Standard input, output and error: streams that the caller has closed, and output that cannot be written.
namespace ricochet::program {

/// Opens /dev/null as each of the descriptors 0 to 2 that is closed. Must be called in main() before any file is
/// opened: else the next file would get this descriptor, and messages would be written into results.
void open_closed_streams();

/// For commands that print results. Throws Error(file_access) if standard output was closed.
void require_standard_output();

/// Flushes standard output. Throws Error(file_access) if it cannot be written.
void flush_standard_output();
/// Returns true if some output could not be written to standard output.
[[nodiscard]] bool standard_output_failed();

}  // namespace ricochet::program
