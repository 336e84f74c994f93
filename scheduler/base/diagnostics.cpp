#include "base/diagnostics.h"

#include "base/message_text.h"

namespace seedframe {
namespace {

constexpr std::size_t kMostShown = 20;
constexpr std::size_t kLongestMessage = 4000;  // bytes; a formula may have 2,000

}  // namespace

void Diagnostics::add(const Place& place, const std::string& message) {
  ++size_;
  if (messages_.size() == kMostShown) return;
  messages_.push_back(shortened(place.text() + ": " + message, kLongestMessage));
}

Error Diagnostics::as_error() const {
  std::string text;
  for (const std::string& message : messages_) {
    if (!text.empty()) text += '\n';
    text += message;
  }
  if (size_ > kMostShown) text += fmt::format("\n… and {} more", size_ - kMostShown);
  return {ErrorKind::kInput, text};
}

}  // namespace seedframe
