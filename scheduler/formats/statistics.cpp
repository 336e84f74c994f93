#include "formats/statistics.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>

namespace seedframe {
namespace {

constexpr std::size_t kSizes = 16;  // below 2, 4, 8, … 65536 px
constexpr std::size_t kTenths = 10;
constexpr std::size_t kGrid = 8;

/// Whole numbers, so that the order in which frames are added does not matter.
struct ClassNumbers {
  std::int64_t instances = 0;
  std::int64_t images = 0;
  std::int64_t pixels = 0;
  std::array<std::int64_t, kSizes> sizes{};
  std::array<std::int64_t, kTenths> visible{};
  std::array<std::int64_t, kTenths> truncation{};
  std::array<std::int64_t, kGrid * kGrid> positions{};
};

struct SplitNumbers {
  std::int64_t images = 0;
  std::int64_t background_images = 0;
  std::vector<std::int64_t> instances_per_image;
  std::vector<ClassNumbers> classes;
  std::vector<std::vector<std::int64_t>> co_occurrence;
};

std::size_t size_bin(std::int64_t pixels) {
  const auto side = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(pixels)));
  return std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(side / 2)), kSizes - 1);
}

std::size_t tenth(double share) {
  return std::min(static_cast<std::size_t>(share * static_cast<double>(kTenths)), kTenths - 1);
}

std::size_t cell(const PixelRect& box, const FrameLabels& frame) {
  const auto along = [](int begin, int length, int side) {
    return static_cast<std::size_t>((2 * std::int64_t{begin} + length) * std::int64_t{kGrid} /
                                    (2 * std::int64_t{side}));
  };
  return std::min(along(box.y, box.height, frame.height), kGrid - 1) * kGrid +
         std::min(along(box.x, box.width, frame.width), kGrid - 1);
}

void add_instance(const ExportInstance& instance, const FrameLabels& frame, ClassNumbers& out) {
  const InstanceLabel& label = *instance.label;
  ++out.instances;
  out.pixels += label.area_px;
  ++out.sizes[size_bin(label.area_px)];
  if (label.amodal) {
    ++out.visible[tenth(label.visible_fraction())];
    ++out.truncation[tenth(label.truncation())];
  }
  ++out.positions[cell(label.box, frame)];
}

Json to_json(const ClassNumbers& numbers) {
  return {{"instances", numbers.instances},
          {"images", numbers.images},
          {"pixels", numbers.pixels},
          {"size_histogram", numbers.sizes},
          {"visible_histogram", numbers.visible},
          {"truncation_histogram", numbers.truncation},
          {"positions", numbers.positions}};
}

Json bins_json() {
  Json sides = Json::array();
  Json tenths = Json::array();
  for (std::size_t i = 1; i <= kSizes; ++i) sides.push_back(std::int64_t{1} << i);
  for (std::size_t i = 1; i <= kTenths; ++i) {
    tenths.push_back(static_cast<double>(i) / static_cast<double>(kTenths));
  }
  return {{"size_below_px", std::move(sides)},
          {"visible_below", tenths},
          {"truncation_below", tenths},
          {"positions", {kGrid, kGrid}}};
}

class Statistics : public ExportFormat {
 public:
  Statistics(const Dataset& dataset, const ExportOptions& options) : dataset_(dataset) {
    const std::size_t classes = dataset.categories.size();
    for (const SplitShare& split : options.splits) {
      SplitNumbers& numbers = splits_[split.name];
      numbers.classes.resize(classes);
      numbers.co_occurrence.assign(classes, std::vector<std::int64_t>(classes, 0));
    }
  }

  bool reusable() const override { return false; }  // a frame's part is not kept

  Result<FrameRecord> encode(const ExportFrame& frame) const override {
    const std::lock_guard lock(mutex_);
    SplitNumbers& split = splits_.at(frame.split);
    const std::size_t instances = frame.instances.size();
    ++split.images;
    split.background_images += instances == 0;
    if (split.instances_per_image.size() <= instances) {
      split.instances_per_image.resize(instances + 1, 0);
    }
    ++split.instances_per_image[instances];
    std::vector<std::int64_t> shown(dataset_.categories.size(), 0);
    for (const ExportInstance& instance : frame.instances) {
      const auto category = static_cast<std::size_t>(instance.label->category) - 1;
      ++shown[category];
      add_instance(instance, frame.loaded.labels, split.classes[category]);
    }
    for (std::size_t a = 0; a < shown.size(); ++a) {
      split.classes[a].images += shown[a] > 0;
      for (std::size_t b = 0; b < shown.size(); ++b) {
        split.co_occurrence[a][b] += shown[a] > (a == b ? 1 : 0) && shown[b] > 0;
      }
    }
    FrameRecord record;
    record.counts = count_instances(frame);
    return record;
  }

  Result<CommonPart> common_part(const ExportSummary&) const override {
    CommonPart common;
    common.files["statistics.json"] = text();
    return common;
  }

  std::vector<std::string> differences(const ExportFrame& frame,
                                       const WrittenFrame&) const override {
    static_cast<void>(encode(frame));  // compared as a whole, by common_part
    return {};
  }

 private:
  std::string text() const {
    Json splits = Json::object();
    for (const auto& [name, numbers] : splits_) {
      Json classes = Json::object();
      for (std::size_t k = 0; k < numbers.classes.size(); ++k) {
        classes[dataset_.categories[k]] = to_json(numbers.classes[k]);
      }
      Json together = Json::object();
      for (std::size_t a = 0; a < numbers.classes.size(); ++a) {
        for (std::size_t b = 0; b < numbers.classes.size(); ++b) {
          together[dataset_.categories[a]][dataset_.categories[b]] = numbers.co_occurrence[a][b];
        }
      }
      splits[name] = {{"images", numbers.images},
                      {"background_images", numbers.background_images},
                      {"instances_per_image", numbers.instances_per_image},
                      {"classes", std::move(classes)},
                      {"co_occurrence", std::move(together)}};
    }
    return readable_json({{"version", 1},
                          {"campaign", dataset_.name},
                          {"bins", bins_json()},
                          {"splits", std::move(splits)}});
  }

  const Dataset& dataset_;
  mutable std::mutex mutex_;
  mutable std::map<std::string, SplitNumbers> splits_;  ///< guarded by the mutex
};

}  // namespace

Result<std::unique_ptr<ExportFormat>> make_statistics(const Dataset& dataset,
                                                      const ExportOptions& options) {
  return std::make_unique<Statistics>(dataset, options);
}

}  // namespace seedframe
