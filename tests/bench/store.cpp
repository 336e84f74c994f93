// Makes a campaign look finished without rendering it, and times what a scheduler asks of a large
// store; used by store.py, beside it.
//
//   bench_store fill DIR         every frame done, with a folder of small files
//   bench_store fill-rows DIR    every frame done, in the store only
//   bench_store claims DIR N     the times of N claims, seconds, as JSON
#include <algorithm>
#include <chrono>
#include <cstdio>

#include <fmt/format.h>

#include "base/files.h"
#include "base/sha256.h"
#include "campaign/campaign.h"
#include "frames/frame_fingerprint.h"
#include "render/schedule.h"

namespace seedframe {
namespace {

constexpr const char* kContent = "as small as a file can be\n";

/// What a frame of many passes has, each with a few bytes.
Manifest small_manifest(const std::string& frame_id) {
  Manifest manifest;
  manifest.frame_id = frame_id;
  for (const char* name :
       {frame_files::kSpec, frame_files::kPasses, "image.png", frame_files::kInstances,
        frame_files::kSemantic, frame_files::kDepth, frame_files::kNormal, frame_files::kLabels}) {
    manifest.files[name] = {std::char_traits<char>::length(kContent), sha256_hex(kContent)};
  }
  manifest.pixel_hashes["index"] = sha256_hex(frame_id);
  return manifest;
}

Result<std::string> write_frame(const std::filesystem::path& folder, const Manifest& manifest) {
  if (Status made = make_folders(folder); !made) return forward_error(made);
  for (const auto& [name, file] : manifest.files) {
    if (Status done = write_file_unsynced(folder / name, kContent); !done) {
      return forward_error(done);
    }
  }
  const std::string text = readable_json(to_json(manifest));
  if (Status done = write_file_unsynced(folder / frame_files::kManifest, text); !done) {
    return forward_error(done);
  }
  return frame_fingerprint(folder);
}

Status fill(Campaign& campaign, bool folders) {
  std::vector<FrameRow> rows;
  Status visited = campaign.store.for_each_frame([&](const FrameRow& row) -> Status {
    rows.push_back(row);
    return {};
  });
  if (!visited) return visited;
  return campaign.store.write_together(JobStore::Sync::kNow, [&]() -> Status {
    for (const FrameRow& row : rows) {
      const Manifest manifest = small_manifest(row.frame_id);
      FrameResult result = {manifest.pixel_hash(), {}, {}};
      if (folders) {
        const auto fingerprint = write_frame(campaign.files.frame(row.frame), manifest);
        if (!fingerprint) return forward_error(fingerprint);
        result.fingerprint = *fingerprint;
      }
      if (Status done = campaign.store.adopt(row.frame, result); !done) return done;
    }
    return {};
  });
}

/// A claim: which frame next, and that its attempt has begun, for everybody to see.
Status time_claims(Campaign& campaign, int claims) {
  std::vector<PendingFrame> pending;
  Status visited = campaign.store.for_each_frame([&](const FrameRow& row) -> Status {
    pending.push_back({row.frame, row.attempts});
    return {};
  });
  if (!visited) return visited;
  Schedule schedule(pending, {});
  std::vector<double> seconds;
  for (int i = 0; i < claims; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const auto job = schedule.next(false);
    if (!job) break;
    Status done = campaign.store.write_together(JobStore::Sync::kLater, [&] {
      return campaign.store.attempt_started(job->frame, job->attempt, 0, 1.0);
    });
    if (!done) return done;
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    schedule.rendered(*job);
    schedule.committed(*job);
  }
  std::sort(seconds.begin(), seconds.end());
  fmt::print("{{\"claims\": {}, \"median_s\": {}, \"p99_s\": {}, \"longest_s\": {}}}\n",
             seconds.size(), seconds[seconds.size() / 2], seconds[seconds.size() * 99 / 100],
             seconds.back());
  return {};
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 3) {
    std::fprintf(stderr, "bench_store: fill DIR, fill-rows DIR or claims DIR N\n");
    return 2;
  }
  auto campaign = open_campaign(arguments[2]);
  Status done = campaign ? begin_run(*campaign) : Status(forward_error(campaign));
  if (done && arguments[1] == "claims") {
    done = time_claims(*campaign, std::stoi(arguments.at(3)));
  } else if (done) {
    done = fill(*campaign, arguments[1] == "fill");
  }
  if (!done) std::fprintf(stderr, "bench_store: %s\n", done.error().message.c_str());
  return done ? 0 : 1;
}

}  // namespace
}  // namespace seedframe

int main(int count, char** arguments) { return seedframe::run({arguments, arguments + count}); }
