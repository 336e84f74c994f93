#include "config/quality_section.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/nearest_name.h"

namespace seedframe {
namespace {

QualityMetric read_metric(SectionReader& section) {
  const auto& names = kQualityMetricNames;
  const auto node = section.require("metric");
  if (!node) return QualityMetric::kRmse8;
  const std::string name = section.text("metric", "");
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<QualityMetric>(found - names.begin());
  section.errors().add(node->place(),
                       fmt::format("expected one of {}, found '{}'{}", fmt::join(names, ", "), name,
                                   did_you_mean(name, {names.begin(), names.end()})));
  return QualityMetric::kRmse8;
}

bool read_may_denoise(SectionReader& section) {
  const std::string word = section.text("denoise", "off");
  if (word != "auto" && word != "off") {
    section.errors().add(section.node().find("denoise")->place(),
                         fmt::format("expected auto or off, found '{}'", word));
  }
  return word == "auto";
}

}  // namespace

std::optional<QualityWish> read_quality(SectionReader& campaign, const RenderConfig& render,
                                        const LabelConfig& labels) {
  const auto node = campaign.find("quality");
  if (!node || node->is_null()) return std::nullopt;
  SectionReader section(*node, campaign.errors());
  QualityWish wish;
  wish.metric = read_metric(section);
  section.require("max_error");
  wish.max_error = section.positive("max_error", 1.0);
  wish.share = section.positive("share", wish.share);
  if (wish.share >= 1.0) {
    campaign.errors().add(section.node().find("share")->place(),
                          "expected less than 1: no sample of noise can promise every frame");
  }
  wish.may_denoise = read_may_denoise(section);
  section.refuse_other_keys();
  if (render.adaptive != AdaptiveSampling{} || render.denoise != Denoise::kOff) {
    campaign.errors().add(node->place(),
                          "it chooses adaptive sampling and denoising of each frame itself: leave "
                          "render.adaptive and render.denoise out");
  }
  if (labels.source == LabelSource::kTwin) {
    campaign.errors().add(node->place(), "with 'labels: geometry' there are no pictures");
  }
  return wish;
}

}  // namespace seedframe
