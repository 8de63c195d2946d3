#include <cstdio>

#include "commands.hpp"
#include "ricochet/case/read_case.hpp"

namespace ricochet::program {

int schema(bool markdown) {
  std::fputs((markdown ? case_reference() : case_schema()).c_str(), stdout);
  return 0;
}

}  // namespace ricochet::program
