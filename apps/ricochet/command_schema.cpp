#include <cstdio>

#include "commands.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"

namespace ricochet::program {

int schema(bool markdown, bool columns) {
  std::fputs((columns ? column_reference() : markdown ? case_reference() : case_schema()).c_str(), stdout);
  return 0;
}

}  // namespace ricochet::program
