#include "base/diagnostics.h"

#include <algorithm>
#include <tuple>

#include "base/message_text.h"

namespace seedframe {
namespace {

constexpr std::size_t kMostShown = 20;
constexpr std::size_t kLongestMessage = 4000;  // bytes; a formula may have 2,000

}  // namespace

std::size_t Diagnostics::index_of(const std::string& file) {
  const auto found = std::find(files_.begin(), files_.end(), file);
  if (found != files_.end()) return static_cast<std::size_t>(found - files_.begin());
  if (files_.size() < kMostShown) files_.push_back(file);
  return files_.size() - 1;
}

void Diagnostics::add(const Place& place, const std::string& message) {
  ++size_;
  Message added{index_of(place.file), place.line, place.column, {}};
  const auto behind = std::upper_bound(
      messages_.begin(), messages_.end(), added, [](const Message& a, const Message& b) {
        return std::tie(a.file, a.line, a.column) < std::tie(b.file, b.line, b.column);
      });
  if (behind == messages_.end() && messages_.size() == kMostShown) return;
  added.text = shortened(place.text() + ": " + message, kLongestMessage);
  messages_.insert(behind, std::move(added));
  if (messages_.size() > kMostShown) messages_.pop_back();
}

Error Diagnostics::as_error() const {
  std::string text;
  for (const Message& message : messages_) {
    if (!text.empty()) text += '\n';
    text += message.text;
  }
  if (size_ > kMostShown) text += fmt::format("\n… and {} more", size_ - kMostShown);
  return {ErrorKind::kInput, text};
}

}  // namespace seedframe
