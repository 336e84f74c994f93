#include "render/sandbox.h"

#include "render/child_process.h"

namespace seedframe {
namespace {

constexpr const char* kProgram = "/usr/bin/bwrap";

}  // namespace

std::vector<std::string> sandbox_arguments(const std::filesystem::path& output) {
  std::error_code error;
  const std::string folder = std::filesystem::absolute(output, error).string();
  return {kProgram,
          "--ro-bind",
          "/",
          "/",
          "--dev",
          "/dev",
          "--proc",
          "/proc",
          "--bind",
          folder,
          folder,
          "--unshare-net",
          "--unshare-pid",
          "--unshare-ipc",
          "--unshare-uts",
          "--die-with-parent",
          "--new-session",
          "--"};
}

Status check_sandbox() {
  constexpr auto kLongest = std::chrono::seconds(10);
  std::error_code error;
  if (!std::filesystem::exists(kProgram, error)) {
    return fail(ErrorKind::kEnvironment,
                "--sandbox needs {}, which is missing: install bubblewrap, or leave --sandbox out",
                kProgram);
  }
  std::vector<std::string> arguments = sandbox_arguments(std::filesystem::temp_directory_path());
  arguments.emplace_back("/bin/true");
  const Result<std::string> tried = output_of(arguments, kLongest);
  if (tried) return {};
  return fail(ErrorKind::kEnvironment,
              "--sandbox does not work here: {}. Let this user make namespaces, or leave --sandbox "
              "out",
              tried.error().message);
}

}  // namespace seedframe
