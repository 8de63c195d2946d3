#pragma once

/// @file The machine's memory.
namespace ricochet {

/// Memory that this process may use, in bytes: the machine's, or the limit of its control group where that is less.
[[nodiscard]] double physical_memory();

}  // namespace ricochet
