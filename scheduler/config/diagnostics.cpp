#include "config/diagnostics.h"

#include <algorithm>

namespace seedframe {

std::string Place::text() const {
  std::string out = file;
  if (line > 0) out += fmt::format(":{}:{}", line, column);
  if (!path.empty()) out += ": " + path;
  return out;
}

void Diagnostics::add(const Place& place, const std::string& message) {
  messages_.push_back(place.text() + ": " + message);
}

Error Diagnostics::as_error() const {
  constexpr std::size_t kMostShown = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(messages_.size(), kMostShown); ++i) {
    if (i > 0) text += '\n';
    text += messages_[i];
  }
  if (messages_.size() > kMostShown) {
    text += fmt::format("\n… and {} more", messages_.size() - kMostShown);
  }
  return {ErrorKind::kInput, text};
}

}  // namespace seedframe
