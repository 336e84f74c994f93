#include "render/sandbox.h"

#include <array>

#include "render/child_process.h"

namespace seedframe {
namespace {

constexpr const char* kProgram = "/usr/bin/bwrap";
constexpr std::array<const char*, 3> kHidden = {"/tmp", "/run", "/var/tmp"};

}  // namespace

std::vector<std::string> sandbox_arguments(const std::filesystem::path& output,
                                           const std::vector<std::filesystem::path>& readable) {
  std::error_code error;
  const std::string folder = std::filesystem::absolute(output, error).string();
  std::vector<std::string> arguments = {kProgram, "--ro-bind", "/",      "/",
                                        "--dev",  "/dev",      "--proc", "/proc"};
  // Where sockets of other programs are, which a read-only disk would not keep anybody from.
  for (const char* hidden : kHidden) {
    arguments.insert(arguments.end(), {"--tmpfs", hidden});
    for (const std::filesystem::path& path : readable) {
      const std::string whole = std::filesystem::absolute(path, error).lexically_normal().string();
      if (!whole.starts_with(std::string(hidden) + "/")) continue;
      arguments.insert(arguments.end(), {"--ro-bind-try", whole, whole});
    }
  }
  arguments.insert(arguments.end(), {"--bind", folder, folder});
  // Root keeps its capabilities in namespaces, unless they are dropped.
  arguments.insert(arguments.end(), {"--cap-drop", "ALL", "--unshare-net", "--unshare-pid",
                                     "--unshare-ipc", "--unshare-uts", "--unshare-cgroup-try",
                                     "--die-with-parent", "--new-session", "--"});
  return arguments;
}

Status check_sandbox() {
  constexpr auto kLongest = std::chrono::seconds(10);
  std::error_code error;
  if (!std::filesystem::exists(kProgram, error)) {
    return fail(ErrorKind::kEnvironment,
                "--sandbox needs {}, which is missing: install bubblewrap, or leave --sandbox out",
                kProgram);
  }
  std::vector<std::string> arguments =
      sandbox_arguments(std::filesystem::temp_directory_path(), {});
  arguments.emplace_back("/bin/true");
  const Result<std::string> tried = output_of(arguments, kLongest);
  if (tried) return {};
  return fail(ErrorKind::kEnvironment,
              "--sandbox does not work here: {}. Let this user make namespaces, or leave --sandbox "
              "out",
              tried.error().message);
}

}  // namespace seedframe
