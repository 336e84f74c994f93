#include "render/child_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <set>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace seedframe {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<char*> pointers(const std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (const std::string& text : texts) result.push_back(const_cast<char*>(text.c_str()));
  result.push_back(nullptr);
  return result;
}

void limit(decltype(RLIMIT_AS) resource, std::uint64_t most) {
  if (most == 0) return;
  rlimit limits = {};
  if (getrlimit(resource, &limits) != 0) return;
  limits.rlim_cur = limits.rlim_max = std::min<rlim_t>(most, limits.rlim_max);
  setrlimit(resource, &limits);
}

void apply(const ResourceLimits& limits) {
  limit(RLIMIT_DATA, limits.memory_bytes);
  limit(RLIMIT_CPU, limits.cpu_s);
  limit(RLIMIT_FSIZE, limits.file_bytes);
  limit(RLIMIT_NOFILE, limits.open_files);
  const rlimit none = {0, 0};
  setrlimit(RLIMIT_CORE, &none);
}

// Runs between fork and exec, where only async-signal-safe functions may be called.
[[noreturn]] void become(const ChildCommand& command, char* const* arguments,
                         char* const* environment, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // the parent died before prctl

  if (command.cpu >= 0) {
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(static_cast<std::size_t>(command.cpu), &only);
    sched_setaffinity(0, sizeof only, &only);
  }

  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);  // ignored signals stay ignored after exec
  if (command.ignores_terminate) signal(SIGTERM, SIG_IGN);

  apply(command.limits);

  // Out of the way of the numbers that they are about to get.
  constexpr int kAbove = 10;
  const int output = fcntl(command.output, F_DUPFD, kAbove);
  const int channel = command.channel < 0 ? -1 : fcntl(command.channel, F_DUPFD, kAbove);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  if (channel >= 0) dup2(channel, kChildChannel);
  close_range(channel >= 0 ? kChildChannel + 1 : kChildChannel, ~0U, 0);

  execve(arguments[0], arguments, environment);
  const char* why = strerrordesc_np(errno);
  const std::string_view parts[] = {"cannot start ", arguments[0], ": ", why == nullptr ? "?" : why,
                                    "\n"};
  for (const std::string_view part : parts) {
    if (write(STDERR_FILENO, part.data(), part.size()) < 0) break;
  }
  _exit(127);
}

bool starts_with_any(std::string_view text, const auto& beginnings) {
  return std::any_of(std::begin(beginnings), std::end(beginnings),
                     [&](std::string_view beginning) { return text.starts_with(beginning); });
}

// Reads until the end or the deadline; false if the deadline came first.
bool read_all(int fd, Clock::time_point deadline, std::string& text) {
  std::array<char, 4096> buffer;
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return false;
    pollfd waiting = {fd, POLLIN, 0};
    if (poll(&waiting, 1, static_cast<int>(left.count())) <= 0) continue;
    const ssize_t bytes = read(fd, buffer.data(), buffer.size());
    if (bytes == 0 || (bytes < 0 && errno != EINTR)) return true;
    if (bytes > 0) text.append(buffer.data(), static_cast<std::size_t>(bytes));
  }
}

/// Our children, so that what they leave behind when they end can be told from them.
class Children {
 public:
  static Children& ours() {
    static Children children;
    return children;
  }

  /// In the environment of each, and so of all that they start.
  static std::string mark() { return fmt::format("SEEDFRAME_CHILD_OF={}", getpid()); }

  pid_t start(const ChildCommand& command) {
    std::vector<std::string> marked = command.environment;
    marked.push_back(mark());
    const std::vector<char*> arguments = pointers(command.arguments);
    const std::vector<char*> environment = pointers(marked);
    const pid_t parent = getpid();
    const std::lock_guard lock(mutex_);
    prctl(PR_SET_CHILD_SUBREAPER, 1);  // whose parent has ended becomes our child
    const pid_t child = fork();
    if (child == 0) become(command, arguments.data(), environment.data(), parent);
    if (child > 0) running_.insert(child);
    return child;
  }

  /// After one has ended: ends what it had started and left.
  void ended(pid_t child) {
    const std::lock_guard lock(mutex_);
    running_.erase(child);
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
      const std::string name = entry.path().filename();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      const pid_t pid = std::stoi(name);
      if (running_.contains(pid) || !is_marked_child(entry.path())) continue;
      kill(pid, SIGKILL);
      waitpid(pid, nullptr, 0);
    }
  }

 private:
  /// What can be read of it: the process may end meanwhile.
  static std::string text_of(const std::filesystem::path& file) {
    std::string text;
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return text;
    std::array<char, 4096> buffer;
    ssize_t bytes = 0;
    while ((bytes = read(descriptor, buffer.data(), buffer.size())) > 0) {
      text.append(buffer.data(), static_cast<std::size_t>(bytes));
    }
    close(descriptor);
    return text;
  }

  static bool is_marked_child(const std::filesystem::path& process) {
    // After the name, which is in brackets and may hold anything: state, parent.
    const std::string stat = text_of(process / "stat");
    const std::size_t behind_name = stat.rfind(')');
    if (behind_name == std::string::npos || behind_name + 4 >= stat.size()) return false;
    if (std::atoi(stat.c_str() + behind_name + 4) != getpid()) return false;
    const std::string environment = text_of(process / "environ");
    return environment.find(mark()) != std::string::npos;
  }

  std::mutex mutex_;
  std::set<pid_t> running_;
};

}  // namespace

Result<pid_t> start_child(const ChildCommand& command) {
  const pid_t child = Children::ours().start(command);
  if (child < 0) {
    return fail(ErrorKind::kEnvironment, "cannot start {}: fork: {}", command.arguments.front(),
                std::strerror(errno));
  }
  setpgid(child, child);  // here too: whoever comes first, the group exists before anyone kills it
  return child;
}

std::vector<int> allowed_cpus() {
  std::vector<int> cpus;
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &allowed)) cpus.push_back(cpu);
  }
  return cpus;
}

std::optional<int> wait_for_child(pid_t child, std::chrono::milliseconds longest) {
  const auto deadline = Clock::now() + longest;
  auto pause = std::chrono::microseconds(100);
  while (true) {
    int status = 0;
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) {
      Children::ours().ended(child);
      return status;
    }
    if (ended < 0 && errno != EINTR) return std::nullopt;
    if (Clock::now() >= deadline) return std::nullopt;
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::microseconds(5000));
  }
}

std::optional<int> kill_child(pid_t child) {
  kill(-child, SIGKILL);
  return wait_for_child(child, std::chrono::seconds(10));
}

std::string describe_wait_status(const std::optional<int>& status) {
  if (!status) return "did not end";
  if (WIFSIGNALED(*status)) {
    const char* name = sigdescr_np(WTERMSIG(*status));
    return fmt::format("was killed by signal {} ({})", WTERMSIG(*status),
                       name == nullptr ? "unknown" : name);
  }
  return fmt::format("exited with status {}", WEXITSTATUS(*status));
}

bool is_program(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

Result<std::string> output_of(const std::vector<std::string>& arguments,
                              std::chrono::milliseconds longest, const Variables& changes) {
  return output_in(worker_environment(changes), arguments, longest);
}

Result<std::string> output_in(std::vector<std::string> environment,
                              const std::vector<std::string>& arguments,
                              std::chrono::milliseconds longest) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    return fail(ErrorKind::kEnvironment, "cannot make a pipe: {}", std::strerror(errno));
  }
  ChildCommand command;
  command.arguments = arguments;
  command.environment = std::move(environment);
  command.output = ends[1];
  const Result<pid_t> child = start_child(command);
  close(ends[1]);
  std::string text;
  const bool complete = child && read_all(ends[0], Clock::now() + longest, text);
  close(ends[0]);
  if (!child) return forward_error(child);
  const std::optional<int> status =
      complete ? wait_for_child(*child, longest) : std::optional<int>();
  if (!status) {
    kill_child(*child);
    return fail(ErrorKind::kEnvironment, "{} gave no answer within {} s", fmt::join(arguments, " "),
                longest.count() / 1000);
  }
  if (*status != 0) {
    return fail(ErrorKind::kEnvironment, "{} {}: {}", fmt::join(arguments, " "),
                describe_wait_status(status),
                text.substr(text.size() - std::min<std::size_t>(text.size(), 500)));
  }
  return text;
}

std::optional<std::filesystem::path> find_in_path(const std::string& name) {
  const char* variable = std::getenv("PATH");
  const std::string folders = variable == nullptr ? "/usr/bin:/bin" : variable;
  for (std::size_t begin = 0; begin <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    const std::filesystem::path path =
        std::filesystem::path(folders.substr(begin, end - begin)) / name;
    if (is_program(path)) return std::filesystem::absolute(path);
    begin = end + 1;
  }
  return std::nullopt;
}

std::vector<std::string> own_environment() {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) all.emplace_back(*entry);
  return all;
}

std::vector<std::string> worker_environment(const Variables& changes) {
  // A Blender that uses the system's Python looks for that Python's home along PATH: an active
  // virtual environment, conda or pyenv would hide numpy from it.
  constexpr std::array<std::string_view, 4> kDropped = {"PATH=", "PYTHON", "BLENDER_USER_",
                                                        "OCIO="};
  std::vector<std::string> result = {"PATH=/usr/bin:/bin"};
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const bool changed = std::any_of(changes.begin(), changes.end(), [&](const auto& change) {
      return text.starts_with(change.first + "=");
    });
    if (!changed && !starts_with_any(text, kDropped)) result.emplace_back(text);
  }
  for (const auto& [name, value] : changes) result.push_back(fmt::format("{}={}", name, value));
  return result;
}

}  // namespace seedframe
