// Campaigns whose files somebody has changed, moved or replaced by something else: what 'resume'
// makes of them.

#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kLabelsOnly = R"(seedframe: 1
scenes: 4
frames_per_scene: 2
categories: [gear]
labels: geometry
render: {width: 32, height: 24}
objects: {gears: {asset: gear, position: [{uniform: [-0.1, 0.1]}, 0, 0]}}
camera: {distance_m: 0.3, elevation_deg: 40}
)";

class HealingTest : public ProgramTest {
 protected:
  void SetUp() override {
    write_config("labels.yaml", kLabelsOnly);
    const Outcome made = run({"submit", "labels.yaml", "-o", "c", "--quiet"});
    ASSERT_EQ(made.exit_code, 0) << made.errors;
    hash_ = dataset_hash();
  }
  std::string dataset_hash() { return status("c").at("dataset_hash").get<std::string>(); }
  fs::path frame(int index) const { return folder_ / fmt::format("c/frames/000/{:06}", index); }

  std::string hash_;
};

TEST_F(HealingTest, AFrameThatIsALinkOrAFileIsMadeAgainAndWhatItLedToIsLeftAlone) {
  fs::rename(frame(1), folder_ / "elsewhere");
  fs::create_directory_symlink(folder_ / "elsewhere", frame(1));
  fs::remove_all(frame(2));
  write("c/frames/000/000002", "a file");
  fs::remove_all(frame(3));
  ASSERT_EQ(::mkfifo(frame(3).c_str(), 0600), 0);
  fs::remove_all(frame(4));
  fs::create_symlink("/nowhere", frame(4));

  const Outcome audited = run({"audit", "c", "--frames", "0"});
  EXPECT_EQ(audited.exit_code, 5);
  EXPECT_THAT(audited.output, HasSubstr("000001 is a link, not the folder of a frame"));
  EXPECT_THAT(audited.output, HasSubstr("000002 is a file, not the folder of a frame"));

  const Outcome resumed = run({"resume", "c"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  for (int i = 1; i <= 4; ++i) {
    EXPECT_EQ(fs::symlink_status(frame(i)).type(), fs::file_type::directory) << i;
  }
  EXPECT_TRUE(fs::exists(folder_ / "elsewhere/labels.json"));
  EXPECT_EQ(dataset_hash(), hash_);
}

TEST_F(HealingTest, ALockThatIsNoFileIsRefusedAndNothingIsMadeThroughIt) {
  const fs::path lock = folder_ / "c/campaign.lock";
  const auto expect_refused = [&] {
    const Outcome resumed = run({"resume", "c"});
    EXPECT_EQ(resumed.exit_code, 2);
    EXPECT_THAT(resumed.errors, HasSubstr("campaign.lock is not a plain file"));
    fs::remove_all(lock);
  };
  fs::remove(lock);
  fs::create_symlink(folder_ / "made_through", lock);
  expect_refused();
  EXPECT_FALSE(fs::exists(folder_ / "made_through"));
  ASSERT_EQ(::mkfifo(lock.c_str(), 0600), 0);
  expect_refused();
  fs::create_directory(lock);
  expect_refused();
  EXPECT_EQ(run({"resume", "c"}).exit_code, 0) << "a lock that is missing is made";
}

TEST_F(HealingTest, VerifyGivesTheStoreTheRowsThatItShouldHave) {
  change_store("c", "DELETE FROM frames WHERE frame IN (2, 7)");
  change_store("c", "UPDATE frames SET frame_id = 'ff' WHERE frame = 5");
  const Outcome resumed = run({"resume", "c", "--verify"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_THAT(resumed.errors, HasSubstr("lost frame 2: it is known again"));
  EXPECT_THAT(resumed.errors, HasSubstr("lost frame 7: it is known again"));
  EXPECT_THAT(resumed.errors, HasSubstr("wrong id for frame 5"));
  EXPECT_THAT(resumed.errors, HasSubstr("3 frames were complete on disk already"));
  EXPECT_EQ(dataset_hash(), hash_);
  EXPECT_EQ(run({"audit", "c", "--frames", "0"}).exit_code, 0);
}

TEST_F(HealingTest, RowsOfFramesThatThereAreNotAreNamed) {
  change_store(
      "c", "INSERT INTO frames (frame, scene, frame_id, state) VALUES (99, 0, 'ff', 'pending')");
  const Outcome resumed = run({"resume", "c", "--verify"});
  EXPECT_EQ(resumed.exit_code, 5);
  EXPECT_THAT(resumed.errors, HasSubstr("it has a frame 99, and the campaign has 8 frames"));
}

TEST_F(HealingTest, OverwriteRemovesACampaignAndNothingElseAndOnlyIfItMay) {
  const auto submit_over = [this](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"submit",  "labels.yaml", "-o",       "c",
                                      "--quiet", "--set",       "scenes=1", "--overwrite"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  const Outcome asked = submit_over({});
  EXPECT_EQ(asked.exit_code, 2) << "nobody answers";
  EXPECT_THAT(asked.errors, HasSubstr("a campaign with 8 finished frames of 8"));
  EXPECT_THAT(asked.errors, HasSubstr("'--overwrite --yes'"));
  write("c/notes.txt", "mine");
  const Outcome strange = submit_over({"--yes"});
  EXPECT_EQ(strange.exit_code, 2);
  EXPECT_THAT(strange.errors, HasSubstr("notes.txt"));
  EXPECT_EQ(dataset_hash(), hash_);
  EXPECT_EQ(run({"report", "c", "-o", "c/notes.txt"}).exit_code, 2) << "it is no page";
  EXPECT_EQ(*read_file(folder_ / "c/notes.txt"), "mine");
  fs::remove(folder_ / "c/notes.txt");
  EXPECT_EQ(run({"report", "c"}).exit_code, 0);
  const Outcome made = submit_over({"--yes"});
  EXPECT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_EQ(status("c").at("done"), 2);
  EXPECT_FALSE(fs::exists(frame(2)));
}

TEST_F(HealingTest, AFolderThatIsMovedWhileItIsRunEndsTheRunAndGoesOnWhereItIs) {
  Outcome moved;
  std::thread running([&] {
    moved = run({"submit", "labels.yaml", "-o", "long", "--quiet", "--set", "scenes=5000"});
  });
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!fs::exists(folder_ / "long/frames/000/000005/manifest.json") &&
         std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  fs::rename(folder_ / "long", folder_ / "moved");
  running.join();
  EXPECT_EQ(moved.exit_code, 4) << moved.errors;
  EXPECT_THAT(moved.errors, HasSubstr("goes on, where the folder is now"));
  EXPECT_FALSE(fs::exists(folder_ / "long"));
  const Outcome resumed = run({"resume", "moved", "--frame", "9999", "--quiet"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
}

}  // namespace
}  // namespace seedframe
