// Starting a program so that it cannot outlive us, hold our files open or see more than it should.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "base/error.h"

namespace seedframe {

/// What a child may use at most (setrlimit); 0: as much as we.
struct ResourceLimits {
  std::uint64_t memory_bytes = 0;  ///< of its own, not of files that it maps (RLIMIT_DATA)
  std::uint64_t cpu_s = 0;         ///< over its whole life, all threads
  std::uint64_t file_bytes = 0;    ///< of any file that it writes
  std::uint64_t open_files = 0;
};

struct ChildCommand {
  std::vector<std::string> arguments;    ///< the first is the program's path
  std::vector<std::string> environment;  ///< "NAME=value", complete
  int output = -1;                       ///< becomes stdout and stderr
  int channel = -1;                      ///< becomes kChildChannel; -1: none
  int cpu = -1;                          ///< the one CPU that it starts on; -1: any of ours
  /// SIGTERM, which a batch system sends to all that belongs to a job, is for us to act on.
  bool ignores_terminate = false;
  ResourceLimits limits;  ///< and never a core dump
};

/// The descriptor under which a child finds its channel.
inline constexpr int kChildChannel = 3;

/// The child leads a process group of its own, so a terminal's Ctrl-C does not reach it, inherits
/// nothing but the descriptors of its command, and gets SIGKILL when the *thread* that called this
/// ends, however it ends. What it starts and leaves behind is ended after it.
Result<pid_t> start_child(const ChildCommand& command);

/// The CPUs that this process may run on, in order.
std::vector<int> allowed_cpus();

/// Waits at most so long for the end of a child; its wait status, or empty if it still runs.
std::optional<int> wait_for_child(pid_t child, std::chrono::milliseconds longest);

/// SIGKILL to the child's process group, and its wait status. Empty if even that does not end it (a
/// process stuck in the kernel); it is left behind then.
std::optional<int> kill_child(pid_t child);

/// "exited with status 3", "was killed by signal 11 (Segmentation fault)".
std::string describe_wait_status(const std::optional<int>& status);

/// Variables of the environment and their values.
using Variables = std::vector<std::pair<std::string, std::string>>;

/// What a program prints in a worker's environment, stdout and stderr together; kEnvironment errors
/// when it cannot be started, takes longer or ends with another status than 0.
Result<std::string> output_of(const std::vector<std::string>& arguments,
                              std::chrono::milliseconds longest, const Variables& changes = {});

/// The same in another environment, complete as "NAME=value".
Result<std::string> output_in(std::vector<std::string> environment,
                              const std::vector<std::string>& arguments,
                              std::chrono::milliseconds longest);

/// A program by its name, absolute; none if no folder of PATH has it.
std::optional<std::filesystem::path> find_in_path(const std::string& name);
/// Whether there is a file that we may execute.
bool is_program(const std::filesystem::path& path);

/// Our environment as it is.
std::vector<std::string> own_environment();

/// Our environment without what would change how Blender or its Python behave (PATH, PYTHON*,
/// BLENDER_USER_*, OCIO), with `changes` on top.
std::vector<std::string> worker_environment(const Variables& changes);

}  // namespace seedframe
