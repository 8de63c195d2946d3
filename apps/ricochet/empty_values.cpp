#include "empty_values.hpp"

#include <CLI/CLI.hpp>
#include <string>

namespace ricochet::program {

void refuse_empty_values(CLI::App& app) {
  const CLI::Validator given([](const std::string& value) { return value.empty() ? "the value is empty" : ""; }, "");
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() > 0 && option->get_type_name() != "TEXT") option->check(given);
    }
  }
}

}  // namespace ricochet::program
