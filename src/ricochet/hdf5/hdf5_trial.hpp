#pragma once

#include <string>

/// @file Damaged HDF5 files. The library (1.10) crashes on some of them, so a child process reads them first.
namespace ricochet {

/// Opens everything that a file contains in a child process and reads its first megabytes, as readers do. Throws
/// Error(invalid_input) if that crashes or does not end, or if the file or a group cannot be opened; errors of a single
/// data set are left to its reader. A file that has not changed since the last trial is not tried again.
void try_hdf5_file(const std::string& path);

}  // namespace ricochet
