#include "live/run_control.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/files.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

/// Fields of /proc/<pid>/stat behind the name, which may hold anything: state, parent, …
std::vector<std::string> stat_fields(std::int64_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');
  std::vector<std::string> fields;
  if (name_end == std::string::npos) return fields;
  std::istringstream rest(text.substr(name_end + 1));
  for (std::string field; rest >> field;) fields.push_back(field);
  return fields;
}

std::int64_t resident_bytes(std::int64_t process) {
  std::ifstream file(fmt::format("/proc/{}/statm", process));
  std::int64_t all = 0;
  std::int64_t resident = 0;
  file >> all >> resident;
  return file ? resident * ::sysconf(_SC_PAGESIZE) : 0;
}

/// As render/local_worker.cpp has told it, and its children.
std::optional<int> worker_of(std::int64_t process) {
  std::ifstream file(fmt::format("/proc/{}/environ", process), std::ios::binary);
  constexpr std::string_view kName = "SEEDFRAME_WORKER=";
  for (std::string entry; std::getline(file, entry, '\0');) {
    if (entry.starts_with(kName)) return std::atoi(entry.c_str() + kName.size());
  }
  return std::nullopt;
}

/// All below a process, by their ids.
std::vector<WorkerProcess> processes_below(std::int64_t root) {
  std::map<std::int64_t, std::vector<std::int64_t>> children;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc", error)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::int64_t process = std::stoll(name);
    const std::vector<std::string> fields = stat_fields(process);
    if (fields.size() > 1) children[std::stoll(fields[1])].push_back(process);
  }
  std::vector<WorkerProcess> found;
  std::vector<std::int64_t> waiting = {root};
  while (!waiting.empty()) {
    const std::int64_t parent = waiting.back();
    waiting.pop_back();
    for (const std::int64_t child : children[parent]) {
      found.push_back({child, worker_of(child), resident_bytes(child)});
      waiting.push_back(child);
    }
  }
  std::sort(found.begin(), found.end(),
            [](const WorkerProcess& a, const WorkerProcess& b) { return a.process < b.process; });
  return found;
}

/// The last lines of a file, for a message.
std::string last_lines(const fs::path& file) {
  constexpr std::size_t kMostBytes = 600;
  const Result<std::string> text = read_file(file);
  if (!text) return {};
  std::string tail = text->size() > kMostBytes ? text->substr(text->size() - kMostBytes) : *text;
  if (tail.size() < text->size()) tail.erase(0, tail.find('\n') + 1);
  return tail;
}

/// What a child does; never returns. Nothing here allocates.
[[noreturn]] void become(const char* const* words, int log) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);  // the server blocks what ends it
  ::setsid();
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  ::execv(words[0], const_cast<char* const*>(words));
  ::_exit(127);
}

}  // namespace

std::optional<std::int64_t> lock_holder(const fs::path& lock) {
  struct stat file = {};
  if (::stat(lock.c_str(), &file) != 0) return std::nullopt;
  const std::string wanted = fmt::format("{:02x}:{:02x}:{}", major(file.st_dev), minor(file.st_dev),
                                         static_cast<std::uint64_t>(file.st_ino));
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    // "3: FLOCK  ADVISORY  WRITE 1234 fe:01:5678 0 EOF"; who waits for one has "->" before its
    // kind.
    std::istringstream words(line);
    std::string number, kind, advisory, access, process, place;
    words >> number >> kind >> advisory >> access >> process >> place;
    if (kind != "FLOCK" || place != wanted) continue;
    const std::int64_t holder = std::strtoll(process.c_str(), nullptr, 10);
    if (holder > 0) return holder;
  }
  return std::nullopt;
}

ProcessControl::Child* ProcessControl::child_of(const Campaign& campaign) {
  for (Child& child : children_) {
    if (!child.exit_code) {
      int status = 0;
      if (::waitpid(child.process, &status, WNOHANG) == child.process) {
        child.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      }
    }
  }
  const auto found = std::find_if(children_.begin(), children_.end(), [&](const Child& child) {
    return child.campaign == campaign.files.root();
  });
  return found == children_.end() ? nullptr : &*found;
}

RunState ProcessControl::state(const Campaign& campaign) {
  RunState state;
  state.scheduler = lock_holder(campaign.files.lock());
  if (const Child* child = child_of(campaign)) {
    state.starting = !child->exit_code && !state.scheduler;
    constexpr int kInterrupted = 130;
    if (child->exit_code.value_or(0) != 0 && child->exit_code != kInterrupted) {
      state.last_words = last_lines(campaign.files.serve_log());
    }
  }
  if (state.scheduler) {
    state.memory_bytes = resident_bytes(*state.scheduler);
    state.workers = processes_below(*state.scheduler);
  }
  return state;
}

Status ProcessControl::pause(const Campaign& campaign) {
  const auto holder = lock_holder(campaign.files.lock());
  if (!holder) return fail(ErrorKind::kInput, "nobody is at work on it");
  const auto last = campaign.store.last_process();
  if (!last) return forward_error(last);
  if (*last != holder) {
    return fail(ErrorKind::kInput, "process {} holds the campaign's lock, and is no run of it",
                *holder);
  }
  // The descriptor stays this process's, whoever gets its number afterwards; so it is looked again
  // whether that holds the lock before anything is sent.
  const int process = static_cast<int>(::syscall(SYS_pidfd_open, static_cast<pid_t>(*holder), 0));
  if (process < 0) {
    return fail(ErrorKind::kEnvironment, "cannot reach process {}: {}", *holder,
                std::strerror(errno));
  }
  const bool still = lock_holder(campaign.files.lock()) == holder;
  const bool sent = still && ::syscall(SYS_pidfd_send_signal, process, SIGTERM, nullptr, 0) == 0;
  const int error = errno;
  ::close(process);
  if (!still) return fail(ErrorKind::kInput, "the run has just ended");
  if (!sent) {
    return fail(ErrorKind::kEnvironment, "cannot signal process {}: {}", *holder,
                std::strerror(error));
  }
  return {};
}

Status ProcessControl::resume(const Campaign& campaign, std::optional<std::int64_t> frame) {
  Child* child = child_of(campaign);
  if (lock_holder(campaign.files.lock()) || (child != nullptr && !child->exit_code)) {
    return fail(ErrorKind::kInput, "a run is at work on it already");
  }
  std::vector<std::string> words = {program_.string(), "resume", campaign.files.root().string(),
                                    "--quiet"};
  if (frame) words.insert(words.end(), {"--frame", std::to_string(*frame)});
  words.insert(words.end(), resume_options_.begin(), resume_options_.end());
  std::vector<const char*> pointers;
  pointers.reserve(words.size() + 1);
  for (const std::string& word : words) pointers.push_back(word.c_str());
  pointers.push_back(nullptr);
  if (Status made = make_folders(campaign.files.logs()); !made) return made;
  const fs::path log = campaign.files.serve_log();
  const int descriptor =
      ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (descriptor < 0) return system_failure("open", log, errno);
  const pid_t process = ::fork();
  if (process == 0) become(pointers.data(), descriptor);
  const int error = errno;
  ::close(descriptor);
  if (process < 0) {
    return fail(ErrorKind::kEnvironment, "cannot start a run: {}", std::strerror(error));
  }
  if (child == nullptr) child = &children_.emplace_back();
  *child = {campaign.files.root(), process, std::nullopt};
  return {};
}

}  // namespace seedframe
