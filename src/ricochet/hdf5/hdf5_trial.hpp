#pragma once

#include <string>

/// @file Damaged HDF5 files: the library (1.10) crashes on some of them, so that they are read by a child first.
namespace ricochet {

/// Opens, in a child, all that a file holds, and reads the first megabytes of it, as readers do. Throws
/// Error(invalid_input) where that crashes, does not come to an end, or the file or a group cannot be opened; what is
/// wrong with a single data set is left to whoever reads it. A file that has not changed since is not looked at again.
void try_hdf5_file(const std::string& path);

}  // namespace ricochet
