#include "slurm/slurm_commands.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "render/child_process.h"
#include "slurm/task_plan.h"

namespace seedframe {
namespace {

constexpr auto kPatience = std::chrono::seconds(60);

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = std::min(text.find(separator), text.size());
    parts.push_back(text.substr(0, end));
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

template <class T>
std::optional<T> number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// "MaxArraySize            = 1001" of a list of such lines.
std::optional<int> setting(std::string_view config, std::string_view name) {
  for (std::string_view line : split(config, '\n')) {
    if (!line.starts_with(name)) continue;
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    std::string_view value = line.substr(equals + 1);
    value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
    value = value.substr(0, value.find_first_of(" \r"));
    if (const auto found = number<int>(value)) return found;
  }
  return std::nullopt;
}

Result<std::string> call(std::vector<std::string> arguments) {
  const std::optional<std::filesystem::path> program = find_in_path(arguments.front());
  if (!program) {
    return fail(ErrorKind::kEnvironment,
                "there is no program '{}' in PATH: --executor slurm is for a machine from which "
                "jobs of a Slurm cluster are submitted",
                arguments.front());
  }
  arguments.front() = program->string();
  return output_in(own_environment(), arguments, kPatience);
}

Status done(const Result<std::string>& output) {
  if (!output) return forward_error(output);
  return {};
}

}  // namespace

Result<SlurmCluster> read_cluster(std::string_view config, std::string_view nodes) {
  SlurmCluster cluster;
  const auto most_tasks = setting(config, "MaxArraySize");
  const auto most_jobs = setting(config, "MaxJobCount");
  if (!most_tasks || !most_jobs || *most_tasks < 2) {
    return fail(ErrorKind::kEnvironment,
                "'scontrol show config' tells no MaxArraySize and MaxJobCount, so that no array of "
                "tasks can be submitted{}",
                most_tasks && *most_tasks < 2 ? " (arrays are turned off)" : "");
  }
  cluster.most_tasks = *most_tasks;  // indices are below it, from 0
  cluster.most_jobs = *most_jobs;
  std::set<std::string_view> names;
  int least_cpus = std::numeric_limits<int>::max();
  // The partition that jobs go to which name none is marked; if one was named, it is the only one.
  const bool has_default = nodes.find("*\n") != std::string_view::npos;
  for (const std::string_view line : split(nodes, '\n')) {
    const std::vector<std::string_view> fields = split(line, '|');
    if (fields.size() != 4 || (has_default && !fields[3].ends_with('*'))) continue;
    const auto cpus = number<int>(fields[1]);
    const bool gone = fields[2].starts_with("down") || fields[2].starts_with("drain");
    if (!cpus || gone) continue;
    names.insert(fields[0]);
    least_cpus = std::min(least_cpus, *cpus);
  }
  cluster.nodes = std::max(1, static_cast<int>(names.size()));
  cluster.cpus = names.empty() ? 1 : std::max(1, least_cpus);
  return cluster;
}

std::vector<QueuedTask> read_queue(std::string_view text) {
  std::vector<QueuedTask> tasks;
  for (const std::string_view line : split(text, '\n')) {
    const std::vector<std::string_view> fields = split(line, '|');
    if (fields.size() != 5) continue;
    const auto job = number<std::int64_t>(fields[0]);
    const auto index = number<int>(fields[1]);  // "N/A" of jobs that are no arrays
    if (!job || !index) continue;
    const bool waits = fields[2] == "PENDING" || fields[2].starts_with("REQUEUE");
    tasks.push_back({*job, *index, waits, waits ? std::string() : std::string(fields[3]),
                     std::string(fields[4])});
  }
  return tasks;
}

std::optional<std::int64_t> read_job_id(std::string_view text) {
  for (const std::string_view line : split(text, '\n')) {
    if (const auto job = number<std::int64_t>(line.substr(0, line.find(';')))) return job;
  }
  return std::nullopt;
}

std::string index_list(const std::vector<int>& indices) {
  std::string list;
  for (std::size_t i = 0; i < indices.size();) {
    std::size_t last = i;
    while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) ++last;
    list += fmt::format("{}{}{}", list.empty() ? "" : ",", indices[i],
                        last > i ? fmt::format("-{}", indices[last]) : "");
    i = last + 1;
  }
  return list;
}

bool is_refusal(std::string_view message) {
  // What Slurm 20 to 24 print (src/common/slurm_errno.c), and what its option parser does.
  constexpr std::array kRefusals = {"invalid partition",
                                    "Invalid account",
                                    "Invalid qos",
                                    "Requested node configuration is not available",
                                    "Requested partition configuration not available",
                                    "Requested time limit is invalid",
                                    "Invalid node name",
                                    "More processors requested than permitted",
                                    "Memory specification can not be satisfied",
                                    "Invalid feature specification",
                                    "Invalid generic resource",
                                    "Invalid license specification",
                                    "Invalid --",
                                    "Invalid numeric value",
                                    "Invalid job array specification",
                                    "unrecognized option",
                                    "unrecognised option",
                                    "invalid option",
                                    "requires an argument",
                                    "Unable to open file",
                                    "User's group not permitted",
                                    "Access/permission denied",
                                    "Batch script is empty"};
  return std::any_of(kRefusals.begin(), kRefusals.end(), [&](const char* refusal) {
    return message.find(refusal) != std::string_view::npos;
  });
}

Result<SlurmCluster> SlurmCommands::cluster() const {
  const Result<std::string> config = call({"scontrol", "show", "config"});
  if (!config) return forward_error(config);
  std::vector<std::string> ask = {"sinfo", "--noheader", "--Node", "--format=%N|%c|%T|%P"};
  if (!options_.partition.empty()) ask.push_back("--partition=" + options_.partition);
  const Result<std::string> nodes = call(std::move(ask));
  if (!nodes) return forward_error(nodes);
  return read_cluster(*config, *nodes);
}

Result<std::int64_t> SlurmCommands::submit(const ArrayOrder& order) const {
  std::string array = "--array=" + index_list(order.indices);
  if (options_.nodes > 0) array += fmt::format("%{}", options_.nodes);
  std::vector<std::string> arguments = {
      "sbatch",
      "--parsable",
      array,
      "--job-name=" + order.name,
      "--comment=" + order.comment,
      "--output=" + (order.logs / "%A_%a.log").string(),
      "--open-mode=append",
      "--no-requeue",  // another task makes what is left, with a token of its own
      fmt::format("--signal=B:TERM@{}", stop_signal_s(order.time_s)),
      "--nodes=1",
      "--ntasks=1",
      fmt::format("--cpus-per-task={}", order.cpus)};
  if (!options_.partition.empty()) arguments.push_back("--partition=" + options_.partition);
  if (order.time_s > 0) arguments.push_back("--time=" + slurm_time(order.time_s));
  if (!order.exclude.empty()) {
    arguments.push_back(fmt::format("--exclude={}", fmt::join(order.exclude, ",")));
  }
  arguments.insert(arguments.end(), options_.more.begin(), options_.more.end());
  arguments.push_back(order.script.string());
  const Result<std::string> output = call(std::move(arguments));
  if (!output) {
    std::string why = output.error().message;
    while (why.ends_with('\n')) why.pop_back();
    return tl::unexpected(
        Error{is_refusal(why) ? ErrorKind::kInput : ErrorKind::kEnvironment, why});
  }
  if (const auto job = read_job_id(*output)) return *job;
  return fail(ErrorKind::kEnvironment, "sbatch answered without the id of a job: {}", *output);
}

Result<std::vector<QueuedTask>> SlurmCommands::queue() const {
  const Result<std::string> output =
      call({"squeue", "--noheader", "--array", fmt::format("--user={}", ::getuid()),
            "--format=%F|%K|%T|%B|%k"});
  if (!output) return forward_error(output);
  return read_queue(*output);
}

Status SlurmCommands::cancel(std::int64_t job, bool waiting_only) const {
  std::vector<std::string> arguments = {"scancel", "--quiet", std::to_string(job)};
  if (waiting_only) arguments.insert(arguments.begin() + 1, "--state=PENDING");
  return done(call(std::move(arguments)));
}

Status SlurmCommands::cancel_task(std::int64_t job, int index) const {
  return done(call({"scancel", "--quiet", fmt::format("{}_{}", job, index)}));
}

Status SlurmCommands::tell_to_stop(std::int64_t job) const {
  return done(call(
      {"scancel", "--quiet", "--batch", "--signal=TERM", "--state=RUNNING", std::to_string(job)}));
}

Status SlurmCommands::exclude(std::int64_t job, const std::vector<std::string>& nodes) const {
  return done(call({"scontrol", "update", fmt::format("JobId={}", job),
                    fmt::format("ExcNodeList={}", fmt::join(nodes, ","))}));
}

}  // namespace seedframe
