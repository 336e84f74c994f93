// A small campaign on disk whose labels come from geometry: nothing but files is needed to run it.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/files.h"
#include "campaign/campaign.h"
#include "campaign/campaign_run.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {

/// Notes what it is told.
class NotingObserver : public RunObserver {
 public:
  void frame_done(std::int64_t frame) override { done.push_back(frame); }
  void attempt_failed(const FrameJob& job, const AttemptFailure& failure) override {
    failed.push_back(job);
    messages.push_back(failure.message);
  }
  void noted(const std::string& text) override { notes.push_back(text); }
  void paused(const Error& why, double) override { pauses.push_back(why.message); }
  void goes_on(std::int64_t) override { ++ends_of_pauses; }

  std::vector<std::int64_t> done;
  std::vector<FrameJob> failed;
  std::vector<std::string> messages;
  std::vector<std::string> notes;
  std::vector<std::string> pauses;
  int ends_of_pauses = 0;
};

class CampaignFixture : public ::testing::Test {
 protected:
  static constexpr std::int64_t kFrames = 12;
  static constexpr const char* kConfig = R"(seedframe: 1
name: small
scenes: 4
frames_per_scene: 3
categories: [gear]
render: {width: 32, height: 24, samples: 1}
objects:
  gears: {asset: gear, count: {integer: [1, 3]}, position: [{uniform: [-0.1, 0.1]}, 0, 0]}
camera: {distance_m: {uniform: [0.2, 0.5]}}
labels: geometry
)";

  void SetUp() override {
    ASSERT_TRUE(write_file(scratch_ / "small.yaml", kConfig));
    auto source = read_source(scratch_ / "small.yaml", {}, SEEDFRAME_HOME);
    ASSERT_TRUE(source) << source.error().message;
    auto prepared = prepare(std::move(*source));
    ASSERT_TRUE(prepared) << prepared.error().message;
    prepared_ = std::make_unique<PreparedCampaign>(std::move(*prepared));
    auto created = create_campaign(scratch_ / "campaign", *prepared_);
    ASSERT_TRUE(created) << created.error().message;
    locked_ = std::make_unique<LockedCampaign>(std::move(*created));
    ASSERT_TRUE(begin_run(campaign()));
  }
  Campaign& campaign() { return locked_->campaign; }
  static std::vector<PendingFrame> all_frames() {
    std::vector<PendingFrame> frames;
    for (std::int64_t frame = 0; frame < kFrames; ++frame) frames.push_back({frame});
    return frames;
  }
  FrameCounts counts() { return *campaign().store.counts(); }

  ScratchFolder scratch_;
  std::unique_ptr<PreparedCampaign> prepared_;
  std::unique_ptr<LockedCampaign> locked_;
  NotingObserver observer_;
};

}  // namespace seedframe
