#pragma once

#include <cstddef>

/// @file The machine's memory.
namespace ricochet {

/// Memory that this process may use, in bytes: the machine's, or the limit of its control group where that is less.
[[nodiscard]] double physical_memory();

/// The most that this process has had, in bytes.
[[nodiscard]] double peak_memory();

/// Gives back to the system what has been freed but is kept for later allocations. Before the largest ones: theirs come
/// from the system, and would be added to what is kept.
void release_freed_memory();

/// So many bytes, in huge pages (Linux: madvise) where they are many and the system has such pages. Throws
/// std::bad_alloc.
[[nodiscard]] void* allocate_large(std::size_t bytes);
void free_large(void* memory);

}  // namespace ricochet
