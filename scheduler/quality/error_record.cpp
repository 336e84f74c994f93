#include "quality/error_record.h"

#include <charconv>
#include <cmath>
#include <limits>

namespace seedframe {
namespace {

constexpr int kRecordVersion = 1;
constexpr const char* kErrorsKey = "errors";  // in the store's meta

RecordedError recorded_from_json(const Json& json) {
  RecordedError recorded;
  json.at("frame_id").get_to(recorded.frame_id);
  json.at("pixel_hash").get_to(recorded.pixel_hash);
  recorded.reference_samples = integer_of<int>(json.at("reference_samples"));
  for (const auto& [measure, error] : json.at("errors").items()) {
    recorded.errors[measure] =
        error.is_null() ? std::numeric_limits<double>::quiet_NaN() : error.get<double>();
  }
  return recorded;
}

RecordedError recorded_of(const CheckedFrame& frame, int reference_samples) {
  RecordedError recorded{frame.frame_id, frame.pixel_hash, reference_samples, {}};
  for (const Measure& measure : measures()) {
    recorded.errors[measure.key] = measure.of(frame.error);
  }
  return recorded;
}

}  // namespace

Json to_json(const ErrorRecord& record) {
  Json frames = Json::object();
  for (const auto& [frame, recorded] : record) {
    Json errors = Json::object();
    for (const auto& [measure, error] : recorded.errors) {
      errors[measure] = std::isfinite(error) ? Json(error) : Json();
    }
    frames[std::to_string(frame)] = {{"frame_id", recorded.frame_id},
                                     {"pixel_hash", recorded.pixel_hash},
                                     {"reference_samples", recorded.reference_samples},
                                     {"errors", errors}};
  }
  return {{"version", kRecordVersion}, {"frames", frames}};
}

Result<ErrorRecord> error_record_from_json(const Json& json, const std::string& what) {
  const Result<int> version = json_field<int>(json, "version", what);
  if (!version) return forward_error(version);
  if (*version != kRecordVersion) {
    return fail(ErrorKind::kCorrupt,
                "{} has measured errors of version {}; this program reads version {}", what,
                *version, kRecordVersion);
  }
  try {
    ErrorRecord record;
    for (const auto& [key, value] : json.at("frames").items()) {
      std::int64_t frame = 0;
      const char* end = key.data() + key.size();
      const auto [stop, error] = std::from_chars(key.data(), end, frame);
      if (error != std::errc() || stop != end) {
        return fail(ErrorKind::kCorrupt, "{}: '{}' is no frame", what, key);
      }
      record[frame] = recorded_from_json(value);
    }
    return record;
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{} has measured errors that are none: {}", what,
                error.what());
  }
}

Result<ErrorRecord> read_error_record(const Campaign& campaign) {
  const Result<std::string> text = campaign.store.meta(kErrorsKey);
  if (!text) return forward_error(text);
  if (text->empty()) return ErrorRecord();
  const std::string what = campaign.files.store().string();
  const Result<Json> json = parse_json(*text, what);
  if (!json) return forward_error(json);
  return error_record_from_json(*json, what);
}

bool is_of(const RecordedError& recorded, const FrameRow& row) {
  return row.state == FrameState::kDone && row.frame_id == recorded.frame_id &&
         row.pixel_hash == recorded.pixel_hash;
}

Status keep_errors(Campaign& campaign, const ErrorCheck& check) {
  const Result<FolderLock> lock = FolderLock::acquire(campaign.files.lock());
  if (!lock) return forward_error(lock);
  Result<ErrorRecord> record = read_error_record(campaign);
  if (!record) return forward_error(record);
  for (const CheckedFrame& frame : check.frames) {
    (*record)[frame.frame] = recorded_of(frame, check.reference_samples);
  }
  return campaign.store.set_meta(kErrorsKey, canonical_json(to_json(*record)));
}

}  // namespace seedframe
