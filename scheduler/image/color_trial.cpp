#include "image/color_trial.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "image/color_management.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr rlim_t kMoreMemoryBytes = 2'000'000'000;
constexpr std::size_t kMostMessageBytes = 4096;
/// Of the child: the message that it wrote says what is wrong.
constexpr int kTrialRefused = 1;

void limit(int what, rlim_t most) {
  const rlimit both{most, most};
  ::setrlimit(what, &both);
}

rlim_t address_space_bytes() {
  std::ifstream file("/proc/self/statm");
  rlim_t pages = 0;
  file >> pages;
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

/// In the child: ends it.
[[noreturn]] void try_and_tell(const fs::path& ocio_config, const ImageSettings& settings,
                               std::chrono::seconds seconds, int teller) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGILL, SIGFPE}) std::signal(number, SIG_DFL);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<rlim_t>(seconds.count()));
#ifndef __SANITIZE_ADDRESS__  // whose shadow is endless
  limit(RLIMIT_AS, address_space_bytes() + kMoreMemoryBytes);
#endif
  const Result<ColorManagement> color = ColorManagement::load(ocio_config);
  Status usable = color ? Status() : Status(forward_error(color));
  if (color && color->check(settings)) {
    const Result<Image<std::uint8_t>> pixel = color->apply(Image<float>(1, 1, 4), settings);
    if (!pixel) usable = forward_error(pixel);
  }
  if (usable) ::_exit(0);
  const std::string text = usable.error().message.substr(0, kMostMessageBytes);
  const bool told = ::write(teller, text.data(), text.size()) >= 0;
  ::_exit(told ? kTrialRefused : kTrialRefused + 1);
}

/// What it writes until it ends; false if that takes too long.
bool listen(int descriptor, std::chrono::steady_clock::time_point deadline, std::string& text) {
  std::array<char, kMostMessageBytes> buffer{};
  while (true) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return false;
    pollfd waiting = {descriptor, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(left.count())) <= 0) continue;
    const ssize_t bytes = ::read(descriptor, buffer.data(), buffer.size());
    if (bytes == 0 || (bytes < 0 && errno != EINTR)) return true;
    if (bytes > 0) text.append(buffer.data(), static_cast<std::size_t>(bytes));
  }
}

}  // namespace

Status try_color_config(const fs::path& ocio_config, const ImageSettings& settings,
                        std::chrono::seconds seconds) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    return fail(ErrorKind::kExhausted, "cannot open a pipe to try {}", ocio_config.string());
  }
  const pid_t child = ::fork();
  if (child == 0) try_and_tell(ocio_config, settings, seconds, pipe[1]);
  ::close(pipe[1]);
  if (child < 0) {
    ::close(pipe[0]);
    return fail(ErrorKind::kExhausted, "cannot start a process to try {}", ocio_config.string());
  }
  std::string message;
  const bool ended = listen(pipe[0], std::chrono::steady_clock::now() + seconds, message);
  ::close(pipe[0]);
  if (!ended) ::kill(child, SIGKILL);
  int how = 0;
  while (::waitpid(child, &how, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(how) && WEXITSTATUS(how) == 0) return {};
  if (WIFEXITED(how) && WEXITSTATUS(how) == kTrialRefused)
    return fail(ErrorKind::kInput, "{}", message);
  const bool slow = !ended || (WIFSIGNALED(how) && WTERMSIG(how) == SIGXCPU);
  return fail(
      ErrorKind::kInput,
      "{} cannot be used: OpenColorIO {} when the config, or a table that it names, was "
      "tried",
      ocio_config.string(),
      slow ? fmt::format("did not come to an end within {} s", seconds.count()) : "broke down");
}

}  // namespace seedframe
