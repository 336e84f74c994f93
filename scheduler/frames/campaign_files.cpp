#include "frames/campaign_files.h"

#include <fmt/format.h>

namespace seedframe {
namespace fs = std::filesystem;

std::string frame_files::image(ImageFormat format) {
  return std::string("image") + ending_of(format);
}

std::string frame_stem(std::int64_t frame) { return fmt::format("{:06}", frame); }

fs::path CampaignFiles::worker_log(int worker) const {
  return logs() / fmt::format("worker-{:02}.log", worker);
}

fs::path CampaignFiles::crash_log(std::int64_t frame, int attempt) const {
  return logs() / fmt::format("crash-{}-{}.log", frame_stem(frame), attempt);
}

fs::path CampaignFiles::attempt(std::int64_t frame, int attempt) const {
  return work() / "attempts" / attempt_name(frame, attempt);
}

std::string CampaignFiles::attempt_name(std::int64_t frame, int attempt) {
  return fmt::format("{}-{}", frame_stem(frame), attempt);
}

fs::path CampaignFiles::rejected(std::int64_t frame) const {
  return root() / "rejected" / frame_stem(frame);
}

std::vector<std::filesystem::path> CampaignFiles::own() const {
  std::vector<std::filesystem::path> all;
  for (const char* name : {"campaign.sqlite",
                           "campaign.sqlite-wal",
                           "campaign.sqlite-shm",
                           "campaign.sqlite-journal",
                           "campaign.sqlite.new",
                           "campaign.yaml",
                           "campaign.lock",
                           "graphs.jsonl",
                           "provenance.json",
                           "inputs",
                           "frames",
                           "rejected",
                           "audit",
                           "exports",
                           "report.html",
                           "report_files",
                           "logs",
                           "work",
                           "slurm",
                           "nodes.json"}) {
    all.push_back(root_ / name);
  }
  return all;
}

fs::path CampaignFiles::frame(std::int64_t frame) const {
  return frames() / fmt::format("{:03}", frame / 1000) / frame_stem(frame);
}

}  // namespace seedframe
