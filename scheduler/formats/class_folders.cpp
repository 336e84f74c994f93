#include "formats/class_folders.h"

#include <algorithm>
#include <set>

namespace seedframe {
namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-' || c == '.';
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

}  // namespace

std::vector<std::string> class_folders(const std::vector<std::string>& categories) {
  constexpr std::size_t kLongest = 100;
  std::vector<std::string> folders;
  std::set<std::string> taken;
  folders.reserve(categories.size());
  for (std::size_t k = 0; k < categories.size(); ++k) {
    std::string name = categories[k].substr(0, kLongest);
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !is_plain(c); }, '_');
    // What begins with '-' is an option to the tools that go through a dataset, and Windows drops a
    // '.' at the end.
    if (!name.empty() && (name.front() == '.' || name.front() == '-')) name.front() = '_';
    if (!name.empty() && name.back() == '.') name.back() = '_';
    if (name != categories[k] || name.empty() || !taken.insert(lower_case(name)).second) {
      name += '~';
      name += std::to_string(k + 1);
    }
    folders.push_back(std::move(name));
  }
  return folders;
}

}  // namespace seedframe
