#include "page/told_text.h"

#include <algorithm>

#include "base/message_text.h"

namespace seedframe {

ToldText::ToldText(const std::filesystem::path& root) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path given = root.lexically_normal();
  if (given.filename().empty()) given = given.parent_path();  // "results/parts/"
  const fs::path real = fs::weakly_canonical(given, error);
  name_ = printable(real.filename().string());
  for (const fs::path& path : {given, fs::absolute(given, error), real}) {
    const std::string text = path.string();
    // What is a name alone tells nothing, and may be part of any word.
    if (text.find('/') != std::string::npos) paths_.push_back(text);
  }
  std::sort(paths_.begin(), paths_.end(), [](const std::string& a, const std::string& b) {
    return std::pair(b.size(), a) < std::pair(a.size(), b);
  });
}

std::string ToldText::of(std::string_view text) const {
  std::string told(text);
  for (const std::string& path : paths_) {
    for (std::size_t at = 0; (at = told.find(path, at)) != std::string::npos; at += name_.size()) {
      told.replace(at, path.size(), name_);
    }
  }
  return printable(told);  // UTF-8, too
}

std::string without_folders(std::string_view text) {
  constexpr std::string_view kBefore = " \n\t'\"(=:,";
  constexpr std::string_view kAfter = " \n\t'\"):,";
  std::string told;
  std::size_t at = 0;
  while (at < text.size()) {
    const bool begins =
        text[at] == '/' && (at == 0 || kBefore.find(text[at - 1]) != std::string_view::npos);
    if (!begins) {
      told += text[at++];
      continue;
    }
    const std::size_t end = std::min(text.find_first_of(kAfter, at), text.size());
    const std::string_view path = text.substr(at, end - at);
    told += path.substr(path.rfind('/') + 1);
    at = end;
  }
  return told;
}

}  // namespace seedframe
