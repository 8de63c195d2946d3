#include "ricochet/base/python.hpp"

#include <unistd.h>

#include <cstdlib>

namespace ricochet {

std::string python_program() {
  if (const char* named = std::getenv("RICOCHET_PYTHON"); named != nullptr && *named != '\0') return named;
  const std::string own = "/usr/bin/python3";
  return access(own.c_str(), X_OK) == 0 ? own : "python3";
}

}  // namespace ricochet
