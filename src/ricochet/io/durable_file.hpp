#pragma once

#include <cstdint>
#include <string>

/// @file Reading and writing of whole files that survive a power failure, for data that must be on the disk before
/// something else relies on it.
namespace ricochet {

/// Waits until the written content of a file (or a directory's list of names) is on the disk. Throws
/// Error(file_access).
void sync_to_disk(const std::string& path);

/// Writes a file under a temporary name, waits until it is on the disk, and renames it: a reader, also after a restart
/// of the machine, sees either the old file or the new one. Throws Error(file_access); the old file then still exists.
void write_durably(const std::string& path, const std::string& content);

/// Content of a file. Throws Error(file_access).
[[nodiscard]] std::string read_file(const std::string& path);

/// Throws Error(file_access) if a file is missing or shorter than when a checkpoint was written.
void require_length(const std::string& path, std::int64_t length);

/// Truncates a file to an earlier length. Throws Error(file_access) if it is missing or shorter.
void truncate_file(const std::string& path, std::int64_t length);

/// Ensures that a file can grow by so many bytes, if the file system supports this. Throws Error(file_access), with the
/// file unchanged, if the disk is full.
void reserve_space(const std::string& path, std::int64_t bytes);

/// Throws Error(file_access): "PATH: cannot WHAT: " and errno in words.
[[noreturn]] void throw_file_error(const std::string& path, const char* what, int error_number);

}  // namespace ricochet
