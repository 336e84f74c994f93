#include "formats/voc.h"

#include <sstream>

#include <pugixml.hpp>

#include "annotate/amodal.h"
#include "annotate/mask.h"
#include "formats/class_folders.h"
#include "formats/voc_colors.h"
#include "image/png_file.h"

namespace seedframe {
namespace {

constexpr std::size_t kMostIndices = 254;  // 255 is "void", 0 background
std::string in_root(const std::string& path) { return "VOCdevkit/VOC2012/" + path; }

std::string xml_path(const ExportFrame& frame) {
  return in_root("Annotations/" + frame.stem + ".xml");
}

Palette palette() {
  Palette colors;
  for (std::size_t i = 0; i < 256; ++i) colors.push_back(voc_color(i));
  return colors;
}

/// Everting, Van Gool, Williams, Winn & Zisserman: annotation guidelines of VOC2011. Truncated:
/// more than 15-20 % of the object is outside the box. Occluded: more than 5 % of it in the box is
/// hidden.
struct Flags {
  bool truncated = false;
  bool occluded = false;
};

Flags flags_of(const ExportInstance& instance) {
  constexpr double kTruncated = 0.15;
  constexpr double kOccluded = 0.05;
  Flags flags;
  const InstanceLabel& label = *instance.label;
  if (!label.amodal) return flags;
  const double in_box = static_cast<double>(silhouette_area_in(*label.amodal, label.box));
  flags.truncated = in_box < (1.0 - kTruncated) * static_cast<double>(label.amodal->area_px);
  flags.occluded = static_cast<double>(label.area_px) < (1.0 - kOccluded) * in_box;
  return flags;
}

void add_text(pugi::xml_node node, const char* name, const std::string& text) {
  node.append_child(name).text().set(text.c_str());
}
void add_number(pugi::xml_node node, const char* name, int number) {
  node.append_child(name).text().set(number);
}

std::string xml_text(const Dataset& dataset, const ExportFrame& frame) {
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("annotation");
  add_text(root, "folder", "VOC2012");
  add_text(root, "filename", frame.stem + ".jpg");
  add_text(root.append_child("source"), "database", dataset.name);
  pugi::xml_node size = root.append_child("size");
  add_number(size, "width", frame.loaded.labels.width);
  add_number(size, "height", frame.loaded.labels.height);
  add_number(size, "depth", 3);
  add_number(root, "segmented", 1);
  for (const ExportInstance& instance : frame.instances) {
    pugi::xml_node object = root.append_child("object");
    const auto category = static_cast<std::size_t>(instance.label->category) - 1;
    add_text(object, "name", dataset.categories[category]);
    add_text(object, "pose", "Unspecified");
    const Flags flags = flags_of(instance);
    add_number(object, "truncated", flags.truncated ? 1 : 0);
    add_number(object, "occluded", flags.occluded ? 1 : 0);
    add_number(object, "difficult", 0);
    pugi::xml_node box = object.append_child("bndbox");
    add_number(box, "xmin", instance.box().x + 1);
    add_number(box, "ymin", instance.box().y + 1);
    add_number(box, "xmax", instance.box().end_x());
    add_number(box, "ymax", instance.box().end_y());
  }
  std::ostringstream out;
  document.save(out, "  ", pugi::format_indent | pugi::format_no_declaration, pugi::encoding_utf8);
  return out.str();
}

class Voc : public ExportFormat {
 public:
  explicit Voc(const Dataset& dataset)
      : dataset_(dataset), folders_(class_folders(dataset.categories)), palette_(palette()) {}

  FrameParts needs() const override { return {.image_file = dataset_.has_images}; }

  std::vector<DocumentKind> documents() const override {
    std::vector<DocumentKind> lists;
    const auto list = [&](const std::string& name) {
      lists.push_back({.path = in_root("ImageSets/" + name),
                       .scope = DocumentKind::Scope::kSplit,
                       .header = {},
                       .breaks = {},
                       .footer = {},
                       .separator = {}});
    };
    list("Main/{split}.txt");
    list("Segmentation/{split}.txt");
    for (const std::string& folder : folders_) list("Main/" + folder + "_{split}.txt");
    return lists;
  }

  Result<FrameRecord> encode(const ExportFrame& frame) const override {
    if (frame.instances.size() > kMostIndices) {
      return fail(ErrorKind::kInput,
                  "frame {} shows {} objects, and VOC's palette has room for {}: raise "
                  "--min-pixels, or export to another format",
                  frame.frame.index, frame.instances.size(), kMostIndices);
    }
    FrameRecord record;
    record.counts = count_instances(frame);
    record.files.push_back({xml_path(frame), xml_text(dataset_, frame)});
    for (const bool objects : {false, true}) {
      record.files.push_back(
          {png_path(frame, objects), encode_palette_png(indices(frame, objects), palette_)});
    }
    if (dataset_.has_images) {
      record.placed.push_back(image_at(in_root("JPEGImages/" + frame.stem + ".jpg"), frame));
    }
    record.chunks = lists(frame);
    return record;
  }

  Result<CommonPart> common_part(const ExportSummary&) const override {
    std::string map = "background:0,0,0::\n";
    for (std::size_t k = 0; k < dataset_.categories.size(); ++k) {
      const auto [red, green, blue] = voc_color(k + 1);
      map += fmt::format("{}:{},{},{}::\n", dataset_.categories[k], red, green, blue);
    }
    CommonPart common;
    common.files[in_root("labelmap.txt")] = std::move(map);
    return common;
  }

  std::vector<std::string> differences(const ExportFrame& frame,
                                       const WrittenFrame& written) const override {
    std::vector<std::string> found = xml_differences(frame, written.file(xml_path(frame)));
    for (const bool objects : {false, true}) {
      const std::string path = png_path(frame, objects);
      Palette colors;
      const auto png = decode_palette_png(written.file(path), path, colors);
      if (!png) {
        found.push_back(png.error().message);
      } else if (colors != palette_ || png->values != indices(frame, objects).values) {
        found.push_back(path + " is not the frame's");
      }
    }
    const std::vector<Chunk> expected = lists(frame);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (i >= written.chunks.size() || written.chunks[i].text != expected[i].text) {
        found.emplace_back("its line in a list of ImageSets is another");
      }
    }
    return found;
  }

 private:
  static std::string png_path(const ExportFrame& frame, bool objects) {
    return in_root((objects ? "SegmentationObject/" : "SegmentationClass/") + frame.stem + ".png");
  }

  Image<std::uint8_t> indices(const ExportFrame& frame, bool objects) const {
    const FrameLabels& labels = frame.loaded.labels;
    Image<std::uint8_t> image(labels.width, labels.height);
    for (std::size_t i = 0; i < frame.instances.size(); ++i) {
      const ExportInstance& instance = frame.instances[i];
      const auto index = static_cast<std::uint8_t>(
          objects ? i + 1 : static_cast<std::size_t>(instance.label->category));
      const PixelRect& box = instance.box();
      for (int row = box.y; row < box.end_y(); ++row) {
        for (int column = box.x; column < box.end_x(); ++column) {
          if (instance.mask.at(row, column)) image.at(row, column) = index;
        }
      }
    }
    return image;
  }

  /// In the order of documents().
  std::vector<Chunk> lists(const ExportFrame& frame) const {
    std::vector<bool> shows(folders_.size(), false);
    for (const ExportInstance& instance : frame.instances) {
      shows[static_cast<std::size_t>(instance.label->category) - 1] = true;
    }
    std::vector<Chunk> chunks = {{0, 0, frame.stem + "\n"}, {1, 0, frame.stem + "\n"}};
    for (std::size_t k = 0; k < shows.size(); ++k) {
      chunks.push_back(
          {static_cast<int>(k) + 2, 0, fmt::format("{} {:2}\n", frame.stem, shows[k] ? 1 : -1)});
    }
    return chunks;
  }

  std::vector<std::string> xml_differences(const ExportFrame& frame,
                                           const std::string& text) const {
    pugi::xml_document document;
    if (!document.load_string(text.c_str())) return {xml_path(frame) + " is not XML"};
    std::vector<std::string> found;
    pugi::xml_node object = document.child("annotation").child("object");
    for (const ExportInstance& instance : frame.instances) {
      const PixelRect& box = instance.box();
      const pugi::xml_node said = object.child("bndbox");
      const auto category = static_cast<std::size_t>(instance.label->category) - 1;
      const Flags flags = flags_of(instance);
      if (object.child("name").text().get() != dataset_.categories[category] ||
          said.child("xmin").text().as_int() != box.x + 1 ||
          said.child("ymin").text().as_int() != box.y + 1 ||
          said.child("xmax").text().as_int() != box.end_x() ||
          said.child("ymax").text().as_int() != box.end_y() ||
          object.child("truncated").text().as_bool() != flags.truncated ||
          object.child("occluded").text().as_bool() != flags.occluded) {
        found.push_back(instance.label->name + ": its object in the XML is another");
      }
      object = object.next_sibling("object");
    }
    if (object) found.push_back(xml_path(frame) + " has objects too many");
    return found;
  }

  const Dataset& dataset_;
  std::vector<std::string> folders_;
  Palette palette_;
};

}  // namespace

Result<std::unique_ptr<ExportFormat>> make_voc(const Dataset& dataset,
                                               const ExportOptions& options) {
  if (options.amodal) {
    return fail(ErrorKind::kInput,
                "voc gives each pixel to one object, and silhouettes overlap: export it without "
                "--amodal");
  }
  if (dataset.categories.size() > kMostIndices) {
    return fail(ErrorKind::kInput, "VOC's palette has room for {} classes, the campaign has {}",
                kMostIndices, dataset.categories.size());
  }
  for (const std::string& category : dataset.categories) {
    // Readers split its lines at ':' and take what begins with '#' for a comment.
    if (category.find_first_of(":\n\r") == std::string::npos && !category.starts_with('#'))
      continue;
    return fail(ErrorKind::kInput,
                "voc's labelmap.txt cannot name the class '{}': it has a ':' or the end of a line, "
                "or begins with '#'; export to another format",
                category);
  }
  return std::make_unique<Voc>(dataset);
}

}  // namespace seedframe
