#include "page/campaign_page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "base/files.h"
#include "base/utf8.h"
#include "export/kept_inputs.h"
#include "page/draw_table.h"
#include "page/frame_digest.h"
#include "page/health.h"
#include "page/near_duplicates.h"
#include "page/run_records.h"
#include "page/sprite_sheet.h"
#include "page/told_text.h"
#include "plan/left_out.h"
#include "report/campaign_status.h"

namespace seedframe {
namespace {

constexpr int kPageVersion = 1;
constexpr std::size_t kMostConfigBytes = 200'000;

/// An attempt without the text of its provenance, which thousands share.
struct ShownAttempt {
  AttemptRow row;
  std::int64_t provenance = -1;  ///< place among the campaign's; -1: unknown
};

/// Collects everything, part after part.
class PageMaker {
 public:
  PageMaker(const Campaign& campaign, const PreparedCampaign* prepared, const PageWish& wish)
      : campaign_(campaign), prepared_(prepared), wish_(wish), told_(campaign.files.root()) {}

  Result<Json> make(const std::string& why_not, const PartSink& sink);

 private:
  struct Seen {
    FrameDigest digest;
    std::vector<Draw> draws;
    std::vector<ConstraintTally> constraints;
    std::vector<LeftOut> left_out;
    bool is_expanded = false;
  };

  Status read_inputs();
  Status read_rows();
  Status read_attempts();
  void choose_sizes();
  CommittedFrame committed(const FrameRow& row) const;
  Seen look_at(const FrameRow& row) const;
  Status make_part(int part, const PartSink& sink);
  void add(const FrameRow& row, Seen& seen);
  Json frame_json(const FrameRow& row, const Seen& seen) const;
  Json campaign_json() const;
  Json summary_json(const CampaignStatus& status) const;
  Json constraints_json() const;
  Json left_out_json() const;

  const Campaign& campaign_;
  const PreparedCampaign* prepared_;
  PageWish wish_;
  ToldText told_;
  KeptInputs inputs_;
  bool knows_inputs_ = true;  ///< false: a frame has to tell
  std::vector<std::string> provenances_;
  std::vector<FrameRow> rows_;  ///< that are shown
  std::map<std::int64_t, std::vector<ShownAttempt>> attempts_;
  double worker_s_ = 0.0;  ///< of all attempts
  std::int64_t attempt_count_ = 0;
  ThumbnailSize image_;
  SheetLayout layout_;

  FrameTable table_;
  DrawTable draws_;
  std::vector<std::optional<PictureSignature>> signatures_;
  std::vector<ConstraintTally> constraints_;
  std::map<std::pair<std::string, std::string>, std::int64_t> left_out_;
  std::int64_t expanded_ = 0;
};

Status PageMaker::read_inputs() {
  Result<std::optional<KeptInputs>> kept = read_kept_inputs(campaign_.files);
  if (kept && *kept) {
    inputs_ = std::move(**kept);
    return {};
  }
  if (prepared_ == nullptr) {
    if (!kept) return forward_error(kept);
    inputs_.name = told_.name();
    knows_inputs_ = false;
    return {};
  }
  const CampaignSettings& settings = prepared_->settings;
  inputs_.name = settings.name;
  inputs_.seed = settings.seed;
  inputs_.categories = settings.categories;
  inputs_.has_images = settings.labels != LabelSource::kTwin;
  return {};
}

Status PageMaker::read_rows() {
  const Result<FrameCounts> counts = campaign_.store.counts();
  if (!counts) return forward_error(counts);
  const std::int64_t all = counts->total();
  const std::int64_t shown = std::min(all, wish_.most_frames);
  std::int64_t at = 0;
  return campaign_.store.for_each_frame([&](const FrameRow& row) -> Status {
    // The k-th that is shown is frame k · all / shown.
    const auto next = static_cast<std::int64_t>(rows_.size());
    if (next < shown && at == next * all / shown) rows_.push_back(row);
    ++at;
    return {};
  });
}

Status PageMaker::read_attempts() {
  auto provenances = campaign_.store.provenances();
  if (!provenances) return forward_error(provenances);
  provenances_ = std::move(*provenances);
  std::map<std::string, std::int64_t> places;
  for (const std::string& text : provenances_) {
    places.try_emplace(text, static_cast<std::int64_t>(places.size()));
  }
  std::size_t at = 0;
  return campaign_.store.for_each_attempt([&](const AttemptRow& row) -> Status {
    worker_s_ += row.build_s + row.render_s + (row.worker == kNoWorker ? 0.0 : row.finish_s);
    ++attempt_count_;
    while (at < rows_.size() && rows_[at].frame < row.frame) ++at;
    if (at == rows_.size() || rows_[at].frame != row.frame) return {};
    ShownAttempt shown{row, -1};
    const auto place = places.find(row.provenance);
    if (place != places.end()) shown.provenance = place->second;
    shown.row.provenance.clear();
    attempts_[row.frame].push_back(std::move(shown));
    return {};
  });
}

CommittedFrame PageMaker::committed(const FrameRow& row) const {
  return {row.frame, static_cast<int>(row.scene), campaign_.files.frame(row.frame), row.frame_id};
}

/// By the first frame that can be read; all have the same.
void PageMaker::choose_sizes() {
  image_ = {4, 3};
  if (prepared_ != nullptr) {
    image_ = {prepared_->settings.render.width, prepared_->settings.render.height};
  }
  for (const FrameRow& row : rows_) {
    if (row.state != FrameState::kDone) continue;
    const Result<FrameLabels> labels = stored_labels(committed(row));
    if (!labels || labels->width <= 0 || labels->height <= 0) continue;
    image_ = {labels->width, labels->height};
    if (knows_inputs_) break;
    inputs_.categories = labels->categories;
    const auto manifest = read_manifest(campaign_.files.frame(row.frame));
    inputs_.has_images = manifest && manifest->pixel_hashes.contains("image");
    break;
  }
  layout_ = sheet_layout(
      thumbnail_size(image_.width, image_.height, static_cast<std::int64_t>(rows_.size())));
}

PageMaker::Seen PageMaker::look_at(const FrameRow& row) const {
  Seen seen;
  if (row.state != FrameState::kDone) return seen;
  seen.digest = digest_frame(committed(row), inputs_.categories, inputs_.has_images, layout_.cell);
  if (prepared_ == nullptr) return seen;
  Result<ExpandedFrame> expanded = prepared_->expander.expand(row.frame, {.draws = true});
  // Those of another frame than the one on the disk would be misleading.
  if (!expanded || expanded->id != row.frame_id) return seen;
  seen.is_expanded = true;
  seen.draws = std::move(expanded->draws);
  seen.constraints = std::move(expanded->constraints);
  seen.left_out = left_out(expanded->spec);
  return seen;
}

void PageMaker::add(const FrameRow& row, Seen& seen) {
  FrameColumns& frames = table_.frames;
  const bool damaged = !seen.digest.damage.empty();
  frames.index.push_back(static_cast<std::uint32_t>(row.frame));
  frames.scene.push_back(static_cast<std::uint32_t>(row.scene));
  frames.state.push_back(static_cast<std::uint8_t>(damaged ? ShownState::kDamaged
                                                           : static_cast<ShownState>(row.state)));
  frames.attempts.push_back(static_cast<std::uint16_t>(std::min(row.attempts, 65'535)));
  const AttemptRow* good = nullptr;
  const auto attempts = attempts_.find(row.frame);
  if (attempts != attempts_.end()) {
    for (const ShownAttempt& each : attempts->second) {
      if (each.row.outcome == AttemptOutcome::kDone) good = &each.row;
    }
  }
  const auto seconds = [good](double AttemptRow::*part) {
    return good == nullptr ? std::numeric_limits<float>::quiet_NaN()
                           : static_cast<float>(good->*part);
  };
  frames.worker.push_back(good == nullptr ? kNoWorker : good->worker);
  frames.build_s.push_back(seconds(&AttemptRow::build_s));
  frames.render_s.push_back(seconds(&AttemptRow::render_s));
  frames.finish_s.push_back(seconds(&AttemptRow::finish_s));
  frames.luma.push_back(seen.digest.signature ? static_cast<std::uint8_t>(
                                                    std::lround(mean_luma(*seen.digest.signature)))
                                              : std::uint8_t{0});
  if (frames.first_object.empty()) frames.first_object.push_back(0);
  add_objects(seen.digest, table_);
  frames.first_object.push_back(static_cast<std::uint32_t>(table_.objects.size()));
  signatures_.push_back(seen.digest.signature);
  draws_.add(row.scene, seen.draws);
  if (!seen.is_expanded) return;
  ++expanded_;
  constraints_.resize(std::max(constraints_.size(), seen.constraints.size()));
  for (std::size_t i = 0; i < seen.constraints.size(); ++i) {
    constraints_[i].checked += seen.constraints[i].checked;
    constraints_[i].met += seen.constraints[i].met;
  }
  for (const LeftOut& each : seen.left_out) ++left_out_[{each.what, each.why}];
}

Json PageMaker::frame_json(const FrameRow& row, const Seen& seen) const {
  Json attempts = Json::array();
  const auto found = attempts_.find(row.frame);
  if (found != attempts_.end()) {
    for (const ShownAttempt& each : found->second) {
      attempts.push_back({{"attempt", each.row.attempt},
                          {"worker", each.row.worker},
                          {"outcome", to_string(each.row.outcome)},
                          {"build_s", each.row.build_s},
                          {"render_s", each.row.render_s},
                          {"finish_s", each.row.finish_s},
                          {"message", told_.of(each.row.message)},
                          {"provenance", each.provenance}});
    }
  }
  Json json = {{"id", row.frame_id}, {"attempts", std::move(attempts)}};
  if (!row.pixel_hash.empty()) json["pixel_hash"] = row.pixel_hash;
  if (!row.error.empty()) json["error"] = told_.of(row.error);
  if (!seen.digest.damage.empty()) json["damage"] = told_.of(seen.digest.damage);
  return json;
}

Status PageMaker::make_part(int part, const PartSink& sink) {
  const auto cells = static_cast<std::size_t>(layout_.cells());
  const std::size_t first = static_cast<std::size_t>(part) * cells;
  const std::size_t count = std::min(cells, rows_.size() - first);
  SpriteSheet sheet(layout_, static_cast<int>(count), inputs_.has_images);
  std::vector<Seen> all(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    all[i] = look_at(rows_[first + i]);
    if (rows_[first + i].state == FrameState::kDone && all[i].digest.damage.empty()) {
      sheet.set(static_cast<int>(i), all[i].digest.picture, all[i].digest.mask);
    }
    all[i].digest.picture.reset();
    all[i].digest.mask = {};
  });
  Json frames = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    add(rows_[first + i], all[i]);
    frames.push_back(frame_json(rows_[first + i], all[i]));
  }
  Result<Json> content = sheet.encode();
  if (!content) return forward_error(content);
  (*content)["frames"] = std::move(frames);
  return sink(part, *content);
}

Json PageMaker::campaign_json() const {
  Json json = {{"folder", told_.name()},
               {"name", as_utf8(inputs_.name)},
               {"seed", inputs_.seed},
               {"categories", inputs_.categories},
               {"has_pictures", inputs_.has_images},
               {"picture", "image" + std::string(ending_of(inputs_.image_format))},
               {"width", image_.width},
               {"height", image_.height}};
  if (const auto config = read_file(campaign_.files.config(), kMostConfigBytes)) {
    json["config"] = as_utf8(*config);
  }
  Json provenances = Json::array();
  for (const std::string& text : provenances_) {
    provenances.push_back(Json::parse(text, nullptr, /*allow_exceptions=*/false));
  }
  json["provenances"] = std::move(provenances);
  return json;
}

Json PageMaker::summary_json(const CampaignStatus& status) const {
  std::set<std::int32_t> workers;
  for (const std::int32_t worker : table_.frames.worker) {
    if (worker != kNoWorker) workers.insert(worker);
  }
  Json json = to_json(status);
  json.erase("provenances");
  json.erase("recent_failures");
  json.erase("quarantined_frames");
  json["inputs_touched"] = status.inputs_touched.size();  // their names are paths of this machine
  json["mixed"] = mixed_provenances(status);
  const auto& states = table_.frames.state;
  json["damaged"] =
      std::count(states.begin(), states.end(), static_cast<std::uint8_t>(ShownState::kDamaged));
  json["shown"] = rows_.size();
  json["attempts"] = attempt_count_;
  json["worker_s"] = worker_s_;
  json["workers"] = workers.size();
  return json;
}

Json PageMaker::constraints_json() const {
  Json json = Json::array();
  if (prepared_ == nullptr || expanded_ == 0) return json;
  const std::vector<std::string> names = prepared_->expander.constraint_names();
  for (std::size_t i = 0; i < std::min(names.size(), constraints_.size()); ++i) {
    json.push_back(
        {{"name", names[i]}, {"checked", constraints_[i].checked}, {"met", constraints_[i].met}});
  }
  return json;
}

Json PageMaker::left_out_json() const {
  Json json = Json::array();
  for (const auto& [what, frames] : left_out_) {
    json.push_back({{"what", what.first}, {"why", what.second}, {"frames", frames}});
  }
  return json;
}

Result<Json> PageMaker::make(const std::string& why_not, const PartSink& sink) {
  if (Status read = read_inputs(); !read) return forward_error(read);
  const Result<CampaignStatus> status = read_status(campaign_);
  if (!status) return forward_error(status);
  if (Status read = read_rows(); !read) return forward_error(read);
  if (Status read = read_attempts(); !read) return forward_error(read);
  choose_sizes();
  const auto cells = static_cast<std::size_t>(layout_.cells());
  const int parts = static_cast<int>((rows_.size() + cells - 1) / cells);
  const tbb::global_control at_most(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(std::max(1, wish_.threads)));
  for (int part = 0; part < parts; ++part) {
    if (Status made = make_part(part, sink); !made) return forward_error(made);
  }
  if (table_.frames.first_object.empty()) table_.frames.first_object.push_back(0);
  auto duplicates = near_duplicates(table_, signatures_, image_.width);
  ExportsFound exports = exports_found(campaign_, told_);
  const HealthFacts facts{table_,     inputs_.categories, image_.width, inputs_.has_images,
                          duplicates, exports.splits};
  Json health = Json::array();
  for (const HealthFinding& finding : check_health(facts)) health.push_back(to_json(finding));
  Result<Json> failures = failures_json(campaign_, told_);
  if (!failures) return forward_error(failures);
  Result<Json> errors = errors_json(campaign_, status->promise);
  if (!errors) return forward_error(errors);
  Json draws = {
      {"variables", draws_.to_json()},
      {"frames", expanded_},
      {"left_out", prepared_ == nullptr ? without_folders(told_.of(why_not)) : std::string()}};
  return Json{{"version", kPageVersion},
              {"campaign", campaign_json()},
              {"summary", summary_json(*status)},
              {"parts",
               {{"count", parts},
                {"cells", cells},
                {"columns", layout_.columns},
                {"width", layout_.cell.width},
                {"height", layout_.cell.height}}},
              {"frames", to_json(table_.frames)},
              {"objects", to_json(table_.objects)},
              {"assets", table_.assets.texts()},
              {"names", table_.names.texts()},
              {"draws", std::move(draws)},
              {"constraints", constraints_json()},
              {"left_out", left_out_json()},
              {"health", std::move(health)},
              {"duplicates", std::move(duplicates)},
              {"exports", std::move(exports.json)},
              {"failures", std::move(*failures)},
              {"errors", std::move(*errors)},
              {"audit", audit_json(campaign_.files, told_)}};
}

}  // namespace

Result<Json> campaign_page(const Campaign& campaign, const PreparedCampaign* prepared,
                           const std::string& why_not, const PageWish& wish, const PartSink& sink) {
  return PageMaker(campaign, prepared, wish).make(why_not, sink);
}

}  // namespace seedframe
