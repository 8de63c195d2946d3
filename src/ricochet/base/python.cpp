#include "ricochet/base/python.hpp"

#include <unistd.h>

namespace ricochet {

std::string python_program() {
  const std::string own = "/usr/bin/python3";
  return access(own.c_str(), X_OK) == 0 ? own : "python3";
}

}  // namespace ricochet
