#include "report/frame_explanation.h"

#include <algorithm>

#include "base/files.h"
#include "frames/campaign_files.h"
#include "frames/frame_reader.h"

namespace seedframe {
namespace {

/// None: not there, or damaged; an audit says which.
std::optional<FrameLabels> labels_in(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / frame_files::kLabels;
  const Result<std::string> text = read_file(file);
  if (!text) return std::nullopt;
  const Result<Json> json = parse_json(*text, file.string());
  if (!json) return std::nullopt;
  Result<FrameLabels> labels = labels_from_json(*json, file.string());
  return labels ? std::optional(std::move(*labels)) : std::nullopt;
}

/// All but the frame as it is expanded.
Result<FrameExplanation> known_of(const Campaign& campaign, std::int64_t frame) {
  const auto row = campaign.store.frame(frame);
  if (!row) return forward_error(row);
  if (!*row) {
    const auto counts = campaign.store.counts();
    return fail(ErrorKind::kInput, "the campaign has no frame {}: its frames are 0 to {}", frame,
                counts ? counts->total() - 1 : 0);
  }
  auto attempts = campaign.store.attempts(frame);
  if (!attempts) return forward_error(attempts);
  FrameExplanation explanation;
  explanation.row = **row;
  explanation.attempts = std::move(*attempts);
  if (auto manifest = read_manifest(campaign.files.frame(frame))) {
    explanation.manifest = std::move(*manifest);
  }
  return explanation;
}

/// Those of another frame than the expanded one would be misleading.
void add_labels(const Campaign& campaign, FrameExplanation& explanation) {
  if (!explanation.manifest || explanation.manifest->frame_id != explanation.expanded.id) return;
  explanation.labels = labels_in(campaign.files.frame(explanation.row.frame));
}

Json to_json(const ExplainedObject& object) {
  Json json = {{"id", object.id},
               {"name", object.name},
               {"asset", object.asset},
               {"category", object.category},
               {"position", {object.position.x(), object.position.y(), object.position.z()}},
               {"distance_m", object.distance_m}};
  if (object.visible_px) json["visible_px"] = *object.visible_px;
  if (object.visible_share) json["visible_share"] = *object.visible_share;
  return json;
}

}  // namespace

std::vector<ExplainedObject> explained_objects(const FrameExplanation& explanation,
                                               const std::vector<std::string>& categories) {
  std::vector<ExplainedObject> objects;
  for (const InstanceSpec& instance : explanation.expanded.spec.instances) {
    if (instance.id == 0) continue;
    ExplainedObject object;
    object.id = instance.id;
    object.name = instance.name;
    object.asset = instance.asset;
    if (instance.category != 0) {
      object.category = categories.at(static_cast<std::size_t>(instance.category) - 1);
    }
    const Eigen::Vector3d from_camera = instance.camera_from_object.translation();
    object.position = explanation.expanded.world_from_camera * from_camera;
    object.distance_m = from_camera.norm();
    if (explanation.labels) {
      const auto& known = explanation.labels->instances;
      const auto label = std::find_if(known.begin(), known.end(), [&](const InstanceLabel& each) {
        return each.id == instance.id;
      });
      if (label != known.end()) {
        object.visible_px = label->area_px;
        if (label->amodal) object.visible_share = label->visible_fraction();
      }
    }
    objects.push_back(std::move(object));
  }
  return objects;
}

Result<FrameExplanation> explain_frame(const Campaign& campaign, const PreparedCampaign& prepared,
                                       std::int64_t frame) {
  Result<FrameExplanation> explanation = known_of(campaign, frame);
  if (!explanation) return explanation;
  Result<ExpandedFrame> expanded = prepared.expander.expand(frame, {.draws = true});
  if (!expanded) return forward_error(expanded);
  explanation->expanded = std::move(*expanded);
  add_labels(campaign, *explanation);
  return explanation;
}

Result<FrameExplanation> explain_frame_alone(const Campaign& campaign, std::int64_t frame) {
  Result<FrameExplanation> explanation = known_of(campaign, frame);
  if (!explanation) return explanation;
  Result<FrameSpec> spec = stored_spec(campaign.files.frame(frame));
  if (!spec) return forward_error(spec);
  explanation->expanded.id = frame_id(*spec);
  explanation->expanded.scene = explanation->row.scene;
  explanation->expanded.spec = std::move(*spec);
  explanation->alone = true;
  add_labels(campaign, *explanation);
  return explanation;
}

Json provenance_of(const AttemptRow& attempt) {
  return attempt.provenance.empty() ? Json() : Json::parse(attempt.provenance, nullptr, false);
}

Json to_json(const FrameExplanation& explanation, const std::vector<std::string>& categories,
             const std::string& render_again) {
  Json objects = Json::array();
  for (const ExplainedObject& object : explained_objects(explanation, categories)) {
    objects.push_back(to_json(object));
  }
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
               {"objects", objects},
               {"draws", draws},
               {"attempts", attempts},
               {"render_again", render_again}};
  if (explanation.alone) json["positions"] = "camera";
  if (explanation.manifest) {
    json["pixels"] = explanation.manifest->pixel_hashes;
    if (explanation.manifest->pixel_hashes.contains("image")) {
      json["image"] = to_json(explanation.manifest->image);
    }
  }
  return json;
}

}  // namespace seedframe
