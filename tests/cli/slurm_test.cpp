// Campaigns by a Slurm whose commands misbehave on request; tests/slurm/ has a real one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kConfig = R"(seedframe: 1
name: line
seed: 4
scenes: 9
categories: [gear, hex_bolt]
render: {width: 24, height: 16, samples: 1}
labels: geometry
objects: {gears: {asset: gear, scatter: {x: [-0.1, 0.1], y: [-0.1, 0.1]}, rest_on_ground: true}}
camera: {position: [0, -0.4, 0.3], target: [0, 0, 0], fov_deg: 50}
)";

class SlurmTest : public ProgramTest {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "bin");
    fs::create_directories(folder_ / "cluster");
    for (const char* name : {"sbatch", "squeue", "scancel", "sinfo", "scontrol"}) {
      fs::create_symlink(SEEDFRAME_HOME "/tests/fake_slurm/fake_slurm.py", folder_ / "bin" / name);
    }
    write("line.yaml", kConfig);
  }

  std::vector<std::string> environment(const std::string& wish) const {
    return {"PATH=" + (folder_ / "bin").string() + ":/usr/bin:/bin",
            "FAKE_SLURM=" + (folder_ / "cluster").string(), "FAKE_SLURM_DO=" + wish,
            "TMPDIR=" + folder_.string()};
  }

  Outcome by_slurm(const std::string& wish, std::vector<std::string> more = {},
                   const std::string& config = "line.yaml") {
    std::vector<std::string> arguments = {"submit",     config,  "-o",     "far",
                                          "--executor", "slurm", "--poll", "0.1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    lines_ = environment(wish);
    return run(arguments, lines_);
  }

  /// A head whose tasks never begin by themselves.
  pid_t start_held(const std::string& batch_frames) {
    lines_ = environment(R"({"hold": true})");
    return start({"submit", "line.yaml", "-o", "far", "--executor", "slurm", "--poll", "0.1",
                  "--batch-frames", batch_frames},
                 lines_);
  }

  std::string hash_of(const std::string& campaign) {
    return status(campaign)["dataset_hash"].get<std::string>();
  }

  /// Of the same config on this machine.
  std::string local_hash() {
    if (!exists("near")) {
      const Outcome outcome = run({"submit", "line.yaml", "-o", "near", "--quiet"});
      EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    }
    return hash_of("near");
  }

  /// Until a file is there.
  void wait_for(const std::string& name) const {
    for (int i = 0; i < 6000 && !exists(name); ++i) ::usleep(5'000);
    ASSERT_TRUE(exists(name)) << *read_file(folder_ / "err.txt");
  }

  std::size_t jobs() const {
    std::ifstream file(folder_ / "cluster/jobs.jsonl");
    std::size_t count = 0;
    for (std::string line; std::getline(file, line);) ++count;
    return count;
  }

  std::string calls() const { return *read_file(folder_ / "cluster/log"); }

  std::vector<std::string> lines_;  // outlive the program, which has only their addresses
};

TEST_F(SlurmTest, MakesTheSameDataset) {
  const Outcome outcome = by_slurm("{}");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(hash_of("far"), local_hash());
  EXPECT_FALSE(exists("far/slurm")) << "nothing was lost";
  EXPECT_EQ(contents("far/frames"), contents("near/frames"));
  EXPECT_THAT(calls(), HasSubstr("--no-requeue"));
  EXPECT_THAT(calls(), HasSubstr("--signal=B:TERM@120"));
}

TEST_F(SlurmTest, HandsOnWhatIsAskedOfTheCluster) {
  const Outcome outcome = by_slurm(
      "{}", {"--partition", "long", "--nodes", "2", "--time", "1:30:00", "--cpus-per-task", "4",
             "--batch-frames", "4", "--slurm-option=--account=lab", "--slurm-option=--mem=4G"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  for (const char* part :
       {"--partition=long", "--array=0-2%2", "--time=1:30:00", "--cpus-per-task=4", "--account=lab",
        "--mem=4G", "--comment=seedframe "}) {
    EXPECT_THAT(calls(), HasSubstr(part));
  }
}

TEST_F(SlurmTest, TasksThatAreStartedTwiceMakeNothingTwice) {
  const Outcome outcome = by_slurm(R"({"twice": true})", {"--batch-frames", "2"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(hash_of("far"), local_hash());
}

TEST_F(SlurmTest, FailingSubmissionsAreTriedAgain) {
  const Outcome outcome =
      by_slurm(R"({"sbatch": ["fail", "fail", "ok"]})", {"--batch-frames", "3"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(jobs(), 1U);
  EXPECT_EQ(hash_of("far"), local_hash());
}

TEST_F(SlurmTest, ALostAnswerIsFoundAgainAndSubmitsNothingTwice) {
  const Outcome outcome = by_slurm(R"({"sbatch": ["lose"]})", {"--batch-frames", "3"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(jobs(), 1U);
  EXPECT_EQ(hash_of("far"), local_hash());
}

TEST_F(SlurmTest, AQueueThatGivesNoAnswerIsAskedAgain) {
  const Outcome outcome = by_slurm(R"({"squeue": ["fail", "fail", "ok", "fail", "ok"]})");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(hash_of("far"), local_hash());
}

TEST_F(SlurmTest, ARefusalIsToldAndEndsTheRun) {
  const Outcome outcome = by_slurm(R"({"sbatch": ["refuse"]})", {"--partition", "nowhere"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("invalid partition specified: nowhere"));
  const Outcome again = run({"resume", "far", "--partition", "main"}, environment("{}"));
  EXPECT_EQ(again.exit_code, 0) << again.errors;  // by Slurm: that is remembered
  EXPECT_EQ(hash_of("far"), local_hash());
  EXPECT_THAT(calls(), HasSubstr("--partition=main"));
}

TEST_F(SlurmTest, WhatLeavesTheQueueWithoutHavingBegunIsSubmittedAgain) {
  const Outcome outcome = by_slurm(R"({"vanish": [0, 2]})", {"--batch-frames", "3"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(hash_of("far"), local_hash());
  EXPECT_EQ(jobs(), 2U);
}

TEST_F(SlurmTest, ANodeThatMakesNothingIsLeftOut) {
  const Outcome outcome = by_slurm(R"({"bad_nodes": ["n1"]})", {"--batch-frames", "1"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(hash_of("far"), local_hash());
  EXPECT_THAT(outcome.errors, HasSubstr("node n1 is left out from now on"));
  EXPECT_THAT(calls(), HasSubstr("--exclude=n1"));
}

TEST_F(SlurmTest, WhereNoTaskBeginsTheRunEndsWithWhatTheyPrint) {
  const Outcome outcome = by_slurm(R"({"bad_nodes": ["n1", "n2", "n3"]})");
  EXPECT_EQ(outcome.exit_code, 4) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("tasks end without having made anything"));
  EXPECT_THAT(outcome.errors, HasSubstr("/nowhere/seedframe"));
}

TEST_F(SlurmTest, WithoutSlurmThatIsSaid) {
  lines_ = environment("{}");
  lines_.front() = "PATH=/nowhere";
  const Outcome outcome = run({"submit", "line.yaml", "-o", "far", "--executor", "slurm"}, lines_);
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.errors, HasSubstr("there is no program 'scontrol' in PATH"));
}

TEST_F(SlurmTest, ItsOptionsNeedIt) {
  const Outcome outcome = run({"submit", "line.yaml", "-o", "far", "--partition", "main"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("give --executor slurm, too"));
  const Outcome time = by_slurm("{}", {"--time", "soon"});
  EXPECT_EQ(time.exit_code, 2);
  EXPECT_THAT(time.errors, HasSubstr("'soon' is not a time"));
}

TEST_F(SlurmTest, ArraysAreSplitAtWhatTheControllerTakes) {
  const Outcome outcome = by_slurm(R"({"max_array_size": 4})", {"--batch-frames", "1"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(calls(), HasSubstr("--array=0-3"));
  EXPECT_THAT(calls(), Not(HasSubstr("--array=0-4")));
  EXPECT_EQ(jobs(), 3U);
  EXPECT_EQ(hash_of("far"), local_hash());
}

TEST_F(SlurmTest, NoMoreIsSubmittedAtOnceThanTheControllerKeeps) {
  const Outcome outcome = by_slurm(R"({"max_job_count": 4})", {"--batch-frames", "1"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_THAT(calls(), Not(HasSubstr("--array=0-2")));
  EXPECT_EQ(hash_of("far"), local_hash());
}

TEST_F(SlurmTest, AKilledHeadIsFollowedByOneThatCollects) {
  const pid_t head = start_held("3");
  wait_for("far/slurm/state.json");
  ::kill(head, SIGKILL);
  wait(head);
  // The tasks run while there is no head.
  for (int index = 0; index < 3; ++index) {
    const Outcome task =
        run({"run-batch", (folder_ / "far/slurm/0001").string(), std::to_string(index)},
            {"SLURM_ARRAY_JOB_ID=1", "SLURMD_NODENAME=n1"});
    EXPECT_EQ(task.exit_code, 0) << task.errors;
    fs::remove(folder_ / "cluster" / ("1_" + std::to_string(index) + ".queued"));
  }
  const Json between = status("far");
  EXPECT_EQ(between["done"], 0);
  EXPECT_EQ(between["cluster"]["jobs"], Json::array({1}));
  const Outcome resumed = run({"resume", "far", "--quiet"}, environment("{}"));
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_EQ(jobs(), 1U) << "nothing was left to submit";
  EXPECT_EQ(hash_of("far"), local_hash());
}

TEST_F(SlurmTest, ATaskThatBeginsAfterItsBatchWasGivenUpDoesNothing) {
  const pid_t head = start_held("9");
  wait_for("far/slurm/0001/job");
  ::kill(head, SIGKILL);
  wait(head);
  write("far/slurm/0001/claims/0", R"({"by_head": true})");
  const Outcome late = run({"run-batch", (folder_ / "far/slurm/0001").string(), "0"});
  EXPECT_EQ(late.exit_code, 0);
  EXPECT_THAT(late.output, HasSubstr("batch 0 is not for us: the head has taken it"));
  EXPECT_FALSE(exists("far/slurm/0001/0"));
}

TEST_F(SlurmTest, OfABatchOnlyOneTaskMakesFrames) {
  const pid_t head = start_held("9");
  wait_for("far/slurm/0001/job");
  ::kill(head, SIGKILL);
  wait(head);
  const std::string submission = (folder_ / "far/slurm/0001").string();
  const std::vector<std::string> task = {"SLURM_ARRAY_JOB_ID=1", "SLURMD_NODENAME=n2"};
  EXPECT_THAT(run({"run-batch", submission, "0"}, task).output, HasSubstr("batch 0 is over"));
  const auto made = contents("far/slurm/0001");
  EXPECT_THAT(run({"run-batch", submission, "0"}, task).output,
              HasSubstr("batch 0 is not for us: n2 has taken it"));
  EXPECT_EQ(contents("far/slurm/0001"), made);
  EXPECT_EQ(run({"run-batch", submission, "1"}, task).exit_code, 2) << "there is none";
}

TEST_F(SlurmTest, ANodeWithOtherFilesIsFoundOut) {
  make_part("gear");
  std::string config = kConfig;
  config.replace(config.find("asset: gear"), 11, "asset: part");
  config += "asset_folders: [own]\n";
  write("line.yaml", config);
  const pid_t head = start_held("9");
  wait_for("far/slurm/0001/job");
  make_part("hex_bolt");  // what this node sees under the name
  write("cluster/1_0.queued", "n1");
  const Outcome task = run({"run-batch", (folder_ / "far/slurm/0001").string(), "0"},
                           {"SLURM_ARRAY_JOB_ID=1", "SLURMD_NODENAME=n1"});
  EXPECT_EQ(task.exit_code, 0) << task.errors;
  make_part("gear");
  fs::remove(folder_ / "cluster/1_0.queued");
  ::usleep(1'000'000);
  ::kill(head, SIGTERM);
  const Outcome outcome = wait(head);
  EXPECT_EQ(status("far")["done"], 0) << outcome.errors;
  EXPECT_THAT(status("far")["recent_failures"].dump(), HasSubstr("node n1 makes another frame"));
}

TEST_F(SlurmTest, ATaskThatIsPutBackIntoTheQueueIsNotWaitedFor) {
  const pid_t head = start_held("9");
  wait_for("far/slurm/0001/job");
  write("far/slurm/0001/claims/0", "{}");  // it had begun, and Slurm has it wait again
  wait_for("far/slurm/0002/job");
  EXPECT_THAT(calls(), HasSubstr("scancel --quiet 1_0"));
  ::kill(head, SIGINT);
  EXPECT_EQ(wait(head).exit_code, 130);
}

TEST_F(SlurmTest, StoppedItCancelsAndIsResumed) {
  const pid_t head = start_held("2");
  wait_for("far/slurm/0001/job");
  ::kill(head, SIGINT);
  const Outcome stopped = wait(head);
  EXPECT_EQ(stopped.exit_code, 130) << stopped.errors;
  EXPECT_TRUE(fs::is_empty(folder_ / "far/frames"));
  for (const auto& entry : fs::directory_iterator(folder_ / "cluster")) {
    EXPECT_NE(entry.path().extension(), ".queued") << entry.path();
  }
  const Outcome resumed = run({"resume", "far", "--executor", "local"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_EQ(hash_of("far"), local_hash());
}

TEST_F(SlurmTest, ANodeKeepsAssetsForItsNextTask) {
  EXPECT_EQ(by_slurm("{}", {"--node-folder", (folder_ / "node").string()}).exit_code, 0);
  std::size_t copies = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "node/assets")) {
    EXPECT_EQ(entry.path().extension(), ".drc");
    ++copies;
  }
  EXPECT_GE(copies, 1U);
  for (const auto& entry : fs::directory_iterator(folder_ / "node")) {
    EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr("task-")));
  }
}

TEST_F(SlurmTest, AnAuditOnOtherNodesNeedsACluster) {
  EXPECT_EQ(by_slurm("{}").exit_code, 0);
  const Outcome audit = run({"audit", "far", "--frames", "3", "--vary", "node"}, environment("{}"));
  EXPECT_EQ(audit.exit_code, 0) << audit.errors;
  EXPECT_THAT(audit.output, HasSubstr("varying node"));
  EXPECT_THAT(audit.output, HasSubstr("3 identical"));
  EXPECT_THAT(calls(), HasSubstr("--exclude=n"));
  local_hash();
  const Outcome near = run({"audit", "near", "--frames", "3", "--vary", "node"});
  EXPECT_EQ(near.exit_code, 2);
  EXPECT_THAT(near.errors, HasSubstr("give --executor slurm"));
}

}  // namespace
}  // namespace seedframe
