#pragma once

#include <string>

namespace ricochet {

/// Debian's Python, for which meshio and matplotlib are packaged; elsewhere the one that is found first.
[[nodiscard]] std::string python_program();

}  // namespace ricochet
