// What a page takes of one frame on disk.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "annotate/labels.h"
#include "base/error.h"
#include "frames/frame_reader.h"
#include "page/frame_table.h"
#include "page/thumbnail.h"

namespace seedframe {

struct FrameDigest {
  std::string damage;  ///< why there is nothing else here; empty: the frame is whole
  std::vector<InstanceLabel> objects;
  std::optional<Image<std::uint8_t>> picture;  ///< a thumbnail; none: the campaign has no pictures
  Image<std::uint8_t> mask;                    ///< reduced_mask of the objects
  std::optional<PictureSignature> signature;
};

/// labels.json, whatever the manifest says.
Result<FrameLabels> stored_labels(const CommittedFrame& frame);

/// Reads and checks the frame's files as an export does.
FrameDigest digest_frame(const CommittedFrame& frame, const std::vector<std::string>& categories,
                         bool has_pictures, ThumbnailSize size);

/// Adds the objects, in their order.
void add_objects(const FrameDigest& digest, FrameTable& table);

}  // namespace seedframe
