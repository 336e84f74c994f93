// Amodal labels: what the twin knows of every instance, whatever stands before it.
#pragma once

#include "annotate/labels.h"
#include "twin/twin.h"

namespace seedframe {

/// Gives every label of a frame its amodal part and its keypoints. `instance_ids` is the image that
/// the labels were made from; a silhouette contains all that it shows of its instance.
void add_amodal_labels(FrameLabels& labels, const FrameSpec& spec, const Twin& twin,
                       const Image<std::uint16_t>& instance_ids);

/// Pixels of the silhouette in a box of the image.
std::int64_t silhouette_area_in(const AmodalLabel& amodal, const PixelRect& box);

/// The part of an affine map that is no shear, by polar decomposition.
Pose pose_of(const Affine& camera_from_object);

}  // namespace seedframe
