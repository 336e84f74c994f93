#include "quality/raise.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "quality/error_record.h"
#include "quality/sample_counts.h"
#include "quality/setting_steps.h"

namespace seedframe {
namespace {

constexpr int kRaisesVersion = 1;
constexpr const char* kRaisesKey = "raises";  // in the store's meta

/// Of an error that was measured, for what it is not known by and what it may fall less than.
constexpr double kMargin = 1.1;

/// error ∝ samples^−power, or threshold^power: what falls slowest of what was measured in
/// results/error_vs_time, from 16 to 64 plain samples, over all denoised ones, and between
/// thresholds of 0.05 and 0.02.
struct Powers {
  double plain, denoised, adaptive;
};
constexpr Powers kOfRmse8 = {0.5, 0.25, 0.4};
constexpr Powers kOfRelMse = {1.0, 0.5, 0.8};
constexpr Powers kOfFlip = {0.35, 0.25, 0.2};

const Powers& powers_of(QualityMetric metric) {
  if (metric == QualityMetric::kRelMse) return kOfRelMse;
  return metric == QualityMetric::kFlip ? kOfFlip : kOfRmse8;
}

Result<Json> read_raises(const Campaign& campaign) {
  const Result<std::string> text = campaign.store.meta(kRaisesKey);
  if (!text) return forward_error(text);
  if (text->empty()) return Json::array();
  const std::string what = campaign.files.store().string();
  const Result<Json> json = parse_json(*text, what);
  if (!json) return forward_error(json);
  const Result<int> version = json_field<int>(*json, "version", what);
  if (!version) return forward_error(version);
  if (*version != kRaisesVersion) {
    return fail(ErrorKind::kCorrupt, "{} has raises of version {}; this program reads version {}",
                what, *version, kRaisesVersion);
  }
  return json_field<Json>(*json, "raises", what);
}

Json to_json(const Raise& raise, const ErrorPromise& promise) {
  return {{"frame", raise.frame},
          {"measure", promise.measure->key},
          {"error", std::isfinite(raise.error) ? Json(raise.error) : Json()},
          {"max_error", promise.max_error},
          {"from", to_json(raise.from)},
          {"to", to_json(raise.to)}};
}

}  // namespace

std::optional<RenderChoice> raised_choice(const RenderChoice& choice, double error,
                                          const ErrorBound& bound, int most_samples) {
  const RenderChoice most{most_samples, {}, Denoise::kOff};
  const bool is_adaptive = choice.adaptive.threshold > 0.0;
  const bool is_denoised = choice.denoise != Denoise::kOff;
  if (!is_adaptive && !is_denoised && choice.samples >= most_samples) return std::nullopt;
  const double ratio = kMargin * error / bound.max_error;
  if (!std::isfinite(ratio)) return most;
  const Powers& powers = powers_of(bound.metric);
  RenderChoice raised = choice;
  if (is_adaptive) {
    const double threshold = choice.adaptive.threshold * std::pow(ratio, -1.0 / powers.adaptive);
    // Of pixels that stop at the first look, the threshold says nothing: they need more samples.
    const int first_look = choice.adaptive.min_samples + kSamplesBetweenLooks;
    const double looks =
        std::ceil(first_look * std::pow(ratio, 1.0 / powers.plain) / kSamplesBetweenLooks);
    if (threshold < kFinestThreshold || looks * kSamplesBetweenLooks >= most_samples) return most;
    raised.samples = most_samples;
    raised.adaptive = {rounded_threshold(threshold),
                       (static_cast<int>(looks) - 1) * kSamplesBetweenLooks};
    return raised;
  }
  const double power = is_denoised ? powers.denoised : powers.plain;
  const double samples = choice.samples * std::pow(ratio, 1.0 / power);
  if (samples > most_samples) return most;
  raised.samples = std::min(most_samples, rounded_samples(samples));
  return raised;
}

std::string describe(const RenderChoice& choice) {
  if (choice.adaptive.threshold > 0.0) {
    return fmt::format("adaptive sampling to {}, at least {} samples", choice.adaptive.threshold,
                       choice.adaptive.min_samples);
  }
  return fmt::format("{} samples{}", choice.samples,
                     choice.denoise == Denoise::kOff ? "" : ", denoised");
}

Result<RaisePlan> plan_raises(const Campaign& campaign, const PreparedCampaign& prepared) {
  const std::string folder = campaign.files.root().string();
  if (!prepared.settings.quality) {
    return fail(ErrorKind::kInput,
                "the config of {} has no section 'quality': no error is promised that frames could "
                "be raised to",
                folder);
  }
  const Result<ErrorRecord> record = read_error_record(campaign);
  if (!record) return forward_error(record);
  if (record->empty()) {
    return fail(ErrorKind::kInput,
                "no frame of {} has been measured: 'seedframe verify-error {}' does that", folder,
                folder);
  }
  const ErrorBound bound = error_bound(*prepared.settings.quality);
  RaisePlan plan;
  plan.promise = promise_of(*prepared.settings.quality);
  for (const auto& [frame, recorded] : *record) {
    const auto row = campaign.store.frame(frame);
    if (!row) return forward_error(row);
    const auto error = recorded.errors.find(plan.promise.measure->key);
    if (!*row || !is_of(recorded, **row) || error == recorded.errors.end()) continue;
    if (plan.promise.allows(error->second)) continue;
    const auto choice = prepared.expander.choices()->find(frame);
    if (choice == prepared.expander.choices()->end()) continue;
    const auto raised =
        raised_choice(choice->second, error->second, bound, prepared.settings.render.samples);
    if (raised) {
      plan.raises.push_back({frame, error->second, choice->second, *raised});
    } else {
      plan.at_their_most.push_back({frame, error->second});
    }
  }
  return plan;
}

Status raise_frames(Campaign& campaign, PreparedCampaign& prepared, const RaisePlan& plan) {
  Result<Json> raises = read_raises(campaign);
  if (!raises) return forward_error(raises);
  auto choices = std::make_shared<RenderChoices>(*prepared.expander.choices());
  for (const Raise& raise : plan.raises) {
    (*choices)[raise.frame] = raise.to;
    raises->push_back(to_json(raise, plan.promise));
  }
  prepared.expander.set_choices(choices);
  JobStore& store = campaign.store;
  return store.write_together(JobStore::Sync::kNow, [&]() -> Status {
    for (const Raise& raise : plan.raises) {
      const Result<ExpandedFrame> expanded = prepared.expander.expand(raise.frame);
      if (!expanded) return forward_error(expanded);
      if (Status done = store.renew(raise.frame, expanded->id); !done) return done;
    }
    const std::string text = canonical_json(seedframe::to_json(*choices));
    if (Status set = store.set_meta(kChoicesKey, text); !set) return set;
    const Json all = {{"version", kRaisesVersion}, {"raises", *raises}};
    return store.set_meta(kRaisesKey, canonical_json(all));
  });
}

Result<std::set<std::int64_t>> raised_frames(const Campaign& campaign) {
  const Result<Json> raises = read_raises(campaign);
  if (!raises) return forward_error(raises);
  std::set<std::int64_t> frames;
  for (const Json& raise : *raises) {
    const auto frame = json_field<std::int64_t>(raise, "frame", campaign.files.store().string());
    if (!frame) return forward_error(frame);
    frames.insert(*frame);
  }
  return frames;
}

}  // namespace seedframe
