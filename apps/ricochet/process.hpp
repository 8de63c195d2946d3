#pragma once

#include <string>

namespace CLI {
class App;
}

/// @file The process of a program: its memory, its standard streams, its command line.
namespace ricochet::program {

/// Restarts the program without threads of OpenBLAS if memory is limited. OpenBLAS starts its threads when it is
/// loaded; a thread that gets no memory requests it for ever, takes the memory that others release, and does not end.
void restart_without_blas_threads(char** argv);

/// Keeps released memory in the process. Matrices of contact points are allocated and released in every iteration of a
/// step; returning memory to the system each time, and receiving it as pages of zeros, costs as much as the products.
void keep_memory();

/// Opens /dev/null as each of the descriptors 0 to 2 that is closed. Must be called in main() before any file is
/// opened: else the next file would get this descriptor, and messages would be written into results.
void open_closed_streams();

/// For commands that print results. Throws Error(file_access) if standard output was closed.
void require_standard_output();

/// Flushes standard output. Throws Error(file_access) if it cannot be written.
void flush_standard_output();
/// Returns true if some output could not be written to standard output.
[[nodiscard]] bool standard_output_failed();

/// Makes an empty value on the command line, as from an unset variable of the shell, a usage error: it must not stand
/// for the default. Titles and labels may be empty.
void refuse_empty_values(CLI::App& app);

/// Refuses a first word that is neither an option nor a command: a case file, or a command that is misspelt.
void refuse_unknown_command(CLI::App& app, const std::string& word);

}  // namespace ricochet::program
