#include "slurm/submission.h"

#include <atomic>
#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "campaign/run_options.h"
#include "slurm/task_frame.h"
#include "tests/fixtures/scratch_folder.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class SubmissionTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(files_.claims()); }

  const ScratchFolder scratch_;
  SubmissionFiles files_{scratch_.path()};
};

Submission example() {
  Submission submission;
  submission.token = "abc";
  submission.batches = {{0, 1}, {7}};
  submission.crashes = {{7, 2}};
  submission.source = {"seedframe: 1\n", "/there/x.yaml", {{"seed", "4", {}}}, "/home"};
  submission.source.allowed.add("/there");
  submission.choices =
      std::make_shared<RenderChoices>(RenderChoices{{7, RenderChoice{16, {}, Denoise::kOff}}});
  submission.node_folder = "/scratch";
  RunOptions run;
  run.blender = "/opt/blender";
  run.pool.workers = 3;
  run.sandbox = true;
  run.worker.environment = {{"TZ", "UTC"}};
  submission.run = options_for_tasks(run);
  return submission;
}

TEST_F(SubmissionTest, IsReadAsItWasWritten) {
  const Submission submission = example();
  ASSERT_TRUE(write_file(files_.submission(), canonical_json(to_json(submission))));
  const auto read = read_submission(files_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(to_json(*read), to_json(submission));
  const auto options = options_of_tasks(read->run, "test");
  ASSERT_TRUE(options);
  EXPECT_EQ(options->blender, "/opt/blender");
  EXPECT_EQ(options->pool.workers, 3);
  EXPECT_TRUE(options->sandbox);
  EXPECT_EQ(options->worker.environment.at("TZ"), "UTC");
}

TEST_F(SubmissionTest, OfAnotherVersionIsRefused) {
  Json json = to_json(example());
  json["seedframe"] = "0.0.1";
  ASSERT_TRUE(write_file(files_.submission(), canonical_json(json)));
  EXPECT_THAT(read_submission(files_).error().message, HasSubstr("written by Seedframe 0.0.1"));
  for (const char* damage : {"", "{}", "[1]", "{\"seedframe\": 3}"}) {
    ASSERT_TRUE(write_file(files_.submission(), damage));
    EXPECT_FALSE(read_submission(files_)) << damage;
  }
}

TEST_F(SubmissionTest, ABatchIsTakenOnce) {
  constexpr int kRounds = 50;
  for (int batch = 0; batch < kRounds; ++batch) {
    std::atomic<int> winners = 0;
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&, i] {
        const auto outcome = claim_batch(files_, batch, {"n" + std::to_string(i), "1_0"});
        ASSERT_TRUE(outcome);
        if (*outcome == ClaimOutcome::kOurs) ++winners;
      });
    }
    threads.clear();
    EXPECT_EQ(winners, 1);
    EXPECT_TRUE(read_claim(files_, batch)->node.starts_with("n"));
  }
  EXPECT_FALSE(read_claim(files_, kRounds));
}

TEST_F(SubmissionTest, WhoWasKilledWhileTakingABatchHasTakenIt) {
  ASSERT_TRUE(write_file(files_.claim(3), ""));
  ASSERT_TRUE(read_claim(files_, 3));
  EXPECT_EQ(read_claim(files_, 3)->node, "");
  EXPECT_EQ(*claim_batch(files_, 3, {"n1", "1_3"}), ClaimOutcome::kTaken);
}

TEST_F(SubmissionTest, WhatComesIntoAClosedBatchIsLost) {
  fs::create_directory(files_.results(2));
  ASSERT_TRUE(write_file(files_.results(2) / "000001.json", "{}"));
  EXPECT_FALSE(is_closed(files_, 2));
  ASSERT_TRUE(close_batch(files_, 2));
  EXPECT_TRUE(is_closed(files_, 2));
  EXPECT_TRUE(fs::exists(files_.closed_results(2) / "000001.json"));
  EXPECT_FALSE(write_file_atomically(files_.results(2) / "000002.json", "{}"));
  ASSERT_TRUE(close_batch(files_, 5)) << "of which nothing came";
  EXPECT_TRUE(is_closed(files_, 5));
}

TaskFrame record() {
  TaskFrame record;
  record.frame = 42;
  record.frame_id = "id";
  record.state = FrameState::kQuarantined;
  record.attempts = {{42, 1, 3, AttemptOutcome::kCrash, 12.5, 0, 0, 0, "died", "{}"},
                     {42, 2, 4, AttemptOutcome::kError, 13.5, 0.1, 0.2, 0.3, "again", ""}};
  record.workers = 2;
  record.startup_s = 1.5;
  record.node = "n7";
  return record;
}

TEST(TaskFrame, IsReadAsItWasWritten) {
  const auto read = task_frame_from_json(to_json(record()), "test");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(to_json(*read), to_json(record()));
  EXPECT_EQ(read->attempts.back().render_s, 0.2);
}

TEST(TaskFrame, GarbageIsRefused) {
  EXPECT_FALSE(task_frame_from_json(Json(), "test"));
  for (const char* key : {"frame", "frame_id", "state", "attempts", "workers", "node"}) {
    Json json = to_json(record());
    json.erase(key);
    EXPECT_FALSE(task_frame_from_json(json, "test")) << key;
    json[key] = Json::array();
    EXPECT_FALSE(task_frame_from_json(json, "test")) << key;
  }
  Json running = to_json(record());
  running["state"] = "running";
  EXPECT_FALSE(task_frame_from_json(running, "test"));
}

TEST(TaskEnd, IsReadAsItWasWritten) {
  const TaskEnd end{true, {ErrorKind::kEnvironment, "no Blender"}};
  const TaskEnd read = task_end_from_json(to_json(end));
  EXPECT_TRUE(read.stopped);
  EXPECT_EQ(read.error.message, "no Blender");
  EXPECT_EQ(read.error.kind, ErrorKind::kEnvironment);
  EXPECT_EQ(task_end_from_json(Json()).error.message, "");
}

}  // namespace
}  // namespace seedframe
