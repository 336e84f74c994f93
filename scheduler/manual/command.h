// A command line as its manual and the shells see it: verbs, options, and what may follow them.
#pragma once

#include <string>
#include <vector>

namespace seedframe {

/// What a shell offers where a value is expected.
enum class Offer {
  kNothing,
  kWords,    ///< those of the option
  kFolders,  ///< for values called DIR
  kFiles,    ///< for values called FILE
  kConfigs,  ///< for values called CONFIG: files that end in .yaml, and folders on the way to them
};

/// An option, or an argument that is known by its place.
struct OptionText {
  std::vector<std::string> names;  ///< "-o", "--output"; none: known by its place
  std::string value;               ///< what its value is called: "DIR"; empty: it takes none
  Offer offer = Offer::kNothing;
  std::vector<std::string> words;  ///< of Offer::kWords
  std::string help;
  std::string default_value;
  bool required = false;
  bool repeated = false;  ///< can be given more than once
};

struct CommandText {
  std::vector<std::string> path;  ///< "seedframe", "asset", "import"
  std::string help;
  std::string example;  ///< a command; empty: none
  std::vector<OptionText> options;
  std::vector<OptionText> arguments;
  std::vector<CommandText> verbs;

  const std::string& name() const { return path.back(); }
};

/// The command and all below it, in the order of their declaration.
std::vector<const CommandText*> all_commands(const CommandText& command);

/// The names of the path below the program: "asset import"; empty for the program itself.
std::string verb_path(const CommandText& command);

/// What an option's help says first; a list behind it is left out.
std::string short_help(const std::string& help);

}  // namespace seedframe
