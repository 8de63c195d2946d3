#pragma once

#include <cstdint>
#include <string>

/// @file Whole files: read, and written so that they survive a power cut, what must be on the disk before something
/// else relies on it.
namespace ricochet {

/// Waits until what has been written to a file (or a directory's list of names) is on the disk. Throws
/// Error(file_access).
void sync_to_disk(const std::string& path);

/// Writes a file under a temporary name, waits until it is on the disk, and moves it into place: a reader, and a
/// machine that is switched on again, sees the old file or the new one. Throws Error(file_access); the old file is then
/// still there.
void write_durably(const std::string& path, const std::string& content);

/// All of a file. Throws Error(file_access).
[[nodiscard]] std::string read_file(const std::string& path);

/// Throws Error(file_access) where a file is missing or shorter than it was when a checkpoint was written.
void require_length(const std::string& path, std::int64_t length);

/// Cuts a file back to a length it had before. Throws Error(file_access) where it is missing or shorter.
void cut_back(const std::string& path, std::int64_t length);

/// Makes sure that a file can grow by so many bytes, where the file system can tell. Throws Error(file_access) where
/// the disk is full, and nothing has happened to the file.
void reserve_space(const std::string& path, std::int64_t bytes);

/// Error(file_access): "PATH: cannot WHAT: " and errno in words.
[[noreturn]] void throw_file_error(const std::string& path, const char* what, int error_number);

}  // namespace ricochet
