// Preloaded into the scheduler (LD_PRELOAD), stands between it and libc's calls that change files:
// kills it at the Nth of them, or fails calls as a full, broken or read-only disk would.
//
// FAULTY_IO in the environment: `key=value` with `;` between.
//
//     under=DIR         only calls on DIR and what is below it (an absolute path without symlinks)
//     calls=a,b,…       only these (names of kCallNames); by default all but read-open
//     log=FILE          gets a line "<number> <call> <path>" for each such call, before it is made
//     at=N do=…         from the Nth such call on, counted from 1:
//       kill              SIGKILL before the call            ┐
//       kill-after        SIGKILL after it                   │ at the Nth only
//       kill-within       SIGKILL after half of what it      │
//                         writes; else as kill-after         ┘
//       ENOSPC, EIO, …    the call is not made and fails so
//       short-write       half of it is written and reported; else as it is
//     times=K           fail K calls and no more
//     until-file=FILE   fail only while FILE exists
//     tell-file=FILE    is made at the first failure
//
// Both variables are removed from the environment at once, so children go undisturbed. What cannot
// be seen from here: stores to shared mappings (SQLite's -shm, which it never relies on after a
// crash) and what libc writes by itself (stdio; nothing in a campaign's folder).

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <type_traits>

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

enum class Call {
  kOpen,  ///< that may create, truncate or write
  kReadOpen,
  kWrite,
  kPwrite,
  kWritev,
  kFsync,
  kFdatasync,
  kSyncfs,
  kTruncate,
  kRename,
  kUnlink,
  kMkdir,
  kRmdir,
  kLink,
  kSymlink,
  kCount
};

constexpr const char* kCallNames[] = {"open",   "read-open", "write",  "pwrite",    "writev",
                                      "fsync",  "fdatasync", "syncfs", "ftruncate", "rename",
                                      "unlink", "mkdir",     "rmdir",  "link",      "symlink"};
static_assert(sizeof kCallNames / sizeof *kCallNames == static_cast<std::size_t>(Call::kCount));

enum class Action { kNone, kKill, kKillAfter, kKillWithin, kFail, kShortWrite };

struct Plan {
  char under[PATH_MAX] = "";
  char log[PATH_MAX] = "";
  char until_file[PATH_MAX] = "";
  char tell_file[PATH_MAX] = "";
  unsigned calls = ~(1u << static_cast<unsigned>(Call::kReadOpen));
  Action action = Action::kNone;
  int error = 0;
  long at = 0;
  long times = LONG_MAX;
};

// Written once, before main; no lock and no allocation afterwards, as calls come from all threads
// and between fork and exec.
Plan g_plan;
bool g_active = false;
std::atomic<long> g_calls{0};

[[noreturn]] void give_up(const char* what, const char* value) {
  std::fprintf(stderr, "faulty_io: %s '%s' is not known\n", what, value);
  _exit(125);
}

unsigned parse_calls(char* names) {
  unsigned calls = 0;
  char* rest = nullptr;
  for (char* name = strtok_r(names, ",", &rest); name != nullptr;
       name = strtok_r(nullptr, ",", &rest)) {
    unsigned index = 0;
    while (index < static_cast<unsigned>(Call::kCount) && strcmp(name, kCallNames[index]) != 0) {
      ++index;
    }
    if (index == static_cast<unsigned>(Call::kCount)) give_up("call", name);
    calls |= 1u << index;
  }
  return calls;
}

void parse_action(const char* name) {
  struct Named {
    const char* name;
    Action action;
    int error;
  };
  constexpr Named kActions[] = {{"kill", Action::kKill, 0},
                                {"kill-after", Action::kKillAfter, 0},
                                {"kill-within", Action::kKillWithin, 0},
                                {"short-write", Action::kShortWrite, 0},
                                {"ENOSPC", Action::kFail, ENOSPC},
                                {"EIO", Action::kFail, EIO},
                                {"EROFS", Action::kFail, EROFS},
                                {"EMFILE", Action::kFail, EMFILE},
                                {"EDQUOT", Action::kFail, EDQUOT}};
  for (const Named& each : kActions) {
    if (strcmp(name, each.name) != 0) continue;
    g_plan.action = each.action;
    g_plan.error = each.error;
    return;
  }
  give_up("action", name);
}

void set(const char* key, char* value) {
  const auto copy = [&](char(&to)[PATH_MAX]) { std::snprintf(to, sizeof to, "%s", value); };
  if (strcmp(key, "under") == 0) return copy(g_plan.under);
  if (strcmp(key, "log") == 0) return copy(g_plan.log);
  if (strcmp(key, "until-file") == 0) return copy(g_plan.until_file);
  if (strcmp(key, "tell-file") == 0) return copy(g_plan.tell_file);
  if (strcmp(key, "do") == 0) return parse_action(value);
  if (strcmp(key, "at") == 0) {
    g_plan.at = std::atol(value);
  } else if (strcmp(key, "times") == 0) {
    g_plan.times = std::atol(value);
  } else if (strcmp(key, "calls") == 0) {
    g_plan.calls = parse_calls(value);
  } else {
    give_up("key", key);
  }
}

[[gnu::constructor]] void read_plan() {
  const char* text = getenv("FAULTY_IO");
  if (text == nullptr) return;
  static char copy[4 * PATH_MAX];
  std::snprintf(copy, sizeof copy, "%s", text);
  unsetenv("FAULTY_IO");
  unsetenv("LD_PRELOAD");
  char* rest = nullptr;
  for (char* entry = strtok_r(copy, ";", &rest); entry != nullptr;
       entry = strtok_r(nullptr, ";", &rest)) {
    char* equals = strchr(entry, '=');
    if (equals == nullptr) give_up("entry", entry);
    *equals = '\0';
    set(entry, equals + 1);
  }
  g_active = true;
}

// ---- Paths ----

void append(char (&path)[PATH_MAX], const char* text) {
  const std::size_t length = strlen(path);
  std::snprintf(path + length, sizeof path - length, "%s", text);
}

void path_of(int descriptor, char (&path)[PATH_MAX]) {
  char link[64];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  path[length < 0 ? 0 : length] = '\0';
}

void path_at(int folder, const char* name, char (&path)[PATH_MAX]) {
  path[0] = '\0';
  if (name[0] != '/') {
    if (folder != AT_FDCWD) {
      path_of(folder, path);
    } else if (getcwd(path, sizeof path) == nullptr) {
      path[0] = '\0';
    }
    append(path, "/");
  }
  append(path, name);
}

bool is_wanted(const char* path) {
  const std::size_t length = strlen(g_plan.under);
  return strncmp(path, g_plan.under, length) == 0 && (path[length] == '/' || path[length] == '\0');
}

// ---- What becomes of a call ----

enum class Verdict { kPass, kFail, kKillAfter, kHalf, kHalfAndKill };

/// Past our own wrappers, and as lines: several threads, and several runs, share a log.
void note(const char* file, const char* line) {
  const long descriptor =
      syscall(SYS_openat, AT_FDCWD, file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor < 0) return;
  syscall(SYS_write, descriptor, line, strlen(line));
  syscall(SYS_close, descriptor);
}

[[noreturn]] void die() {
  while (true) syscall(SYS_kill, getpid(), SIGKILL);
}

Verdict failure(long number) {
  if (number - g_plan.at >= g_plan.times) return Verdict::kPass;
  if (g_plan.until_file[0] != '\0' && access(g_plan.until_file, F_OK) != 0) return Verdict::kPass;
  if (g_plan.tell_file[0] != '\0') note(g_plan.tell_file, "");
  if (g_plan.action == Action::kShortWrite) return Verdict::kHalf;
  errno = g_plan.error;
  return Verdict::kFail;
}

/// Counts the call; on kFail errno is set.
Verdict judge(Call call, const char* path) {
  if ((g_plan.calls & 1u << static_cast<unsigned>(call)) == 0 || !is_wanted(path)) {
    return Verdict::kPass;
  }
  const long number = ++g_calls;
  if (g_plan.log[0] != '\0') {
    char line[PATH_MAX + 64];
    std::snprintf(line, sizeof line, "%ld %s %s\n", number, kCallNames[static_cast<int>(call)],
                  path);
    note(g_plan.log, line);
  }
  if (g_plan.at == 0 || number < g_plan.at) return Verdict::kPass;
  switch (g_plan.action) {
    case Action::kNone:
      return Verdict::kPass;
    case Action::kKill:
      if (number == g_plan.at) die();
      return Verdict::kPass;
    case Action::kKillAfter:
      return number == g_plan.at ? Verdict::kKillAfter : Verdict::kPass;
    case Action::kKillWithin:
      return number == g_plan.at ? Verdict::kHalfAndKill : Verdict::kPass;
    case Action::kFail:
    case Action::kShortWrite:
      return failure(number);
  }
  return Verdict::kPass;
}

Verdict judge_at(Call call, int folder, const char* name) {
  if (!g_active) return Verdict::kPass;
  const int saved_errno = errno;
  char path[PATH_MAX];
  path_at(folder, name, path);
  const Verdict verdict = judge(call, path);
  if (verdict != Verdict::kFail) errno = saved_errno;
  return verdict;
}

Verdict judge_of(Call call, int descriptor) {
  if (!g_active) return Verdict::kPass;
  const int saved_errno = errno;
  char path[PATH_MAX];
  path_of(descriptor, path);
  const Verdict verdict = judge(call, path);
  if (verdict != Verdict::kFail) errno = saved_errno;
  return verdict;
}

/// A call that is made as a whole or not at all.
template <class Made>
auto carry_out(Verdict verdict, Made made) {
  using Value = decltype(made());
  if (verdict == Verdict::kFail) {
    if constexpr (std::is_pointer_v<Value>) {
      return Value(nullptr);
    } else {
      return Value(-1);
    }
  }
  const Value result = made();
  if (verdict == Verdict::kKillAfter || verdict == Verdict::kHalfAndKill) die();
  return result;
}

/// A call that writes `bytes`, or the first of them.
template <class Write>
ssize_t carry_out_write(Verdict verdict, std::size_t bytes, Write write_first) {
  if (verdict == Verdict::kFail) return -1;
  const bool half = (verdict == Verdict::kHalf || verdict == Verdict::kHalfAndKill) && bytes > 1;
  const ssize_t result = write_first(half ? bytes / 2 : bytes);
  if (verdict == Verdict::kKillAfter || verdict == Verdict::kHalfAndKill) die();
  return result;
}

Call kind_of_open(int flags) {
  return (flags & (O_ACCMODE | O_CREAT | O_TRUNC)) == O_RDONLY ? Call::kReadOpen : Call::kOpen;
}

Call kind_of_open(const char* mode) {
  return strpbrk(mode, "wa+") == nullptr ? Call::kReadOpen : Call::kOpen;
}

template <class Function>
Function libc(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

// NAME in libc, of the same type as ours.
#define LIBC(name) static const auto real = libc<decltype(&::name)>(#name)

// The mode is there when a file may be made.
#define MODE_OF(flags)                            \
  mode_t mode = 0;                                \
  if (((flags) & (O_CREAT | __O_TMPFILE)) != 0) { \
    va_list list;                                 \
    va_start(list, flags);                        \
    mode = va_arg(list, mode_t);                  \
    va_end(list);                                 \
  }

extern "C" {

int open(const char* path, int flags, ...) {
  LIBC(open);
  MODE_OF(flags)
  return carry_out(judge_at(kind_of_open(flags), AT_FDCWD, path),
                   [&] { return real(path, flags, mode); });
}
int open64(const char* path, int flags, ...) {
  LIBC(open64);
  MODE_OF(flags)
  return carry_out(judge_at(kind_of_open(flags), AT_FDCWD, path),
                   [&] { return real(path, flags, mode); });
}
int openat(int folder, const char* path, int flags, ...) {
  LIBC(openat);
  MODE_OF(flags)
  return carry_out(judge_at(kind_of_open(flags), folder, path),
                   [&] { return real(folder, path, flags, mode); });
}
int openat64(int folder, const char* path, int flags, ...) {
  LIBC(openat64);
  MODE_OF(flags)
  return carry_out(judge_at(kind_of_open(flags), folder, path),
                   [&] { return real(folder, path, flags, mode); });
}

// How libstdc++ opens its file streams; it writes to them with write and writev.
FILE* fopen(const char* path, const char* mode) {
  LIBC(fopen);
  return carry_out(judge_at(kind_of_open(mode), AT_FDCWD, path), [&] { return real(path, mode); });
}
FILE* fopen64(const char* path, const char* mode) {
  LIBC(fopen64);
  return carry_out(judge_at(kind_of_open(mode), AT_FDCWD, path), [&] { return real(path, mode); });
}

ssize_t write(int file, const void* bytes, size_t count) {
  LIBC(write);
  return carry_out_write(judge_of(Call::kWrite, file), count,
                         [&](size_t first) { return real(file, bytes, first); });
}
ssize_t pwrite(int file, const void* bytes, size_t count, off_t offset) {
  LIBC(pwrite);
  return carry_out_write(judge_of(Call::kPwrite, file), count,
                         [&](size_t first) { return real(file, bytes, first, offset); });
}
ssize_t pwrite64(int file, const void* bytes, size_t count, off64_t offset) {
  LIBC(pwrite64);
  return carry_out_write(judge_of(Call::kPwrite, file), count,
                         [&](size_t first) { return real(file, bytes, first, offset); });
}
ssize_t writev(int file, const iovec* parts, int count) {
  LIBC(writev);
  return carry_out_write(judge_of(Call::kWritev, file), static_cast<size_t>(count),
                         [&](size_t first) { return real(file, parts, static_cast<int>(first)); });
}

int fsync(int file) {
  LIBC(fsync);
  return carry_out(judge_of(Call::kFsync, file), [&] { return real(file); });
}
int fdatasync(int file) {
  LIBC(fdatasync);
  return carry_out(judge_of(Call::kFdatasync, file), [&] { return real(file); });
}
int syncfs(int file) __THROW {
  LIBC(syncfs);
  return carry_out(judge_of(Call::kSyncfs, file), [&] { return real(file); });
}
int ftruncate(int file, off_t length) __THROW {
  LIBC(ftruncate);
  return carry_out(judge_of(Call::kTruncate, file), [&] { return real(file, length); });
}
int ftruncate64(int file, off64_t length) __THROW {
  LIBC(ftruncate64);
  return carry_out(judge_of(Call::kTruncate, file), [&] { return real(file, length); });
}

// A rename is judged by where it leads.
int rename(const char* from, const char* to) __THROW {
  LIBC(rename);
  return carry_out(judge_at(Call::kRename, AT_FDCWD, to), [&] { return real(from, to); });
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) __THROW {
  LIBC(renameat);
  return carry_out(judge_at(Call::kRename, to_folder, to),
                   [&] { return real(from_folder, from, to_folder, to); });
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned flags) __THROW {
  LIBC(renameat2);
  return carry_out(judge_at(Call::kRename, to_folder, to),
                   [&] { return real(from_folder, from, to_folder, to, flags); });
}

int unlink(const char* path) __THROW {
  LIBC(unlink);
  return carry_out(judge_at(Call::kUnlink, AT_FDCWD, path), [&] { return real(path); });
}
int unlinkat(int folder, const char* path, int flags) __THROW {
  LIBC(unlinkat);
  const Call call = (flags & AT_REMOVEDIR) == 0 ? Call::kUnlink : Call::kRmdir;
  return carry_out(judge_at(call, folder, path), [&] { return real(folder, path, flags); });
}
int remove(const char* path) __THROW {
  LIBC(remove);
  return carry_out(judge_at(Call::kUnlink, AT_FDCWD, path), [&] { return real(path); });
}
int rmdir(const char* path) __THROW {
  LIBC(rmdir);
  return carry_out(judge_at(Call::kRmdir, AT_FDCWD, path), [&] { return real(path); });
}
int mkdir(const char* path, mode_t mode) __THROW {
  LIBC(mkdir);
  return carry_out(judge_at(Call::kMkdir, AT_FDCWD, path), [&] { return real(path, mode); });
}
int link(const char* from, const char* to) __THROW {
  LIBC(link);
  return carry_out(judge_at(Call::kLink, AT_FDCWD, to), [&] { return real(from, to); });
}
int symlink(const char* from, const char* to) __THROW {
  LIBC(symlink);
  return carry_out(judge_at(Call::kSymlink, AT_FDCWD, to), [&] { return real(from, to); });
}

}  // extern "C"
