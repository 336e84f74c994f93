#include "manual/command.h"

namespace seedframe {

std::vector<const CommandText*> all_commands(const CommandText& command) {
  std::vector<const CommandText*> all = {&command};
  for (const CommandText& verb : command.verbs) {
    const std::vector<const CommandText*> below = all_commands(verb);
    all.insert(all.end(), below.begin(), below.end());
  }
  return all;
}

std::string verb_path(const CommandText& command) {
  std::string path;
  for (std::size_t i = 1; i < command.path.size(); ++i) {
    path += (i > 1 ? " " : "") + command.path[i];
  }
  return path;
}

std::string short_help(const std::string& help) {
  std::string line = help.substr(0, help.find('\n'));
  if (line.size() < help.size() && line.ends_with(':')) line.pop_back();
  return line;
}

}  // namespace seedframe
