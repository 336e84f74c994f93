// Bash: one function that walks the words to the verb, then looks up what may follow. It needs
// nothing of the package bash-completion.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "manual/manual.h"

namespace seedframe {
namespace {

std::string offer_command(const OptionText& option) {
  switch (option.offer) {
    case Offer::kWords:
      return fmt::format("_seedframe_words '{}'", fmt::join(option.words, " "));
    case Offer::kFolders:
      return "_seedframe_files -d";
    case Offer::kFiles:
      return "_seedframe_files -f";
    case Offer::kConfigs:
      return "_seedframe_files -d; _seedframe_files -f -X '!*.yaml'";
    case Offer::kNothing:
      return ":";
  }
  return ":";
}

std::vector<std::string> names_of(const std::vector<CommandText>& verbs) {
  std::vector<std::string> names;
  names.reserve(verbs.size());
  for (const CommandText& verb : verbs) names.push_back(verb.name());
  return names;
}

std::vector<std::string> option_names(const CommandText& command) {
  std::vector<std::string> names;
  for (const OptionText& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

/// "verb:option) what is offered ;;" for each option with a value.
std::string value_cases(const CommandText& command) {
  std::string cases;
  for (const OptionText& option : command.options) {
    if (option.value.empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) {
      patterns.push_back(fmt::format("'{}:{}'", verb_path(command), name));
    }
    cases +=
        fmt::format("    {}) {}; return ;;\n", fmt::join(patterns, "|"), offer_command(option));
  }
  return cases;
}

/// What follows a verb when it is not an option: another verb, or the verb's arguments. Bash offers
/// the same for each of them: which one it is depends on what comes between.
std::string argument_case(const CommandText& command) {
  std::string offer = command.arguments.empty() ? ":" : offer_command(command.arguments.front());
  if (!command.verbs.empty()) {
    offer = fmt::format("_seedframe_words '{}'", fmt::join(names_of(command.verbs), " "));
  }
  return fmt::format("    '{}') {} ;;\n", verb_path(command), offer);
}

constexpr const char* kHelpers =
    R"(# Completions of seedframe for bash, made by 'seedframe manual bash'.

_seedframe_words() { # words: those that begin as the current one
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$1" -- "$current")
}

_seedframe_files() { # arguments of compgen: names of files that begin as the current word
  compopt -o filenames 2>/dev/null
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen "$@" -- "$current")
}

_seedframe() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb='' word
  COMPREPLY=()
  # Bash makes three words of --output=DIR.
  if [[ $current == = ]]; then
    current=''
  elif [[ $before == = ]]; then
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    case "$verb:$word" in
)";

}  // namespace

std::string bash_completion(const CommandText& program) {
  std::string script = kHelpers;
  const std::vector<const CommandText*> commands = all_commands(program);
  for (const CommandText* command : commands) {
    for (const CommandText& verb : command->verbs) {
      script += fmt::format("      '{}:{}') verb='{}' ;;\n", verb_path(*command), verb.name(),
                            verb_path(verb));
    }
  }
  script += "    esac\n  done\n  case \"$verb:$before\" in\n";
  for (const CommandText* command : commands) script += value_cases(*command);
  script += "  esac\n  if [[ $current == -* ]]; then\n    case $verb in\n";
  for (const CommandText* command : commands) {
    script += fmt::format("      '{}') _seedframe_words '{}' ;;\n", verb_path(*command),
                          fmt::join(option_names(*command), " "));
  }
  script += "    esac\n    return\n  fi\n  case $verb in\n";
  for (const CommandText* command : commands) script += argument_case(*command);
  script += "  esac\n}\n\ncomplete -F _seedframe seedframe\n";
  return script;
}

}  // namespace seedframe
