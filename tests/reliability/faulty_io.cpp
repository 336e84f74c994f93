// Preloaded into the scheduler (LD_PRELOAD), stands between it and libc's calls that change files:
// kills it at the Nth of them, or fails calls as a full, broken or read-only disk would.
// fault_plan.h says how it is told what to do. What cannot be seen from here: stores to shared
// mappings (SQLite's -shm, which it never relies on after a crash) and what libc writes by itself
// (stdio; nothing in a campaign's folder).

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

#include "fault_plan.h"

using namespace faulty_io;

namespace {

std::atomic<long> g_calls{0};

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
