// What faulty_io.cpp is to do, as the environment says it.
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
// It and LD_PRELOAD are removed from the environment at once, so children go undisturbed.
#pragma once

#include <climits>
#include <cstddef>

namespace faulty_io {

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

inline constexpr const char* kCallNames[] = {
    "open",      "read-open", "write",  "pwrite", "writev", "fsync", "fdatasync", "syncfs",
    "ftruncate", "rename",    "unlink", "mkdir",  "rmdir",  "link",  "symlink"};
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
extern Plan g_plan;
extern bool g_active;

}  // namespace faulty_io
