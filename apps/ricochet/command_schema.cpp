#include <cstdio>

#include "commands.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/io/summary.hpp"

namespace ricochet::program {

int schema(bool markdown, bool of_summary) {
  std::fputs((of_summary ? summary_schema() : markdown ? case_reference() : case_schema()).c_str(), stdout);
  return 0;
}

}  // namespace ricochet::program
