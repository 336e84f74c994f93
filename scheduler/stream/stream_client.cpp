#include "stream/stream_client.h"

#include <array>
#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

namespace seedframe {
namespace {

constexpr std::size_t kLongestLine = 16U << 20U;

}  // namespace

StreamServer::Client::Client(int in, int out) : in_(in), out_(out), flags_(::fcntl(out, F_GETFL)) {
  ::fcntl(out_, F_SETFL, flags_ | O_NONBLOCK);
}

StreamServer::Client::~Client() {
  ::fcntl(out_, F_SETFL, flags_);
  for (const auto& [id, cancelled] : open) *cancelled = true;
  if (in_ > STDERR_FILENO) ::close(in_);
  if (out_ != in_ && out_ > STDERR_FILENO) ::close(out_);
}

std::vector<std::string> StreamServer::Client::receive() {
  std::vector<std::string> lines;
  std::array<char, 1U << 16U> buffer;
  const ssize_t bytes = ::read(in_, buffer.data(), buffer.size());
  if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) return lines;
  if (bytes <= 0) {
    ended_ = true;
    if (!input_.empty()) lines.push_back(std::move(input_));  // cut off: its error says so
    input_.clear();
    return lines;
  }
  input_.append(buffer.data(), static_cast<std::size_t>(bytes));
  std::size_t begin = 0;
  for (std::size_t end; (end = input_.find('\n', begin)) != std::string::npos; begin = end + 1) {
    if (!skips_line_) lines.push_back(input_.substr(begin, end - begin));
    skips_line_ = false;
  }
  input_.erase(0, begin);
  if (input_.size() > kLongestLine) {
    if (!skips_line_) lines.emplace_back("(a line of more than 16 MiB)");
    skips_line_ = true;
    input_.clear();
  }
  return lines;
}

void StreamServer::Client::say(const std::string& line) {
  output_ += line;
  output_ += '\n';
  last_said = std::chrono::steady_clock::now();
  flush();
}

void StreamServer::Client::flush() {
  while (!output_.empty() && !gone_) {
    const ssize_t bytes = ::write(out_, output_.data(), output_.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0 && errno == EAGAIN) return;
    if (bytes <= 0) {
      gone_ = ended_ = true;
      return;
    }
    output_.erase(0, static_cast<std::size_t>(bytes));
  }
}

}  // namespace seedframe
