#include "slurm/slurm_commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::HasSubstr;

TEST(SlurmCommands, ReadsWhatTheControllerTakes) {
  const auto cluster = read_cluster(
      "Configuration data as of 2026-11-30\nMaxArraySize            = 1001\n"
      "MaxJobCount             = 10000\nMaxJobCountX = 3\n",
      "n1|8|idle|main\nn2|4|mixed|main\nn2|4|mixed|night\nn3|2|down*|main\nn4|2|drained|"
      "main\nnonsense\n");
  ASSERT_TRUE(cluster);
  EXPECT_EQ(cluster->most_tasks, 1001);
  EXPECT_EQ(cluster->most_jobs, 10000);
  EXPECT_EQ(cluster->nodes, 2) << "of those that work, each once";
  EXPECT_EQ(cluster->cpus, 4);
  const auto by_default =
      read_cluster("MaxArraySize = 9\nMaxJobCount = 9\n",
                   "n1|8|idle|main*\nn2|8|idle|main*\nn2|8|idle|all\nn3|1|idle|all\n");
  ASSERT_TRUE(by_default);
  EXPECT_EQ(by_default->nodes, 2) << "of the partition that jobs go to";
  EXPECT_EQ(by_default->cpus, 8);
  EXPECT_FALSE(read_cluster("", "n1|8|idle|main"));
  EXPECT_THAT(read_cluster("MaxArraySize = 0\nMaxJobCount = 5", "").error().message,
              HasSubstr("turned off"));
}

TEST(SlurmCommands, ReadsTheQueue) {
  const auto tasks = read_queue(
      "12|0|RUNNING|n1|seedframe ab\n12|1|PENDING|n/a|seedframe ab\n13|N/A|RUNNING|n2|(null)\n"
      "12|2|COMPLETING|n2|seedframe ab\n12|3|REQUEUE_HOLD|n/a|seedframe ab\nslurm: a warning\n");
  ASSERT_EQ(tasks.size(), 4U) << "other jobs are no tasks of arrays";
  EXPECT_EQ(tasks[0].job, 12);
  EXPECT_EQ(tasks[0].node, "n1");
  EXPECT_EQ(tasks[0].comment, "seedframe ab");
  EXPECT_FALSE(tasks[0].waits);
  EXPECT_TRUE(tasks[1].waits);
  EXPECT_EQ(tasks[1].node, "");
  EXPECT_FALSE(tasks[2].waits);
  EXPECT_TRUE(tasks[3].waits);
}

TEST(SlurmCommands, ReadsIdsAmongWarnings) {
  EXPECT_EQ(read_job_id("17\n"), 17);
  EXPECT_EQ(read_job_id("17;cluster\n"), 17);
  EXPECT_EQ(read_job_id("sbatch: warning: something\n42\n"), 42);
  EXPECT_EQ(read_job_id("sbatch: error\n"), std::nullopt);
}

TEST(SlurmCommands, ListsIndices) {
  EXPECT_EQ(index_list({0, 1, 2, 3}), "0-3");
  EXPECT_EQ(index_list({5}), "5");
  EXPECT_EQ(index_list({0, 2, 3, 9}), "0,2-3,9");
}

TEST(SlurmCommands, TellsRefusalsFromTroubles) {
  EXPECT_TRUE(is_refusal("sbatch: error: invalid partition specified: x"));
  EXPECT_TRUE(is_refusal("Batch job submission failed: Invalid account or account/partition"));
  EXPECT_TRUE(is_refusal("sbatch: unrecognized option '--qox'"));
  EXPECT_FALSE(is_refusal("Socket timed out on send/recv operation"));
  EXPECT_FALSE(is_refusal("Slurm temporarily unable to accept job, sleeping and retrying"));
  EXPECT_FALSE(is_refusal("Job violates accounting/QOS policy (job submit limit)"));
}

TEST(SlurmOptions, ReadsTimesAsSlurmDoes) {
  const std::vector<std::pair<const char*, std::int64_t>> times = {
      {"90", 5400},      {"90:30", 5430},      {"1:30:00", 5400},
      {"2-12", 216'000}, {"2-12:30", 217'800}, {"1-00:00:01", 86'401}};
  for (const auto& [text, seconds] : times) {
    const auto read = read_slurm_time(text);
    ASSERT_TRUE(read) << text;
    EXPECT_EQ(*read, seconds) << text;
  }
  for (const char* wrong :
       {"", "soon", "1:2:3:4", "-5", "1-", "0", "5m", "1.5", "1-2-3", "9999999"}) {
    EXPECT_FALSE(read_slurm_time(wrong)) << wrong;
  }
  EXPECT_EQ(slurm_time(301), "0:06:00");
  EXPECT_EQ(slurm_time(7260), "2:01:00");
}

TEST(SlurmOptions, AreRemembered) {
  SlurmOptions options;
  options.partition = "long";
  options.nodes = 7;
  options.time_s = 90;
  options.more = {"--account=lab", "--mem=4G"};
  options.poll_s = 0.5;
  options.node_folder = "/scratch";
  const auto read = slurm_options_from_json(to_json(options), "test");
  ASSERT_TRUE(read);
  EXPECT_EQ(to_json(*read), to_json(options));
  EXPECT_FALSE(slurm_options_from_json(Json::object(), "test"));
}

}  // namespace
}  // namespace seedframe
