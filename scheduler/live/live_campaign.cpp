#include "live/live_campaign.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/clock.h"
#include "base/cores.h"
#include "frames/frame_reader.h"
#include "image_files/image_writer.h"
#include "page/campaign_page.h"
#include "page/frame_digest.h"
#include "page/page_text.h"
#include "page/thumbnail.h"
#include "page/told_text.h"

namespace seedframe {
namespace {

constexpr std::int64_t kMostPageFrames = 20'000;  // in a page: their thumbnails are all in it
constexpr int kNewest = 12;
constexpr int kMostRunning = 256;
constexpr int kFailures = 5;
constexpr std::chrono::seconds kRateWindow{60};
constexpr int kThumbnailSide = 320;
constexpr int kPageTimes = 10;  // an earlier page is given for so many times of what it took

double seconds_of(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

/// Of masks: what tells objects apart in a campaign without pictures (as page/web/theme.js).
constexpr std::array<std::array<std::uint8_t, 3>, 8> kMaskColors = {{{230, 159, 0},
                                                                     {86, 180, 233},
                                                                     {0, 158, 115},
                                                                     {240, 228, 66},
                                                                     {0, 114, 178},
                                                                     {213, 94, 0},
                                                                     {204, 121, 167},
                                                                     {153, 153, 51}}};

Image<std::uint8_t> colored_mask(const Image<std::uint8_t>& mask,
                                 const std::vector<InstanceLabel>& objects) {
  Image<std::uint8_t> picture(mask.width, mask.height, 3);
  for (std::size_t i = 0; i < mask.values.size(); ++i) {
    std::array<std::uint8_t, 3> color = {27, 34, 44};
    if (mask.values[i] > 0) {
      const int category = objects[static_cast<std::size_t>(mask.values[i]) - 1].category;
      color = category == 0
                  ? std::array<std::uint8_t, 3>{138, 143, 152}
                  : kMaskColors[static_cast<std::size_t>(category - 1) % kMaskColors.size()];
    }
    std::copy(color.begin(), color.end(),
              picture.values.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return picture;
}

}  // namespace

Result<LiveCampaign> LiveCampaign::open(const std::filesystem::path& folder,
                                        const std::filesystem::path& home, LiveClock clock) {
  Result<Campaign> campaign = open_campaign(folder);
  if (!campaign) return forward_error(campaign);
  return LiveCampaign(std::move(*campaign), home, std::move(clock));
}

std::string LiveCampaign::name() const { return ToldText(campaign_.files.root()).name(); }

Status LiveCampaign::read_store() {
  const auto version = campaign_.store.data_version();
  if (!version) return forward_error(version);
  if (version_ == *version) return {};
  const auto counts = campaign_.store.counts();
  if (!counts) return forward_error(counts);
  auto running = campaign_.store.frames_in(FrameState::kRunning, kMostRunning);
  if (!running) return forward_error(running);
  auto newest = campaign_.store.recent_done(kNewest);
  if (!newest) return forward_error(newest);
  auto failures = campaign_.store.recent_failures(kFailures);
  if (!failures) return forward_error(failures);
  const auto hash = campaign_.store.dataset_hash();
  if (!hash) return forward_error(hash);
  running_attempts_.clear();
  for (const FrameRow& row : *running) {
    const auto attempts = campaign_.store.attempts(row.frame);
    if (!attempts) return forward_error(attempts);
    if (!attempts->empty() && attempts->back().outcome == AttemptOutcome::kRunning) {
      running_attempts_.push_back(attempts->back());
    }
  }
  counts_ = *counts;
  newest_ = std::move(*newest);
  failures_ = std::move(*failures);
  dataset_hash_ = *hash;
  version_ = *version;
  return {};
}

void LiveCampaign::note_progress(bool at_work) {
  if (!at_work) {
    progress_.clear();
    return;
  }
  const auto now = clock_();
  if (progress_.empty() || now - progress_.back().when >= std::chrono::seconds(1)) {
    progress_.push_back({now, counts_.done});
  }
  while (progress_.size() > 2 && now - progress_[1].when > kRateWindow) progress_.pop_front();
}

/// Of the last minute; 0: nothing can be said.
double LiveCampaign::rate_per_s() const {
  if (progress_.size() < 2) return 0.0;
  const double time = seconds_of(progress_.back().when - progress_.front().when);
  const auto frames = static_cast<double>(progress_.back().done - progress_.front().done);
  return time >= 1.0 ? frames / time : 0.0;
}

Result<Json> LiveCampaign::state(RunControl& control) {
  if (Status read = read_store(); !read) return forward_error(read);
  const RunState run = control.state(campaign_);
  note_progress(run.scheduler.has_value());
  const ToldText told(campaign_.files.root());
  const double rate = rate_per_s();
  const auto left = static_cast<double>(counts_.pending + counts_.running);
  Json workers = Json::array();
  for (const AttemptRow& attempt : running_attempts_) {
    Json worker = {{"worker", attempt.worker},
                   {"frame", attempt.frame},
                   {"attempt", attempt.attempt},
                   {"seconds", std::max(0.0, unix_time() - attempt.started)}};
    std::int64_t memory = 0;
    for (const WorkerProcess& process : run.workers) {
      if (process.worker == attempt.worker) memory += process.memory_bytes;
    }
    worker["memory_bytes"] = memory > 0 ? Json(memory) : Json();
    workers.push_back(std::move(worker));
  }
  Json newest = Json::array();
  for (const AttemptRow& attempt : newest_) newest.push_back(attempt.frame);
  Json failures = Json::array();
  for (const AttemptRow& attempt : failures_) {
    failures.push_back({{"frame", attempt.frame}, {"message", told.of(attempt.message)}});
  }
  const bool at_work = run.scheduler.has_value();
  return Json{{"frames", counts_.total()},
              {"done", counts_.done},
              {"pending", counts_.pending},
              {"running", counts_.running},
              {"failed", counts_.failed},
              {"quarantined", counts_.quarantined},
              {"dataset_hash", dataset_hash_},
              {"at_work", at_work},
              {"starting", run.starting},
              {"died", !at_work && !run.starting && counts_.running > 0},
              {"last_words", told.of(run.last_words)},
              {"scheduler_bytes", run.memory_bytes},
              {"rate_per_s", rate},
              {"eta_s", at_work && rate > 0.0 ? Json(left / rate) : Json()},
              {"workers", std::move(workers)},
              {"newest", std::move(newest)},
              {"failures", std::move(failures)}};
}

/// Of all that a page is made of, as far as it is cheap to ask.
Result<std::string> LiveCampaign::page_version() const {
  const auto version = campaign_.store.data_version();
  if (!version) return forward_error(version);
  std::string text = std::to_string(*version);
  for (const std::filesystem::path& path :
       {campaign_.files.root() / "audit" / "report.json", campaign_.files.exports()}) {
    std::error_code error;
    const auto written = std::filesystem::last_write_time(path, error);
    text += fmt::format(" {}", error ? 0 : written.time_since_epoch().count());
  }
  return text;
}

Result<std::string> LiveCampaign::page(const Json& others) {
  const Result<std::string> version = page_version();
  if (!version) return forward_error(version);
  const auto begin = clock_();
  if (page_ && (page_->version == *version || begin - page_->when < kPageTimes * page_->took)) {
    return page_->html;
  }
  const Result<PreparedCampaign> prepared = prepare_again(campaign_, home_);
  PageWish wish;
  wish.threads = core_count();
  wish.most_frames = kMostPageFrames;
  std::string parts;
  Result<Json> data = campaign_page(campaign_, prepared ? &*prepared : nullptr,
                                    prepared ? std::string() : prepared.error().message, wish,
                                    [&parts](int part, const Json& content) -> Status {
                                      parts += part_element(part, content);
                                      return {};
                                    });
  if (!data) return forward_error(data);
  (*data)["live"] = {{"others", others}};
  const PageText text = page_text(*data, {.connects = true, .loads_parts = false});
  page_ = MadePage{text.begin + parts + text.end, *version, clock_(), clock_() - begin};
  return page_->html;
}

Result<std::string> LiveCampaign::thumbnail(std::int64_t frame) {
  const auto row = campaign_.store.frame(frame);
  if (!row) return forward_error(row);
  if (!*row || (*row)->state != FrameState::kDone) {
    return fail(ErrorKind::kInput, "there is no finished frame {}", frame);
  }
  const CommittedFrame committed = {frame, static_cast<int>((*row)->scene),
                                    campaign_.files.frame(frame), (*row)->frame_id};
  const Result<FrameLabels> labels = stored_labels(committed);
  if (!labels) return forward_error(labels);
  const auto manifest = read_manifest(committed.folder);
  if (!manifest) return forward_error(manifest);
  const double scale =
      std::min(1.0, static_cast<double>(kThumbnailSide) / std::max(labels->width, labels->height));
  const auto side = [scale](int px) {
    return std::max(1, static_cast<int>(std::lround(scale * px)));
  };
  const FrameDigest digest =
      digest_frame(committed, labels->categories, manifest->pixel_hashes.contains("image"),
                   {side(labels->width), side(labels->height)});
  if (!digest.damage.empty()) return fail(ErrorKind::kCorrupt, "{}", digest.damage);
  return encode_image(digest.picture ? *digest.picture : colored_mask(digest.mask, digest.objects),
                      {.format = ImageFormat::kWebp, .quality = 75});
}

}  // namespace seedframe
