// COCO's entries, as one line of canonical JSON each (docs/formats/coco.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "annotate/mask.h"
#include "base/canonical_json.h"
#include "export/dataset.h"
#include "export/document.h"
#include "export/export_frame.h"

namespace seedframe {

/// COCO has no image 0 in use.
std::int64_t coco_image_id(std::int64_t frame);
/// The same whatever is filtered, split or added. Evaluation reads an id of 0 as "no match".
std::int64_t coco_annotation_id(std::int64_t frame, int instance);

/// {"counts":"…","size":[height,width]}
std::string coco_rle(const Mask& mask);

/// {"file_name":…,"height":…,"id":…,"seedframe_frame_id":…,"width":…}
std::string coco_image(const ExportFrame& frame, std::string_view file_name);

/// `keypoints`: members to put where canonical JSON has them, ending in a comma, or empty.
std::string coco_annotation(const ExportFrame& frame, const ExportInstance& instance,
                            std::string_view segmentation, std::string_view keypoints = {});

/// A COCO file with these categories: images in its section 0, annotations in section 1.
DocumentKind coco_document(std::string path, DocumentKind::Scope scope, const Dataset& dataset,
                           const Json& categories);
inline constexpr int kCocoImages = 0;
inline constexpr int kCocoAnnotations = 1;

/// {"id":1,"name":"bolt","supercategory":"object"} for every category.
Json coco_categories(const Dataset& dataset);

/// How an annotation differs from the instance: ids, category, box, area. Empty when it does not.
std::string coco_difference(const Json& annotation, const ExportFrame& frame,
                            const ExportInstance& instance);
/// Whether the run lengths of an entry are those of the mask, pixel by pixel.
bool coco_rle_is(const Json& segmentation, const Mask& mask);

}  // namespace seedframe
