#include "page/run_records.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "base/files.h"
#include "export/export_index.h"
#include "frames/campaign_files.h"
#include "image/png_file.h"
#include "image_files/image_writer.h"
#include "page/packed.h"
#include "page/thumbnail.h"
#include "quality/error_record.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

constexpr int kMostFailures = 100;
constexpr std::size_t kMostAuditPictures = 40;
constexpr std::size_t kMostAuditFrames = 500;
constexpr std::size_t kLogTail = 6'000;  // bytes
constexpr int kPictureSide = 480;

/// Base64 of a WebP; null where there is no such picture, or it cannot be read.
Json picture_json(const fs::path& png) {
  const Result<Image<std::uint8_t>> image = read_png8(png);
  if (!image || (image->channels != 1 && image->channels != 3)) return {};
  Image<std::uint8_t> rgb(image->width, image->height, 3);
  for (int row = 0; row < image->height; ++row) {
    for (int column = 0; column < image->width; ++column) {
      for (int c = 0; c < 3; ++c) {
        rgb.at(row, column, c) = image->at(row, column, std::min(c, image->channels - 1));
      }
    }
  }
  const double scale =
      std::min(1.0, static_cast<double>(kPictureSide) / std::max(rgb.width, rgb.height));
  const auto side = [scale](int px) {
    return std::max(1, static_cast<int>(std::lround(scale * px)));
  };
  const Result<std::string> webp = encode_image(reduced(rgb, {side(rgb.width), side(rgb.height)}),
                                                {.format = ImageFormat::kWebp, .quality = 80});
  return webp ? Json(base64(*webp)) : Json();
}

/// The end of a log, from the beginning of a line on.
Json log_json(const fs::path& file, const ToldText& told) {
  const Result<std::string> text = read_file(file);
  if (!text) return {};
  std::string tail = text->size() > kLogTail ? text->substr(text->size() - kLogTail) : *text;
  if (tail.size() < text->size()) {
    const std::size_t line = tail.find('\n');
    tail = "…\n" + (line == std::string::npos ? tail : tail.substr(line + 1));
  }
  return told.of(tail);
}

Json failure_json(const Campaign& campaign, const FrameRow& row, const ToldText& told) {
  Json json = {
      {"frame", row.frame},       {"scene", row.scene},     {"state", to_string(row.state)},
      {"attempts", row.attempts}, {"crashes", row.crashes}, {"error", told.of(row.error)}};
  for (int attempt = row.attempts; attempt > 0; --attempt) {
    Json log = log_json(campaign.files.crash_log(row.frame, attempt), told);
    if (log.is_null()) continue;
    json["log"] = std::move(log);
    break;
  }
  Json picture = picture_json(campaign.files.rejected(row.frame) / frame_files::kDifference);
  if (!picture.is_null()) json["rejected"] = std::move(picture);
  return json;
}

/// The members of an object that are there.
Json members(const Json& object, const std::vector<std::string>& keys) {
  Json some = Json::object();
  for (const std::string& key : keys) {
    if (object.contains(key)) some[key] = object.at(key);
  }
  return some;
}

/// Every text in it told.
void tell(Json& json, const ToldText& told) {
  if (json.is_string()) {
    json = told.of(json.get<std::string>());
  } else if (json.is_structured()) {
    for (Json& each : json) tell(each, told);
  }
}

Json audited_frames(const Json& frames, const fs::path& folder) {
  Json shown = Json::array();
  std::size_t pictures = 0;
  for (const Json& frame : frames) {
    if (shown.size() == kMostAuditFrames) break;
    if (!frame.is_object()) continue;
    Json json = members(frame, {"frame", "why", "grade", "error", "cause", "difference"});
    const auto index = frame.contains("frame") ? integer_in<std::int64_t>(frame.at("frame"))
                                               : std::optional<std::int64_t>();
    if (index && frame.contains("picture") && pictures < kMostAuditPictures) {
      Json picture = picture_json(folder / "differences" / (frame_stem(*index) + ".png"));
      pictures += picture.is_null() ? 0 : 1;
      json["picture"] = std::move(picture);
    }
    shown.push_back(std::move(json));
  }
  return shown;
}

/// Frames of each split of an export, from its index.
Result<std::vector<SplitScenes>> splits_of(const fs::path& folder, const ExportMarker& marker,
                                           const std::map<std::int64_t, std::int64_t>& scenes) {
  std::vector<SplitScenes> splits;
  for (const SplitShare& share : marker.options.splits) {
    splits.push_back({marker.format, share.name, {}, {}});
  }
  const Result<std::string> index = read_file(folder / kIndexFile);
  if (!index) return forward_error(index);
  std::vector<std::set<std::int64_t>> of_split(splits.size());
  std::istringstream lines(*index);
  for (std::string line; std::getline(lines, line);) {
    const Result<IndexEntry> entry = parse_index_line(line, (folder / kIndexFile).string());
    if (!entry) return forward_error(entry);
    if (entry->split < 0 || static_cast<std::size_t>(entry->split) >= splits.size()) continue;
    const auto split = static_cast<std::size_t>(entry->split);
    splits[split].frames.push_back(entry->frame);
    const auto scene = scenes.find(entry->frame);
    if (scene != scenes.end()) of_split[split].insert(scene->second);
  }
  for (std::size_t i = 0; i < splits.size(); ++i) {
    splits[i].scenes.assign(of_split[i].begin(), of_split[i].end());
  }
  return splits;
}

}  // namespace

Result<Json> failures_json(const Campaign& campaign, const ToldText& told) {
  const Result<FrameCounts> counts = campaign.store.counts();
  if (!counts) return forward_error(counts);
  Json frames = Json::array();
  for (const FrameState state : {FrameState::kQuarantined, FrameState::kFailed}) {
    const int left = kMostFailures - static_cast<int>(frames.size());
    if (left <= 0) break;
    const auto rows = campaign.store.frames_in(state, left);
    if (!rows) return forward_error(rows);
    for (const FrameRow& row : *rows) frames.push_back(failure_json(campaign, row, told));
  }
  const auto recovered = campaign.store.recent_failures(kMostFailures);
  if (!recovered) return forward_error(recovered);
  Json attempts = Json::array();
  for (const AttemptRow& row : *recovered) {
    attempts.push_back({{"frame", row.frame},
                        {"attempt", row.attempt},
                        {"outcome", to_string(row.outcome)},
                        {"message", told.of(row.message)}});
  }
  return Json{{"count", counts->failed + counts->quarantined},
              {"frames", std::move(frames)},
              {"attempts", std::move(attempts)}};
}

Json audit_json(const CampaignFiles& files, const ToldText& told) {
  const fs::path folder = files.root() / "audit";
  const Result<std::string> text = read_file(folder / "report.json");
  if (!text) return {};
  const Result<Json> report = parse_json(*text, "report.json");
  if (!report || !report->is_object() || !report->contains("grade")) return {};
  Json json = members(*report, {"grade", "grades", "campaign_frames", "done", "rounds"});
  if (report->contains("files")) {
    const Json& read = report->at("files");
    json["files"] = members(read, {"frames", "bytes", "problems", "of_no_frame", "other_inputs"});
  }
  if (report->contains("frames") && report->at("frames").is_array()) {
    json["frames"] = audited_frames(report->at("frames"), folder);
    json["sampled"] = report->at("frames").size();
  }
  tell(json, told);
  return json;
}

Result<Json> errors_json(const Campaign& campaign, const std::optional<PromiseStatus>& promise) {
  const Result<ErrorRecord> record = read_error_record(campaign);
  if (!record) return forward_error(record);
  if (!promise && record->empty()) return Json();
  Json frames = Json::array();
  for (const auto& [frame, recorded] : *record) {
    const auto row = campaign.store.frame(frame);
    if (!row) return forward_error(row);
    if (!*row || !is_of(recorded, **row)) continue;
    Json errors = Json::object();
    for (const auto& [measure, error] : recorded.errors) {
      errors[measure] = std::isfinite(error) ? Json(error) : Json();
    }
    frames.push_back({{"frame", frame}, {"errors", std::move(errors)}});
  }
  return Json{{"promise", promise ? to_json(*promise) : Json()}, {"frames", std::move(frames)}};
}

ExportsFound exports_found(const Campaign& campaign, const ToldText& told) {
  ExportsFound found;
  std::error_code error;
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(campaign.files.exports(), error)) {
    if (fs::exists(entry.path() / kMarkerFile, error)) folders.push_back(entry.path());
  }
  if (folders.empty()) return found;
  std::sort(folders.begin(), folders.end());
  std::map<std::int64_t, std::int64_t> scenes;
  const Status read = campaign.store.for_each_frame([&scenes](const FrameRow& row) -> Status {
    scenes[row.frame] = row.scene;
    return {};
  });
  if (!read) return found;
  for (const fs::path& folder : folders) {
    Json json = {{"folder", told.of("exports/" + folder.filename().string())}};
    const Result<ExportMarker> marker = read_marker(folder);
    const auto splits = marker ? splits_of(folder, *marker, scenes)
                               : Result<std::vector<SplitScenes>>(forward_error(marker));
    if (!splits) {
      json["error"] = told.of(splits.error().message);
      found.json.push_back(std::move(json));
      continue;
    }
    json["format"] = told.of(marker->format);
    json["splits"] = Json::array();
    for (const SplitScenes& split : *splits) {
      json["splits"].push_back({{"name", told.of(split.split)},
                                {"frames", split.frames.size()},
                                {"scenes", split.scenes.size()}});
    }
    found.json.push_back(std::move(json));
    found.splits.insert(found.splits.end(), splits->begin(), splits->end());
  }
  return found;
}

}  // namespace seedframe
