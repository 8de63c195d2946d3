#pragma once

#include <cstddef>

/// @file The machine's memory.
namespace ricochet {

/// Memory that this process may use, in bytes: the machine's, or the limit of its control group if that is less.
[[nodiscard]] double physical_memory();

/// Largest memory that this process has used so far, in bytes.
[[nodiscard]] double peak_memory();

/// Returns freed memory, kept for later allocations, to the system. Called before the largest allocations, which come
/// from the system and would add to the memory that is kept.
void release_freed_memory();

/// Allocates so many bytes, in huge pages (Linux: madvise) if they are many and the system has such pages. Throws
/// std::bad_alloc.
[[nodiscard]] void* allocate_large(std::size_t bytes);
void free_large(void* memory);

}  // namespace ricochet
