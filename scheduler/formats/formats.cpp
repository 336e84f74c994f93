#include "formats/formats.h"

#include "formats/bop.h"
#include "formats/coco.h"
#include "formats/patches.h"
#include "formats/statistics.h"
#include "formats/voc.h"
#include "formats/webdataset.h"
#include "formats/yolo.h"

namespace seedframe {

const FormatList& export_formats() {
  static const FormatList formats = {
      {"coco", "COCO instances, masks as run lengths (exact, and the smallest)", make_coco},
      {"coco-polygon", "COCO instances, masks as polygons (decode to the same pixels)",
       make_coco_polygon},
      {"coco-keypoints", "COCO keypoints: named points of assets", make_coco_keypoints},
      {"coco-panoptic", "COCO panoptic: a PNG with a segment's id in every pixel",
       make_coco_panoptic},
      {"yolo-detect", "YOLO boxes: a row 'class x y width height' for each instance",
       make_yolo_detect},
      {"yolo-segment", "YOLO segments: a row 'class x1 y1 x2 y2 ...' for each instance",
       make_yolo_segment},
      {"yolo-obb", "YOLO oriented boxes: a row 'class' and four corners", make_yolo_obb},
      {"yolo-pose", "YOLO boxes with keypoints", make_yolo_pose},
      {"voc", "Pascal VOC: boxes as XML, segmentation as palette images", make_voc},
      {"bop", "BOP: 6D poses, depth, full and visible masks, models", make_bop},
      {"patches", "classification: an image of each object, in a folder of its class",
       make_patches},
      {"webdataset", "tar shards of images, instance ids and annotations", make_webdataset},
      {"statistics", "numbers about the dataset, as JSON", make_statistics},
  };
  return formats;
}

}  // namespace seedframe
