#include "report/frame_explanation.h"

namespace seedframe {

Result<FrameExplanation> explain_frame(const Campaign& campaign, const PreparedCampaign& prepared,
                                       std::int64_t frame) {
  const auto row = campaign.store.frame(frame);
  if (!row) return forward_error(row);
  if (!*row) {
    const auto counts = campaign.store.counts();
    return fail(ErrorKind::kInput, "the campaign has no frame {}: its frames are 0 to {}", frame,
                counts ? counts->total() - 1 : 0);
  }
  Result<ExpandedFrame> expanded = prepared.expander.expand(frame, {.draws = true});
  if (!expanded) return forward_error(expanded);
  auto attempts = campaign.store.attempts(frame);
  if (!attempts) return forward_error(attempts);
  FrameExplanation explanation{**row, std::move(*expanded), std::move(*attempts), {}};
  if (auto manifest = read_manifest(campaign.files.frame(frame))) {
    explanation.manifest = std::move(*manifest);
  }
  return explanation;
}

Json provenance_of(const AttemptRow& attempt) {
  return attempt.provenance.empty() ? Json() : Json::parse(attempt.provenance, nullptr, false);
}

Json to_json(const FrameExplanation& explanation, const std::string& render_again) {
  Json draws = Json::object();
  for (const Draw& draw : explanation.expanded.draws) draws[draw.name] = draw.value;
  Json attempts = Json::array();
  for (const AttemptRow& row : explanation.attempts) {
    attempts.push_back({{"attempt", row.attempt},
                        {"worker", row.worker},
                        {"outcome", to_string(row.outcome)},
                        {"build_s", row.build_s},
                        {"render_s", row.render_s},
                        {"finish_s", row.finish_s},
                        {"message", row.message},
                        {"provenance", provenance_of(row)}});
  }
  Json json = {{"frame", explanation.row.frame},
               {"scene", explanation.row.scene},
               {"frame_of_scene", explanation.expanded.view},
               {"frame_id", explanation.row.frame_id},
               {"state", to_string(explanation.row.state)},
               {"unchanged", explanation.expanded.id == explanation.row.frame_id},
               {"pixel_hash", explanation.row.pixel_hash},
               {"draws", draws},
               {"attempts", attempts},
               {"render_again", render_again}};
  if (explanation.manifest) {
    json["pixels"] = explanation.manifest->pixel_hashes;
    if (explanation.manifest->pixel_hashes.contains("image")) {
      json["image"] = to_json(explanation.manifest->image);
    }
  }
  return json;
}

}  // namespace seedframe
