#include "spec/quality_wish.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace seedframe {
namespace {

constexpr int kVersion = 1;

Status check_version(const Json& json, const std::string& what, const char* kind) {
  const Result<int> version = json_field<int>(json, "version", what);
  if (!version) return forward_error(version);
  if (*version == kVersion) return {};
  return fail(ErrorKind::kCorrupt, "{} are {} of version {}; this program reads version {}", what,
              kind, *version, kVersion);
}

RenderChoice choice_from_json(const Json& json) {
  RenderChoice choice;
  choice.samples = integer_of<int>(json.at("samples"));
  if (json.contains("adaptive")) {
    json.at("adaptive").at("threshold").get_to(choice.adaptive.threshold);
    choice.adaptive.min_samples = integer_of<int>(json.at("adaptive").at("min_samples"));
  }
  const auto name = json.value("denoise", std::string(kDenoiseNames[0]));
  const auto found = std::find(kDenoiseNames.begin(), kDenoiseNames.end(), name);
  if (found == kDenoiseNames.end()) {
    throw Json::other_error::create(501, "unknown denoiser '" + name + "'", nullptr);
  }
  choice.denoise = static_cast<Denoise>(found - kDenoiseNames.begin());
  return choice;
}

std::int64_t frame_of(const std::string& key) {
  std::int64_t frame = 0;
  const char* end = key.data() + key.size();
  const auto [stop, error] = std::from_chars(key.data(), end, frame);
  if (error != std::errc() || stop != end) {
    throw Json::other_error::create(501, "'" + key + "' is no frame", nullptr);
  }
  return frame;
}

}  // namespace

ErrorBound error_bound(const QualityWish& wish) {
  if (wish.metric != QualityMetric::kPsnr) return {wish.metric, wish.max_error};
  constexpr double kPeak = 255.0;
  return {QualityMetric::kRmse8, kPeak * std::pow(10.0, -wish.max_error / 20.0)};
}

Json to_json(const QualityWish& wish) {
  return {{"version", kVersion},
          {"metric", kQualityMetricNames[static_cast<std::size_t>(wish.metric)]},
          {"max_error", wish.max_error},
          {"share", wish.share},
          {"denoise", wish.may_denoise}};
}

Result<QualityWish> quality_wish_from_json(const Json& json, const std::string& what) {
  if (Status known = check_version(json, what, "wishes"); !known) return forward_error(known);
  const auto metric = json_field<std::string>(json, "metric", what);
  if (!metric) return forward_error(metric);
  const auto& names = kQualityMetricNames;
  const auto found = std::find(names.begin(), names.end(), *metric);
  if (found == names.end()) {
    return fail(ErrorKind::kCorrupt, "{}: unknown metric '{}'", what, *metric);
  }
  const auto max_error = json_field<double>(json, "max_error", what);
  if (!max_error) return forward_error(max_error);
  const auto share = json_field<double>(json, "share", what);
  if (!share) return forward_error(share);
  const auto denoise = json_field<bool>(json, "denoise", what);
  if (!denoise) return forward_error(denoise);
  return QualityWish{static_cast<QualityMetric>(found - names.begin()), *max_error, *share,
                     *denoise};
}

Json to_json(const RenderChoice& choice) {
  Json json = {{"samples", choice.samples}};
  if (choice.adaptive.threshold > 0.0) {
    json["adaptive"] = {{"threshold", choice.adaptive.threshold},
                        {"min_samples", choice.adaptive.min_samples}};
  }
  if (choice.denoise != Denoise::kOff) {
    json["denoise"] = kDenoiseNames[static_cast<std::size_t>(choice.denoise)];
  }
  return json;
}

Json to_json(const RenderChoices& choices) {
  Json frames = Json::object();
  for (const auto& [frame, choice] : choices) frames[std::to_string(frame)] = to_json(choice);
  return {{"version", kVersion}, {"frames", frames}};
}

Result<RenderChoices> render_choices_from_json(const Json& json, const std::string& what) {
  if (Status known = check_version(json, what, "choices"); !known) return forward_error(known);
  try {
    RenderChoices choices;
    for (const auto& [key, value] : json.at("frames").items()) {
      choices[frame_of(key)] = choice_from_json(value);
    }
    return choices;
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{} are not what frames are rendered with: {}", what,
                error.what());
  }
}

}  // namespace seedframe
