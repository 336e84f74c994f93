// The man page, with the macros of man(7).
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "manual/manual.h"

namespace seedframe {
namespace {

/// Text that roff takes as it is: no commands at the start of a line, hyphens that can be copied.
std::string roff(const std::string& text) {
  std::string roff;
  for (const char c : text) {
    if (c == '\n') {
      roff += "\n.br\n";
    } else if (c == '\\') {
      roff += "\\e";
    } else if (c == '-') {
      roff += "\\-";
    } else {
      const bool starts_line = roff.empty() || roff.back() == '\n';
      if (starts_line && (c == '.' || c == '\'')) roff += "\\&";
      roff += c;
    }
  }
  return roff;
}

/// A term in bold, and what it means below it.
std::string term(const std::string& name, const std::string& meaning) {
  return fmt::format(".TP\n{}\n{}\n", name, roff(meaning));
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

std::string synopsis(const CommandText& command) {
  std::string line = bold(fmt::format("{}", fmt::join(command.path, " ")));
  if (!command.verbs.empty()) line += " " + italic("VERB");
  for (const OptionText& argument : command.arguments) {
    const std::string name = italic(argument.value) + (argument.repeated ? "..." : "");
    line += argument.required ? " " + name : fmt::format(" [{}]", name);
  }
  return line + fmt::format(" [{}]...", italic("OPTION"));
}

std::string meaning_of(const OptionText& option) {
  std::string help = option.help;
  const std::string value = fmt::format("{}", fmt::join(option.words, ", "));
  // A list in the help names the words already.
  if (!value.empty() && help.find('\n') == std::string::npos) {
    help += fmt::format("; one of {}", value);
  }
  if (!option.default_value.empty() && !option.value.empty()) {
    help += fmt::format(" (default: {})", option.default_value);
  }
  return help;
}

std::string options_of(const CommandText& command) {
  std::string text;
  for (const OptionText& argument : command.arguments) {
    text += term(italic(argument.value), meaning_of(argument));
  }
  for (const OptionText& option : command.options) {
    std::vector<std::string> names;
    for (const std::string& name : option.names) names.push_back(bold(name));
    std::string line = fmt::format("{}", fmt::join(names, ", "));
    if (!option.value.empty()) line += " " + italic(option.value);
    text += term(line, meaning_of(option));
  }
  return text;
}

std::string section_of(const CommandText& verb) {
  std::string text =
      fmt::format(".SS {}\n{}\n.PP\n{}\n", roff(verb_path(verb)), synopsis(verb), roff(verb.help));
  text += options_of(verb);
  if (!verb.example.empty()) {
    text += fmt::format(".PP\nExample:\n.PP\n.in +4n\n.EX\n{}\n.EE\n.in\n", roff(verb.example));
  }
  for (const CommandText& below : verb.verbs) text += section_of(below);
  return text;
}

std::string on_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string terms(const std::string& title, const ManualNotes::Terms& list) {
  std::string text = fmt::format(".SH {}\n", title);
  for (const auto& [name, meaning] : list) text += term(bold(name), meaning);
  return text;
}

}  // namespace

std::string man_page(const CommandText& program, const ManualNotes& notes) {
  std::string page = fmt::format(
      ".\\\" Made by 'seedframe manual man'.\n.TH SEEDFRAME 1 \"\" \"seedframe {}\" \"User "
      "Commands\"\n.nh\n.ad l\n",
      notes.version);
  page += ".SH NAME\nseedframe \\- labelled image datasets from a scene description and a seed\n";
  page += fmt::format(".SH SYNOPSIS\n{}\n.SH DESCRIPTION\n{}\n", synopsis(program),
                      roff(on_one_line(program.help)));
  page += ".SH OPTIONS\n" + options_of(program);
  page += ".SH VERBS\n";
  for (const CommandText& verb : program.verbs) page += section_of(verb);
  page += terms("EXIT STATUS", notes.exit_codes);
  page += terms("ENVIRONMENT", notes.environment);
  page += terms("FILES", notes.files);
  return page;
}

}  // namespace seedframe
