#include "slurm/submission.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/files.h"
#include "campaign/run_options.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr int kSubmissionVersion = 1;

Json json_of(const CampaignSource& source) {
  Json overrides = Json::array();
  for (const Override& change : source.overrides) {
    overrides.push_back({{"path", change.path}, {"value", change.value}});
  }
  Json allowed = Json::array();
  for (const fs::path& folder : source.allowed.folders()) allowed.push_back(folder.string());
  std::error_code ignored;
  return {{"text", source.text},
          {"file", fs::absolute(source.file, ignored).string()},
          {"home", fs::absolute(source.home, ignored).string()},
          {"overrides", overrides},
          {"allowed", allowed},
          {"graphs", source.graphs.string()}};
}

CampaignSource source_from(const Json& json) {
  CampaignSource source{json.at("text").get<std::string>(),
                        json.at("file").get<std::string>(),
                        {},
                        json.at("home").get<std::string>()};
  for (const Json& change : json.at("overrides")) {
    source.overrides.push_back(
        {change.at("path").get<std::string>(), change.at("value").get<std::string>()});
  }
  for (const Json& folder : json.at("allowed")) source.allowed.add(folder.get<std::string>());
  source.graphs = json.at("graphs").get<std::string>();
  return source;
}

std::int64_t milliseconds_of(std::chrono::milliseconds time) { return time.count(); }

}  // namespace

Json to_json(const Submission& submission) {
  Json crashes = Json::array();
  for (const auto& [frame, count] : submission.crashes) crashes.push_back({frame, count});
  return {{"version", kSubmissionVersion},
          {"seedframe", SEEDFRAME_VERSION},
          {"token", submission.token},
          {"batches", submission.batches},
          {"crashes", crashes},
          {"source", json_of(submission.source)},
          {"choices", submission.choices ? to_json(*submission.choices) : Json()},
          {"node_folder", submission.node_folder.string()},
          {"run", submission.run}};
}

Result<Submission> read_submission(const SubmissionFiles& files) {
  const std::string what = files.submission().string();
  const Result<std::string> text = read_file(files.submission());
  if (!text) return forward_error(text);
  const Result<Json> json = parse_json(*text, what);
  if (!json) return forward_error(json);
  try {
    const auto by = json->at("seedframe").get<std::string>();
    if (by != SEEDFRAME_VERSION || integer_of<int>(json->at("version")) != kSubmissionVersion) {
      return fail(ErrorKind::kEnvironment,
                  "{} was written by Seedframe {}, and this is {}: all nodes must use the program "
                  "that the head does, at the same path",
                  what, by, SEEDFRAME_VERSION);
    }
    Submission submission;
    submission.token = json->at("token").get<std::string>();
    submission.batches = json->at("batches").get<std::vector<std::vector<std::int64_t>>>();
    for (const Json& each : json->at("crashes")) {
      submission.crashes[integer_of<std::int64_t>(each.at(0))] = integer_of<int>(each.at(1));
    }
    submission.source = source_from(json->at("source"));
    if (!json->at("choices").is_null()) {
      Result<RenderChoices> choices = render_choices_from_json(json->at("choices"), what);
      if (!choices) return forward_error(choices);
      submission.choices = std::make_shared<const RenderChoices>(std::move(*choices));
    }
    submission.node_folder = json->at("node_folder").get<std::string>();
    submission.run = json->at("run");
    return submission;
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{} is no submission: {}", what, error.what());
  }
}

Json options_for_tasks(const RunOptions& asked) {
  const PoolOptions& pool = asked.pool;
  return {{"blender", asked.blender},
          {"workers", pool.workers},
          {"threads", asked.worker.threads},
          {"max_errors", pool.attempts.errors},
          {"max_crashes", pool.attempts.crashes},
          {"frame_timeout_ms", milliseconds_of(pool.frame_timeout)},
          {"start_timeout_ms", milliseconds_of(pool.start_timeout)},
          {"heartbeat_timeout_ms", milliseconds_of(pool.heartbeat_timeout)},
          {"frames_per_worker", pool.frames_per_worker},
          {"worker_memory_bytes", pool.worker_memory_bytes},
          {"begin_together", pool.begin_together},
          {"sandbox", asked.sandbox},
          {"environment", asked.worker.environment}};
}

Result<RunOptions> options_of_tasks(const Json& run, const std::string& what) {
  const auto milliseconds = [&](const char* key) {
    return std::chrono::milliseconds(integer_of<std::int64_t>(run.at(key)));
  };
  try {
    RunOptions options;
    PoolOptions& pool = options.pool;
    options.blender = run.at("blender").get<std::string>();
    pool.workers = integer_of<int>(run.at("workers"));
    options.worker.threads = integer_of<int>(run.at("threads"));
    pool.attempts.errors = integer_of<int>(run.at("max_errors"));
    pool.attempts.crashes = integer_of<int>(run.at("max_crashes"));
    pool.frame_timeout = milliseconds("frame_timeout_ms");
    pool.start_timeout = milliseconds("start_timeout_ms");
    pool.heartbeat_timeout = milliseconds("heartbeat_timeout_ms");
    pool.frames_per_worker = integer_of<int>(run.at("frames_per_worker"));
    pool.worker_memory_bytes = integer_of<std::int64_t>(run.at("worker_memory_bytes"));
    pool.begin_together = run.at("begin_together").get<bool>();
    options.sandbox = run.at("sandbox").get<bool>();
    options.worker.environment = run.at("environment").get<std::map<std::string, std::string>>();
    return options;
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{}: not the options of a run: {}", what, error.what());
  }
}

Result<ClaimOutcome> claim_batch(const SubmissionFiles& files, int batch, const Claim& claim) {
  const fs::path path = files.claim(batch);
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (file < 0) {
    if (errno == EEXIST) return ClaimOutcome::kTaken;
    return system_failure("create", path, errno);
  }
  const std::string text =
      canonical_json({{"node", claim.node}, {"task", claim.task}, {"by_head", claim.by_head}});
  const ssize_t written = ::write(file, text.data(), text.size());
  const int error = written < 0 ? errno : ENOSPC;
  const bool whole = written == static_cast<ssize_t>(text.size()) && ::fsync(file) == 0;
  ::close(file);
  if (!whole) return system_failure("write", path, error);
  if (Status synced = sync_path(files.claims()); !synced) return forward_error(synced);
  return ClaimOutcome::kOurs;
}

std::optional<Claim> read_claim(const SubmissionFiles& files, int batch) {
  const fs::path path = files.claim(batch);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return std::nullopt;
  Claim claim;  // whose writer may have died before it could say who it was
  const Result<std::string> text = read_file(path);
  const Json json = text ? Json::parse(*text, nullptr, false) : Json();
  if (!json.is_object()) return claim;
  claim.node = json.value("node", "");
  claim.task = json.value("task", "");
  claim.by_head = json.value("by_head", false);
  return claim;
}

Status close_batch(const SubmissionFiles& files, int batch) {
  if (Status marked = write_file_atomically(files.over(batch), "over\n"); !marked) return marked;
  std::error_code error;
  if (!fs::exists(files.results(batch), error)) return {};
  return rename_file(files.results(batch), files.closed_results(batch));
}

bool is_closed(const SubmissionFiles& files, int batch) {
  std::error_code ignored;
  return fs::exists(files.over(batch), ignored);
}

}  // namespace seedframe
