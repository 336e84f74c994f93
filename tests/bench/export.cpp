// Measures the exporters on synthetic frames and prints JSON; tests/bench/export.py runs it.
//
//   bench_export rle FILE        the time of one instance's run lengths; its mask goes to FILE
//   bench_export encode          COCO's entries of frames in memory, a core
//   bench_export stream FOLDER FRAMES FORMAT…   a whole export from disk, and the memory it took
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <sys/resource.h>

#include "annotate/extents.h"
#include "annotate/rle.h"
#include "base/files.h"
#include "base/sha256.h"
#include "export/export_run.h"
#include "formats/formats.h"
#include "frames/campaign_files.h"
#include "image/png_file.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using IdImage = Image<std::uint16_t>;

/// Ten discs with a wavy edge and a hole each, some over others: what parts on a bench look like.
IdImage ten_instances(int width, int height, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  IdImage ids(width, height);
  for (int id = 1; id <= 10; ++id) {
    const double x = static_cast<double>(random() % static_cast<std::uint64_t>(width));
    const double y = static_cast<double>(random() % static_cast<std::uint64_t>(height));
    const double radius = height * (0.06 + static_cast<double>(random() % 100) / 1000.0);
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        const double angle = std::atan2(row - y, column - x);
        const double distance = std::hypot(row - y, column - x);
        const double edge = radius * (1.0 + 0.1 * std::sin(9.0 * angle));
        if (distance < edge && distance > 0.3 * radius) {
          ids.at(row, column) = static_cast<std::uint16_t>(id);
        }
      }
    }
  }
  return ids;
}

FrameLabels labels_of(const IdImage& ids, const std::vector<std::string>& categories) {
  FrameSpec spec;
  spec.render.width = ids.width;
  spec.render.height = ids.height;
  for (int id = 1; id <= 10; ++id) {
    InstanceSpec& instance = spec.instances.emplace_back();
    instance.name = "part/" + std::to_string(id);
    instance.asset = "part";
    instance.id = id;
    instance.category = 1 + id % 3;
  }
  FrameLabels labels = *make_labels(spec, categories, ids);
  for (InstanceLabel& label : labels.instances) {
    AmodalLabel& amodal = label.amodal.emplace();
    if (label.area_px == 0) continue;
    amodal.box = {label.box.x, label.box.y, label.box.width, label.box.height};
    amodal.area_px = amodal.in_image_px = label.area_px;
    IdImage crop(label.box.width, label.box.height);
    std::vector<std::uint8_t> mask;
    for (int row = 0; row < label.box.height; ++row) {
      for (int column = 0; column < label.box.width; ++column) {
        mask.push_back(ids.at(label.box.y + row, label.box.x + column) == label.id);
      }
    }
    amodal.rle = rle_string(encode_rle(mask, label.box.width, label.box.height));
  }
  return labels;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Mean seconds of `body`, run for about a second.
template <class Body>
double mean_seconds(Body body) {
  body();
  const auto start = std::chrono::steady_clock::now();
  int runs = 0;
  while (seconds_since(start) < 1.0) {
    body();
    ++runs;
  }
  return seconds_since(start) / runs;
}

Dataset dataset_of(std::vector<std::string> categories) {
  Dataset dataset;
  dataset.name = "synthetic";
  dataset.categories = std::move(categories);
  dataset.keypoints.resize(dataset.categories.size());
  return dataset;
}

const std::vector<std::string> kCategories = {"bolt", "nut", "gear"};

int measure_rle(const fs::path& out) {
  constexpr int kWidth = 1280;
  constexpr int kHeight = 720;
  const IdImage ids = ten_instances(kWidth, kHeight, 3);
  const InstanceExtent extent = measure_extents(ids).front();
  const Mask mask(ids, extent.id, extent.box);
  std::string text;
  const double seconds = mean_seconds([&] { text = rle_string(encode_rle(mask)); });
  std::ofstream file(out, std::ios::binary);  // row by row, 0 or 1
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      file.put(static_cast<char>(mask.at(row, column)));
    }
  }
  std::printf("%s\n", Json({{"width", kWidth},
                            {"height", kHeight},
                            {"area_px", extent.area_px},
                            {"seconds", seconds},
                            {"counts", text}})
                          .dump()
                          .c_str());
  return 0;
}

int measure_encoding() {
  const Dataset dataset = dataset_of(kCategories);
  const ExportOptions options;
  const auto coco = (*find_format(export_formats(), "coco"))->make(dataset, options);
  std::vector<std::unique_ptr<ExportFrame>> frames;
  std::vector<std::string> pngs;
  std::vector<std::string> texts;
  for (int i = 0; i < 50; ++i) {
    IdImage ids = ten_instances(640, 480, static_cast<std::uint64_t>(i));
    LoadedFrame loaded{labels_of(ids, kCategories), ids, {}, {}};
    pngs.push_back(encode_png(ids));
    texts.push_back(readable_json(to_json(loaded.labels)));
    frames.push_back(
        *select_instances({i, i, {}, std::string(64, 'a')}, std::move(loaded), "train", options));
  }
  std::size_t bytes = 0;
  const auto each = [&](auto body) {
    return mean_seconds([&] {
             for (std::size_t i = 0; i < frames.size(); ++i) body(i);
           }) /
           static_cast<double>(frames.size());
  };
  const double encode = each([&](std::size_t i) {
    const auto record = (*coco)->encode(*frames[i]);
    for (const Chunk& chunk : record->chunks) bytes += chunk.text.size();
  });
  const double extents =
      each([&](std::size_t i) { bytes += measure_extents(frames[i]->loaded.instance_ids).size(); });
  const double png =
      each([&](std::size_t i) { bytes += decode_png16(pngs[i], "")->values.size(); });
  const double json = each([&](std::size_t i) {
    bytes += labels_from_json(*parse_json(texts[i], ""), "")->instances.size();
  });
  const double hash = each(
      [&](std::size_t i) { bytes += sha256_hex(pngs[i]).size() + sha256_hex(texts[i]).size(); });
  std::printf("%s\n", Json({{"encode_s", encode},
                            {"extents_s", extents},
                            {"decode_png_s", png},
                            {"read_labels_s", json},
                            {"hash_s", hash},
                            {"bytes", bytes > 0}})
                          .dump()
                          .c_str());
  return 0;
}

/// A few frames on disk, which the dataset names again and again under other numbers.
class RepeatedFrames {
 public:
  explicit RepeatedFrames(const fs::path& folder) {
    const CampaignFiles files(folder);
    for (int i = 0; i < 100; ++i) {
      const IdImage ids = ten_instances(640, 480, static_cast<std::uint64_t>(i));
      const CommittedFrame frame{i, i, files.frame(i), fmt::format("{:064}", i)};
      if (!make_folders(frame.folder)) std::exit(1);
      Manifest manifest;
      manifest.frame_id = frame.frame_id;
      const auto write = [&](const char* name, const std::string& bytes) {
        if (!write_file_unsynced(frame.folder / name, bytes)) std::exit(1);
        manifest.files[name] = {bytes.size(), sha256_hex(bytes)};
      };
      write(frame_files::kInstances, encode_png(ids));
      write(frame_files::kLabels, readable_json(to_json(labels_of(ids, kCategories))));
      const std::string text = readable_json(to_json(manifest));
      if (!write_file_unsynced(frame.folder / frame_files::kManifest, text)) std::exit(1);
      frames_.push_back(frame);
    }
  }

  FrameCursor cursor(std::int64_t count) const {
    return
        [this, count, next = std::int64_t{0}]() mutable -> Result<std::optional<CommittedFrame>> {
          if (next == count) return std::nullopt;
          CommittedFrame frame = frames_[static_cast<std::size_t>(next) % frames_.size()];
          frame.index = next;
          frame.scene = static_cast<int>(next / 10);
          ++next;
          return frame;
        };
  }

 private:
  std::vector<CommittedFrame> frames_;
};

int measure_stream(const fs::path& folder, std::int64_t count,
                   const std::vector<std::string>& names) {
  const RepeatedFrames frames(folder / "campaign");
  Dataset dataset = dataset_of(kCategories);
  dataset.has_images = false;
  dataset.frames = [&] { return frames.cursor(count); };
  std::vector<const FormatEntry*> formats;
  for (const std::string& name : names) formats.push_back(*find_format(export_formats(), name));
  ExportOptions options;
  options.output = folder / "out";
  options.splits = {{"train", 0.8}, {"val", 0.2}};
  Json runs = Json::array();
  for (int run = 0; run < 2; ++run) {  // the second takes over what the first has written
    const auto start = std::chrono::steady_clock::now();
    const auto outcome = run_export(dataset, formats, options);
    const double seconds = seconds_since(start);
    if (!outcome) {
      std::fprintf(stderr, "%s\n", outcome.error().message.c_str());
      return 1;
    }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    runs.push_back({{"seconds", seconds},
                    {"frames", outcome->written.front().frames},
                    {"reused", outcome->written.front().reused},
                    {"peak_kib", usage.ru_maxrss}});
  }
  std::printf("%s\n", runs.dump().c_str());
  return 0;
}

}  // namespace
}  // namespace seedframe

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 2 && words[0] == "rle") return seedframe::measure_rle(words[1]);
  if (words.size() == 1 && words[0] == "encode") return seedframe::measure_encoding();
  if (words.size() > 3 && words[0] == "stream") {
    return seedframe::measure_stream(words[1], std::stoll(words[2]),
                                     {words.begin() + 3, words.end()});
  }
  std::fprintf(stderr, "usage: bench_export rle FILE | encode | stream FOLDER FRAMES FORMAT…\n");
  return 2;
}
