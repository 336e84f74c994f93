#include "slurm/task_frame.h"

#include <array>
#include <cstddef>

#include "frames/campaign_files.h"

namespace seedframe {
namespace {

constexpr std::array kStates = {FrameState::kDone, FrameState::kFailed, FrameState::kQuarantined};
constexpr std::array kOutcomes = {AttemptOutcome::kDone, AttemptOutcome::kError,
                                  AttemptOutcome::kCrash};

/// The one of `values` that is called so.
template <class Values>
auto named(const Values& values, const std::string& name) {
  for (const auto value : values) {
    if (name == to_string(value)) return value;
  }
  throw Json::other_error::create(501, "unknown name '" + name + "'", nullptr);
}

Json json_of(const AttemptRow& attempt) {
  return {{"worker", attempt.worker},     {"outcome", to_string(attempt.outcome)},
          {"started", attempt.started},   {"build_s", attempt.build_s},
          {"render_s", attempt.render_s}, {"finish_s", attempt.finish_s},
          {"message", attempt.message},   {"provenance", attempt.provenance}};
}

AttemptRow attempt_from(const Json& json) {
  AttemptRow attempt;
  attempt.worker = integer_of<int>(json.at("worker"));
  attempt.outcome = named(kOutcomes, json.at("outcome").get<std::string>());
  attempt.started = json.at("started").get<double>();
  attempt.build_s = json.at("build_s").get<double>();
  attempt.render_s = json.at("render_s").get<double>();
  attempt.finish_s = json.at("finish_s").get<double>();
  attempt.message = json.at("message").get<std::string>();
  attempt.provenance = json.at("provenance").get<std::string>();
  return attempt;
}

}  // namespace

Json to_json(const TaskFrame& record) {
  Json attempts = Json::array();
  for (const AttemptRow& attempt : record.attempts) attempts.push_back(json_of(attempt));
  return {
      {"frame", record.frame}, {"frame_id", record.frame_id}, {"state", to_string(record.state)},
      {"attempts", attempts},  {"workers", record.workers},   {"startup_s", record.startup_s},
      {"node", record.node}};
}

Result<TaskFrame> task_frame_from_json(const Json& json, const std::string& what) {
  try {
    TaskFrame record;
    record.frame = integer_of<std::int64_t>(json.at("frame"));
    record.frame_id = json.at("frame_id").get<std::string>();
    record.state = named(kStates, json.at("state").get<std::string>());
    for (const Json& attempt : json.at("attempts")) {
      record.attempts.push_back(attempt_from(attempt));
    }
    record.workers = integer_of<int>(json.at("workers"));
    record.startup_s = json.at("startup_s").get<double>();
    record.node = json.at("node").get<std::string>();
    if (record.attempts.empty()) {
      return fail(ErrorKind::kCorrupt, "{}: a record without an attempt", what);
    }
    return record;
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{}: not the record of a frame: {}", what, error.what());
  }
}

Json to_json(const TaskEnd& end) {
  return {{"stopped", end.stopped},
          {"error", end.error.message},
          {"kind", static_cast<int>(end.error.kind)}};
}

TaskEnd task_end_from_json(const Json& json) {
  TaskEnd end;
  if (!json.is_object()) return end;
  end.stopped = json.value("stopped", false);
  end.error.message = json.value("error", "");
  const int kind = json.value("kind", 0);
  const bool known = kind >= 0 && kind <= static_cast<int>(ErrorKind::kRender);
  end.error.kind = known ? static_cast<ErrorKind>(kind) : ErrorKind::kEnvironment;
  return end;
}

std::string batch_files::frame(std::int64_t frame) { return frame_stem(frame); }

std::string batch_files::record(std::int64_t frame) { return frame_stem(frame) + ".json"; }

std::string batch_files::rejected(std::int64_t frame) { return frame_stem(frame) + ".rejected"; }

std::string batch_files::log(std::int64_t frame, int attempt) {
  return fmt::format("{}-{}.log", frame_stem(frame), attempt);
}

}  // namespace seedframe
