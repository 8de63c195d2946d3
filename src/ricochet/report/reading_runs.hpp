#pragma once

#include <functional>
#include <string>
#include <vector>

/// @file Reading directories into which runs may be writing.
namespace ricochet {

/// Calls `read`, which reads these directories. If it fails while one of the runs is in progress, it is repeated a few
/// times, as data read during the output of a frame may be inconsistent. Throws Error as `read` does, then stating that
/// a run is in progress.
void read_with_retries(const std::vector<std::string>& directories, const std::function<void()>& read);

}  // namespace ricochet
