// Zsh: a function a verb, each a call of _arguments, which knows the rest.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "manual/manual.h"

namespace seedframe {
namespace {

/// Within single quotes, in a place where _arguments or _describe read ":", "[" and "]".
std::string escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\'') {
      escaped += "'\\''";
      continue;
    }
    if (c == ':' || c == '[' || c == ']' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string function_name(const CommandText& command) {
  return "_" + fmt::format("{}", fmt::join(command.path, "_"));
}

std::string action(const OptionText& option) {
  switch (option.offer) {
    case Offer::kWords:
      return fmt::format("({})", fmt::join(option.words, " "));
    case Offer::kFolders:
      return "_files -/";
    case Offer::kFiles:
      return "_files";
    case Offer::kConfigs:
      return "_files -g \"*.yaml\"";
    case Offer::kNothing:
      return " ";
  }
  return " ";
}

/// '(-o --output)'{-o+,--output=}'[help]:DIR:_files -/'
std::string option_line(const OptionText& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names) {
    names.push_back(name + (option.value.empty() ? "" : name.starts_with("--") ? "=" : "+"));
  }
  std::string text = fmt::format("[{}]", escaped(short_help(option.help)));
  if (!option.value.empty()) text += fmt::format(":{}:{}", escaped(option.value), action(option));
  const std::string before =
      option.repeated ? "*" : fmt::format("({})", fmt::join(option.names, " "));
  if (names.size() == 1) return fmt::format("'{}{}{}'", before, names.front(), text);
  return fmt::format("'{}'{{{}}}'{}'", before, fmt::join(names, ","), text);
}

std::string argument_line(const OptionText& argument) {
  return fmt::format("'{}:{}:{}'", argument.repeated ? "*" : "", escaped(argument.value),
                     action(argument));
}

std::string function_of(const CommandText& command) {
  std::string text = fmt::format("{}() {{\n", function_name(command));
  if (!command.verbs.empty()) {
    text += "  local curcontext=$curcontext state line\n  typeset -A opt_args\n";
  }
  text += fmt::format("  _arguments -s{}", command.verbs.empty() ? "" : " -C");
  for (const OptionText& option : command.options) text += " \\\n    " + option_line(option);
  for (const OptionText& argument : command.arguments)
    text += " \\\n    " + argument_line(argument);
  if (command.verbs.empty()) return text + "\n}\n\n";
  text += " \\\n    '1:verb:->verb' \\\n    '*::argument:->rest'\n  case $state in\n    verb)\n";
  text += "      local -a verbs=(\n";
  for (const CommandText& verb : command.verbs) {
    text += fmt::format("        '{}:{}'\n", verb.name(), escaped(short_help(verb.help)));
  }
  text +=
      "      )\n      _describe -t verbs verb verbs\n      ;;\n    rest)\n      case $words[1] "
      "in\n";
  for (const CommandText& verb : command.verbs) {
    text += fmt::format("        {}) {} ;;\n", verb.name(), function_name(verb));
  }
  return text + "      esac\n      ;;\n  esac\n}\n\n";
}

}  // namespace

std::string zsh_completion(const CommandText& program) {
  std::string script =
      "#compdef seedframe\n# Completions of seedframe for zsh, made by 'seedframe manual zsh'.\n\n";
  for (const CommandText* command : all_commands(program)) script += function_of(*command);
  // Called by the completion system when it has loaded the file; or sourced by hand.
  return script +
         "if [[ $funcstack[1] == _seedframe ]]; then\n  _seedframe \"$@\"\nelse\n"
         "  compdef _seedframe seedframe\nfi\n";
}

}  // namespace seedframe
