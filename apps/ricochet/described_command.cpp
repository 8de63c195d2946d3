#include "described_command.hpp"

#include <algorithm>

namespace ricochet::program {

const DescribedCommand* find_command(const DescribedCommand& parent, std::string_view name) {
  const auto found = std::ranges::find(parent.commands, name, &DescribedCommand::name);
  return found == parent.commands.end() ? nullptr : &*found;
}

const DescribedOption* find_option(const DescribedCommand& command, std::string_view name) {
  const auto found = std::ranges::find_if(command.options, [name](const DescribedOption& option) {
    return std::ranges::find(option.names, name) != option.names.end();
  });
  return found == command.options.end() ? nullptr : &*found;
}

}  // namespace ricochet::program
