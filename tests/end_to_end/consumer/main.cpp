#include <cstdio>

#include "ricochet/case/read_case.hpp"
#include "ricochet/run/run_case.hpp"
#include "ricochet/version.hpp"

int main(int, char** arguments) {
  const ricochet::Case input = ricochet::read_case(arguments[1]);
  const ricochet::RunSummary summary = ricochet::run_case(input, {arguments[2], false, true});
  std::printf("ricochet %s: %s, %ld steps\n", ricochet::version, summary.status.c_str(), summary.steps);
}
