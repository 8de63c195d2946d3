#pragma once

#include <functional>
#include <string>
#include <vector>

/// @file Reading directories into which runs may be writing.
namespace ricochet {

/// Does what reads these directories; where that fails and a run goes on in one of them, again, a few times: what is
/// read while a frame is written may not fit together. Throws Error as `read` does, and then says that a run goes on.
void read_with_patience(const std::vector<std::string>& directories, const std::function<void()>& read);

}  // namespace ricochet
