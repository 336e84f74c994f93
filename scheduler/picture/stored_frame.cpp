#include "picture/stored_frame.h"

#include <algorithm>

#include "twin/twin_comparison.h"

namespace seedframe {
namespace {

bool has_keypoints(const Dataset& dataset) {
  return std::any_of(dataset.keypoints.begin(), dataset.keypoints.end(),
                     [](const ClassKeypoints& points) { return !points.names.empty(); });
}

/// What holds for every frame of a campaign.
void note_absent_layers(const Dataset& dataset, FrameContent& content) {
  if (!dataset.has_images) {
    content.absent[Layer::kImage] =
        "The campaign has labels only (labels: geometry): nothing was rendered.";
    content.absent[Layer::kDisagreement] =
        "The labels are the twin's own (labels: geometry): there is nothing to compare.";
  }
  if (!dataset.has_depth) {
    content.absent[Layer::kDepth] = "It is kept with 'render: {passes: [depth]}' in the config.";
  }
  if (!has_keypoints(dataset)) {
    content.absent[Layer::kKeypoints] =
        "No asset of the campaign has any: 'seedframe asset keypoints' gives it some.";
  }
}

/// Of files that were written together all have one size.
template <class T>
Status check_size(const std::optional<Image<T>>& image, int channels, const FrameContent& content,
                  const CommittedFrame& frame, const char* what) {
  const Image<std::uint16_t>& ids = content.instance_ids;
  if (!image ||
      (image->width == ids.width && image->height == ids.height && image->channels == channels)) {
    return {};
  }
  return fail(ErrorKind::kCorrupt, "frame {}: its {} has {} × {} pixels, instances.png {} × {}",
              frame.index, what, image->width, image->height, ids.width, ids.height);
}

/// Or why there is nothing to be told.
Result<Image<std::uint8_t>> disagreement_of(const CommittedFrame& frame,
                                            const Image<std::uint16_t>& ids,
                                            const FrameExpansion& expand) {
  const Result<ExpandedFrame> expanded = expand(frame.index);
  if (!expanded) return forward_error(expanded);
  if (expanded->id != frame.frame_id) {
    return fail(ErrorKind::kInput,
                "The config or its inputs have changed since the frame was made: the twin would be "
                "another frame's.");
  }
  if (!expanded->spec.labels.twin_exact) {
    return fail(ErrorKind::kInput,
                "Textures cut holes into objects that only the renderer knows: such frames are not "
                "compared.");
  }
  TwinTracer tracer;
  const Result<Twin> twin =
      tracer.trace(expanded->spec, expanded->meshes, TwinTracer::Passes::kIdsOnly);
  if (!twin) return forward_error(twin);
  return difference_image(ids, twin->instance_ids, rounding_of(*twin));
}

}  // namespace

Result<FrameContent> read_content(const CommittedFrame& frame, const Dataset& dataset,
                                  const LayerSet& layers, const FrameExpansion& expand) {
  FrameParts parts;
  parts.image_pixels =
      dataset.has_images && (layers.has(Layer::kImage) || layers.has(Layer::kDisagreement));
  parts.depth = dataset.has_depth && layers.has(Layer::kDepth);
  parts.normal = layers.has(Layer::kNormals);
  const Result<FrameReader> reader = FrameReader::open(frame, parts);
  if (!reader) return forward_error(reader);
  Result<LoadedFrame> loaded = reader->load(dataset.categories);
  if (!loaded) return forward_error(loaded);
  FrameContent content;
  content.labels = std::move(loaded->labels);
  content.instance_ids = std::move(loaded->instance_ids);
  content.image = std::move(loaded->image);
  content.depth = std::move(loaded->depth);
  content.normal = std::move(loaded->normal);
  for (const Status& same : {check_size(content.image, 3, content, frame, "picture"),
                             check_size(content.depth, 1, content, frame, "depth"),
                             check_size(content.normal, 3, content, frame, "normals")}) {
    if (!same) return forward_error(same);
  }
  note_absent_layers(dataset, content);
  if (parts.normal && !content.normal) {
    content.absent[Layer::kNormals] = "They are kept with 'render: {passes: [normal]}'.";
  }
  if (layers.has(Layer::kDisagreement) && !content.absent.contains(Layer::kDisagreement)) {
    auto disagreement = disagreement_of(frame, content.instance_ids, expand);
    if (disagreement) {
      content.disagreement = std::move(*disagreement);
    } else {
      content.absent[Layer::kDisagreement] = disagreement.error().message;
    }
  }
  return content;
}

Skeletons skeletons_of(const Dataset& dataset) {
  Skeletons skeletons;
  for (const ClassKeypoints& points : dataset.keypoints) {
    std::vector<std::array<std::string, 2>>& joined = skeletons.emplace_back();
    for (const std::array<int, 2>& pair : points.skeleton) {
      joined.push_back({points.names.at(static_cast<std::size_t>(pair[0])),
                        points.names.at(static_cast<std::size_t>(pair[1]))});
    }
  }
  return skeletons;
}

}  // namespace seedframe
