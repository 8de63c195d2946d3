#include <cstdio>

#include "commands.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"

namespace ricochet::program {

int schema(const SchemaArguments& arguments) {
  const std::string text = arguments.columns    ? column_reference()
                           : arguments.summary  ? summary_schema()
                           : arguments.markdown ? case_reference()
                                                : case_schema();
  std::fputs(text.c_str(), stdout);
  return 0;
}

}  // namespace ricochet::program
