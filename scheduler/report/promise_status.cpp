#include "report/promise_status.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "quality/error_record.h"
#include "quality/raise.h"

namespace seedframe {
namespace {

Result<std::optional<QualityWish>> read_wish(const Campaign& campaign) {
  const Result<std::string> text = campaign.store.meta(kQualityKey);
  if (!text) return forward_error(text);
  if (text->empty()) return std::nullopt;
  const std::string what = campaign.files.store().string();
  const Result<Json> json = parse_json(*text, what);
  if (!json) return forward_error(json);
  const Result<QualityWish> wish = quality_wish_from_json(*json, what);
  if (!wish) return forward_error(wish);
  return *wish;
}

/// Errors in this measure of frames that still are what was measured.
Result<std::vector<FrameError>> present_errors(const Campaign& campaign, const ErrorRecord& record,
                                               const Measure& measure) {
  std::vector<FrameError> errors;
  for (const auto& [frame, recorded] : record) {
    const auto row = campaign.store.frame(frame);
    if (!row) return forward_error(row);
    const auto error = recorded.errors.find(measure.key);
    if (!*row || !is_of(recorded, **row) || error == recorded.errors.end()) continue;
    errors.push_back({frame, error->second});
  }
  return errors;
}

/// `errors` are of frames as they are now, `frames` how many there are in all.
void judge(const std::vector<FrameError>& errors, const std::set<std::int64_t>& raised,
           std::int64_t frames, PromiseStatus& status) {
  std::set<std::int64_t> unmeasured = raised;
  int within_now = 0;
  int within_as_chosen = 0;
  for (const FrameError& each : errors) {
    unmeasured.erase(each.frame);
    if (!status.promise.allows(each.error)) {
      status.beyond.push_back(each);
      continue;
    }
    ++within_now;
    if (!raised.contains(each.frame)) ++within_as_chosen;
  }
  status.raised.assign(raised.begin(), raised.end());
  status.raised_unmeasured.assign(unmeasured.begin(), unmeasured.end());
  status.checked = static_cast<int>(errors.size() + unmeasured.size());
  status.as_chosen = estimate_share(within_as_chosen, status.checked);
  const double others = static_cast<double>(frames - status.checked) * status.as_chosen.value;
  status.share_now = (within_now + others) / static_cast<double>(std::max<std::int64_t>(1, frames));
  // As (1 + 19) / 20 is not 0.95 to the last bit, so is a sum of shares not.
  constexpr double kRounding = 1e-12;
  status.is_kept = status.checked > 0 && status.share_now >= status.promise.share - kRounding;
}

std::string checked_line(const PromiseStatus& status) {
  const auto percent = [](double share) { return 100.0 * share; };
  std::string line = fmt::format("checked on {} frames: {:.0f} % (between {:.0f} and {:.0f} %)",
                                 status.checked, percent(status.as_chosen.value),
                                 percent(status.as_chosen.least), percent(status.as_chosen.most));
  if (!status.raised.empty()) {
    line +=
        fmt::format(" as they were chosen; {} of them raised since, which makes {:.0f} % of all",
                    status.raised.size(), percent(status.share_now));
  }
  return line + (status.is_kept ? ": kept" : ": BROKEN");
}

}  // namespace

Result<std::optional<PromiseStatus>> read_promise_status(const Campaign& campaign) {
  const auto wish = read_wish(campaign);
  if (!wish) return forward_error(wish);
  if (!*wish) return std::nullopt;
  const Result<ErrorRecord> record = read_error_record(campaign);
  if (!record) return forward_error(record);
  const auto raised = raised_frames(campaign);
  if (!raised) return forward_error(raised);
  const Result<FrameCounts> counts = campaign.store.counts();
  if (!counts) return forward_error(counts);
  PromiseStatus status;
  status.promise = promise_of(**wish);
  const auto errors = present_errors(campaign, *record, *status.promise.measure);
  if (!errors) return forward_error(errors);
  judge(*errors, *raised, counts->total(), status);
  for (const FrameError& each : *errors) {
    const int samples = record->at(each.frame).reference_samples;
    status.reference_samples =
        status.reference_samples == 0 ? samples : std::min(status.reference_samples, samples);
  }
  return status;
}

Json to_json(const PromiseStatus& status) {
  Json beyond = Json::array();
  for (const FrameError& each : status.beyond) {
    beyond.push_back(
        {{"frame", each.frame}, {"error", std::isfinite(each.error) ? Json(each.error) : Json()}});
  }
  Json json = {{"measure", status.promise.measure->key},
               {"max_error", status.promise.max_error},
               {"share", status.promise.share},
               {"checked", status.checked}};
  if (status.checked == 0) return json;
  json["reference_samples"] = status.reference_samples;
  json["within"] = status.as_chosen.value;
  json["within_least"] = status.as_chosen.least;
  json["within_most"] = status.as_chosen.most;
  json["within_now"] = status.share_now;
  json["kept"] = status.is_kept;
  json["beyond"] = beyond;
  json["raised"] = status.raised;
  json["raised_unmeasured"] = status.raised_unmeasured;
  return json;
}

std::vector<std::string> lines_of(const PromiseStatus& status, const std::string& folder) {
  const std::string promised = fmt::format("{:g} % of the frames within {} of {:.4g}: promised; ",
                                           100.0 * status.promise.share,
                                           status.promise.measure->key, status.promise.max_error);
  if (status.checked == 0) {
    return {promised + fmt::format("not checked yet: 'seedframe verify-error {}'", folder)};
  }
  std::vector<std::string> lines = {promised + checked_line(status)};
  if (!status.beyond.empty()) {
    std::vector<std::string> frames;
    for (const FrameError& each : status.beyond) {
      frames.push_back(fmt::format("{} ({:.3g})", each.frame, each.error));
    }
    lines.push_back(
        fmt::format("beyond it: {}; 'seedframe resume {} --raise' gives them more samples",
                    fmt::join(frames, ", "), folder));
  }
  if (!status.raised_unmeasured.empty()) {
    lines.push_back(
        fmt::format("raised and not checked since: 'seedframe verify-error {} --frame {}'", folder,
                    fmt::join(status.raised_unmeasured, " --frame ")));
  }
  return lines;
}

}  // namespace seedframe
