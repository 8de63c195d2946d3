#pragma once

#include <string>

namespace ricochet {

/// Returns the Python that the environment variable RICOCHET_PYTHON names; without it Debian's, for which meshio and
/// matplotlib are packaged, and on other systems the first one found.
[[nodiscard]] std::string python_program();

}  // namespace ricochet
