#pragma once

#include <string>

namespace ricochet {

/// The Python that the environment variable RICOCHET_PYTHON names. Without it Debian's, for which meshio and matplotlib
/// are packaged; elsewhere the one that is found first.
[[nodiscard]] std::string python_program();

}  // namespace ricochet
