#include "manual_page.hpp"

#include <fmt/format.h>

#include <map>
#include <string_view>

namespace ricochet::program {

namespace {

/// Escapes text for roff: hyphens are typeable, and no line begins like a request.
std::string roff(std::string_view text) {
  static const std::map<char, std::string_view> escapes{{'\\', "\\e"},  {'-', "\\-"},   {'`', "\\(ga"}, {'\'', "\\(aq"},
                                                        {'~', "\\(ti"}, {'^', "\\(ha"}, {'\n', " "}};
  std::string result;
  for (const char c : text) {
    const auto escape = escapes.find(c);
    result += escape != escapes.end() ? escape->second : std::string_view(&c, 1);
  }
  return result.starts_with('.') ? "\\&" + result : result;
}

std::string sentence(std::string text) {
  if (!text.empty() && text.back() != '.' && text.back() != '\n') text += '.';
  return roff(text);
}

std::string italic(const std::string& text) { return fmt::format("\\fI{}\\fP", roff(text)); }
std::string bold(const std::string& text) { return fmt::format("\\fB{}\\fP", roff(text)); }

/// Returns "-o DIR, --output DIR".
std::string title_of(const DescribedOption& option) {
  std::string title;
  for (const std::string& name : option.names) {
    if (!title.empty()) title += ", ";
    title += bold(name);
    if (!option.value.empty()) title += " " + italic(option.value);
  }
  return option.is_positional() ? italic(option.value) + (option.many ? " ..." : "") : title;
}

std::string roff_options(const DescribedCommand& command) {
  std::string text;
  for (const DescribedOption& option : command.options)
    text += fmt::format(".TP\n{}\n{}\n", title_of(option), sentence(option.doc));
  return text;
}

/// Returns "ricochet report DIR ... [options]".
std::string synopsis_of(const DescribedCommand& command) {
  std::string text = bold("ricochet " + command.name);
  for (const DescribedOption& option : command.options) {
    if (!option.is_positional()) continue;
    const std::string title = title_of(option);
    text += option.required ? " " + title : fmt::format(" [{}]", title);
  }
  return text + " [" + italic("options") + "]";
}

}  // namespace

std::string manual_of_commands(const DescribedCommand& program) {
  std::string text = ".SH OPTIONS\n" + roff_options(program) + ".SH COMMANDS\n";
  for (const DescribedCommand& command : program.commands) {
    text +=
        fmt::format(".SS {}\n.nh\n{}\n.hy\n.PP\n{}\n", roff(command.name), synopsis_of(command), sentence(command.doc));
    text += roff_options(command);
    // Commands without a footer of their own have that of the program, which is a section of the page.
    if (!command.footer.empty() && command.footer != program.footer) text += ".PP\n" + roff(command.footer) + "\n";
  }
  return text;
}

}  // namespace ricochet::program
