// Fish: a line for each verb, option and argument, under the condition that its verb was named.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "manual/manual.h"

namespace seedframe {
namespace {

std::string quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "'";
}

std::string line_for(const CommandText& command, const std::string& rest) {
  return fmt::format("complete -c seedframe -n {} {}\n",
                     quoted("__seedframe_at " + quoted(verb_path(command))), rest);
}

/// -x: no files besides; -F: files.
std::string offer_arguments(const OptionText& option) {
  switch (option.offer) {
    case Offer::kWords:
      return fmt::format(" -x -a {}", quoted(fmt::format("{}", fmt::join(option.words, " "))));
    case Offer::kFolders:
      return " -x -a '(__fish_complete_directories (commandline -ct))'";
    case Offer::kFiles:
      return " -r -F";
    case Offer::kConfigs:
      return " -x -a '(__fish_complete_suffix .yaml)'";
    case Offer::kNothing:
      return " -x";
  }
  return " -x";
}

std::string option_line(const CommandText& command, const OptionText& option) {
  std::string rest;
  for (const std::string& name : option.names) {
    rest += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (!option.value.empty()) rest += offer_arguments(option);
  return line_for(command, rest.substr(1) + " -d " + quoted(short_help(option.help)));
}

/// Fish knows no order of arguments: what the first of them may be is offered for all.
std::string argument_line(const CommandText& command) {
  if (command.arguments.empty()) return {};
  const OptionText& argument = command.arguments.front();
  if (argument.offer == Offer::kNothing) return {};
  if (argument.offer == Offer::kFiles) return line_for(command, "-F");
  std::string offer = offer_arguments(argument);
  offer.replace(0, 3, "-f");
  return line_for(command, offer);
}

}  // namespace

std::string fish_completion(const CommandText& program) {
  std::string script =
      "# Completions of seedframe for fish, made by 'seedframe manual fish'.\n\n"
      "function __seedframe_at # verb: whether the words before the cursor have led there\n"
      "    set -l verb ''\n"
      "    for word in (commandline -opc)[2..-1]\n"
      "        switch \"$verb:$word\"\n";
  const std::vector<const CommandText*> commands = all_commands(program);
  for (const CommandText* command : commands) {
    for (const CommandText& verb : command->verbs) {
      const std::string path = verb_path(*command) + ":" + verb.name();
      script += fmt::format("            case {}\n                set verb {}\n", quoted(path),
                            quoted(verb_path(verb)));
    }
  }
  script +=
      "        end\n    end\n    test \"$verb\" = \"$argv[1]\"\nend\n\n"
      "complete -c seedframe -f\n";
  for (const CommandText* command : commands) {
    for (const CommandText& verb : command->verbs) {
      script += line_for(
          *command, fmt::format("-a {} -d {}", quoted(verb.name()), quoted(short_help(verb.help))));
    }
    for (const OptionText& option : command->options) script += option_line(*command, option);
    script += argument_line(*command);
  }
  return script;
}

}  // namespace seedframe
