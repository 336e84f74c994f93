#include "cache/known_worker.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include <sys/stat.h>

#include "base/sha256.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// Changes whenever the file is written or another one takes its place; empty if there is none.
std::string stamp_of(const fs::path& file) {
  struct stat info = {};
  if (::stat(file.c_str(), &info) != 0) return {};
  return fmt::format("{} {} {}.{:09} {}.{:09}", info.st_ino, info.st_size, info.st_mtim.tv_sec,
                     info.st_mtim.tv_nsec, info.st_ctim.tv_sec, info.st_ctim.tv_nsec);
}

template <std::size_t N>
bool begins_with_any(std::string_view text, const std::array<std::string_view, N>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](std::string_view each) { return text.starts_with(each); });
}

/// What the kernel says of the first CPU, without what changes from one moment to the next.
std::string cpu_text() {
  constexpr std::array<std::string_view, 7> kOfTheMoment = {
      "cpu MHz", "bogomips", "BogoMIPS", "processor", "core id", "apicid", "initial apicid"};
  std::ifstream file("/proc/cpuinfo");
  std::string text;
  for (std::string line; std::getline(file, line) && !line.empty();) {
    if (!begins_with_any(line, kOfTheMoment)) text += line + "\n";
  }
  return text;
}

/// All variables of a worker but those of terminals, sessions and folders, of which no renderer
/// asks anything. Of a variable that we do not know we believe that it matters: that costs the
/// start of a worker, and nothing else.
std::vector<std::string> environment_that_matters(const WorkerOptions& options) {
  constexpr std::array<std::string_view, 19> kOthers = {
      "PWD=",           "OLDPWD=",     "SHLVL=",   "_=",        "TMPDIR=",   "TERM",
      "COLORTERM=",     "LINES=",      "COLUMNS=", "WINDOWID=", "SSH_",      "TMUX",
      "STY=",           "XDG_SESSION", "DBUS_",    "MAIL=",     "HISTFILE=", "INVOCATION_ID=",
      "JOURNAL_STREAM="};
  std::map<std::string, std::string> changes = options.environment;
  changes.merge(environment_of(options.conditions, options.preload));
  std::vector<std::string> environment = worker_environment({changes.begin(), changes.end()});
  std::erase_if(environment,
                [&](const std::string& entry) { return begins_with_any(entry, kOthers); });
  std::sort(environment.begin(), environment.end());
  return environment;
}

/// The members of a message that are remembered, by their names.
template <class Ready>
auto fields_of(Ready& ready) {
  return std::array{std::pair("blender", &ready.blender),
                    std::pair("build", &ready.build),
                    std::pair("ocio_config", &ready.ocio_config),
                    std::pair("kernel", &ready.kernel),
                    std::pair("embree", &ready.embree),
                    std::pair("reciprocals", &ready.reciprocals),
                    std::pair("libc", &ready.libc),
                    std::pair("device", &ready.device),
                    std::pair("devices", &ready.devices),
                    std::pair("denoisers", &ready.denoisers)};
}

}  // namespace

Result<BlenderInfo> known_blender(FrameCache* cache, const std::string& program) {
  if (cache == nullptr) return probe_blender(program);
  Result<BlenderProgram> found = find_blender(program);
  if (!found) return forward_error(found);
  if (!found->module.empty()) return probe_blender(program);  // is not started for that
  const fs::path& path = found->path;
  const std::string file = fmt::format("{}, {}", path.string(), stamp_of(path));
  const auto version = cache->recall("version of " + file);
  auto sha256 = cache->recall("sha256 of " + file);
  if (version && sha256) {
    Result<BlenderInfo> info = parse_blender_version(*version);
    if (info) {
      info->program = std::move(*found);
      info->sha256 = std::move(*sha256);
      return info;
    }
  }
  Result<BlenderInfo> info = probe_blender(path.string());
  if (info) {
    cache->remember("version of " + file, "Blender " + info->version);
    cache->remember("sha256 of " + file, info->sha256);
  }
  return info;
}

std::string worker_identity(const Json& facts, const WorkerOptions& options) {
  const Result<std::string> preload =
      options.preload.empty() ? Result<std::string>() : sha256_of_file(options.preload);
  const std::string cpu = cpu_text();
  if (!preload || cpu.empty()) return {};
  Json of_all_threads = facts;
  of_all_threads.erase("threads");
  std::string text;  // not JSON: a path or a variable need not be UTF-8
  const auto add = [&text](const std::string& part) { text += part + '\0'; };
  for (const std::string& part :
       {canonical_json(of_all_threads), std::string(name_of(options.conditions.device)),
        options.blender.name(), *preload, cpu,
        stamp_of("/etc/ld.so.cache"),  // is written anew whenever a library of the system changes
        std::string(options.wrapper.empty() ? "" : "wrapped")}) {
    add(part);
  }
  for (const std::string& entry : environment_that_matters(options)) add(entry);
  return sha256_hex(text);
}

std::optional<ReadyMessage> recall_worker(FrameCache& cache, const std::string& identity) {
  if (identity.empty()) return std::nullopt;
  const std::optional<std::string> said = cache.recall("worker " + identity);
  if (!said) return std::nullopt;
  const Result<Json> json = parse_json(*said, "the cache's memory of a worker");
  if (!json) return std::nullopt;
  ReadyMessage ready;
  for (const auto& [name, value] : fields_of(ready)) {
    Result<std::string> text = json_field<std::string>(*json, name, "the cache's memory");
    if (!text) return std::nullopt;
    *value = std::move(*text);
  }
  return ready;
}

void remember_worker(FrameCache& cache, const std::string& identity, const ReadyMessage& ready) {
  if (identity.empty()) return;
  Json said = Json::object();
  for (const auto& [name, value] : fields_of(ready)) said[name] = *value;
  cache.remember("worker " + identity, canonical_json(said));
}

}  // namespace seedframe
