#include "live/live_site.h"

#include <thread>

#include <gmock/gmock.h>
#include <unistd.h>

#include "campaign/campaign_runner.h"
#include "tests/campaign/campaign_fixture.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

const std::string kSiteToken = "00112233445566778899aabbccddeeff";

class NotingControl : public RunControl {
 public:
  RunState state(const Campaign&) override { return now; }
  Status pause(const Campaign&) override {
    asked.emplace_back("pause");
    return answer;
  }
  Status resume(const Campaign&, std::optional<std::int64_t> frame) override {
    asked.push_back(frame ? "retry " + std::to_string(*frame) : "resume");
    return answer;
  }
  RunState now;
  Status answer;
  std::vector<std::string> asked;
};

class LiveSiteTest : public CampaignFixture {
 protected:
  void SetUp() override {
    CampaignFixture::SetUp();
    open({campaign().files.root()});
  }
  void open(const std::vector<std::filesystem::path>& folders) {
    auto site = LiveSite::open(folders, SEEDFRAME_HOME, Gate(kSiteToken, 8123), control_,
                               [this] { return now_; });
    ASSERT_TRUE(site) << site.error().message;
    site_ = std::move(*site);
  }
  HttpResponse ask(const std::string& path, const std::string& method = "GET") {
    HttpRequest request{.method = method,
                        .path = path,
                        .query = {},
                        .headers = {{"host", "127.0.0.1:8123"},
                                    {"cookie", "seedframe_8123=" + kSiteToken},
                                    {"origin", "http://127.0.0.1:8123"},
                                    {"x-seedframe", "1"}}};
    return site_->answer(request);
  }
  Json state() { return Json::parse(ask("/c/0/live").body); }
  void make_frames(const std::vector<PendingFrame>& frames) {
    RunSetup setup;
    setup.options.pool.workers = 1;
    setup.options.worker.threads = 1;
    CampaignRunner runner(campaign(), *prepared_, used_, setup, observer_);
    const auto summary = runner.run_to_end(frames);
    ASSERT_TRUE(summary) << summary.error().message;
  }

  UsedFiles used_;
  NotingControl control_;
  std::chrono::steady_clock::time_point now_{};
  std::unique_ptr<LiveSite> site_;
};

TEST_F(LiveSiteTest, OneCampaignIsThePageItself) {
  const HttpResponse answer = ask("/");
  EXPECT_EQ(answer.status, 303);
  EXPECT_EQ(answer.headers.at("Location"), "/c/0/");
  const HttpResponse page = ask("/c/0/");
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.type, StartsWith("text/html"));
  EXPECT_THAT(page.body, HasSubstr("connect-src &#39;self&#39;"));
  EXPECT_THAT(page.body, Not(HasSubstr(scratch_.path().string())));
}

TEST_F(LiveSiteTest, SeveralAreListedAndKnowEachOther) {
  open({campaign().files.root(), campaign().files.root()});
  EXPECT_THAT(ask("/").body,
              HasSubstr("<a href=\"/c/1/\"><bdi>campaign</bdi></a>: 0 of 12 frames"));
  EXPECT_THAT(ask("/c/0/").body, HasSubstr("\"href\":\"/c/1/\""));
}

TEST_F(LiveSiteTest, TheStateFollowsTheStore) {
  EXPECT_EQ(state().at("done"), 0);
  EXPECT_EQ(state().at("at_work"), false);
  make_frames({{3}, {7}});
  const Json now = state();
  EXPECT_EQ(now.at("done"), 2);
  EXPECT_EQ(now.at("pending"), kFrames - 2);
  EXPECT_EQ(now.at("newest").size(), 2u);
  EXPECT_EQ(now.at("died"), false);
}

TEST_F(LiveSiteTest, TellsTheRateAndTheTimeThatIsLeft) {
  control_.now.scheduler = 4711;
  EXPECT_EQ(state().at("eta_s"), Json());
  make_frames({{0}, {1}, {2}, {3}});
  now_ += std::chrono::seconds(8);
  const Json now = state();
  EXPECT_DOUBLE_EQ(now.at("rate_per_s").get<double>(), 0.5);
  EXPECT_DOUBLE_EQ(now.at("eta_s").get<double>(), 16.0);
}

TEST_F(LiveSiteTest, TellsOfWorkersAndOfASchedulerThatDied) {
  ASSERT_TRUE(campaign().store.attempt_started(5, 1, 2, 0.0));
  control_.now.scheduler = 4711;
  control_.now.workers = {{4712, 2, 300}, {4713, 2, 50}, {4714, 1, 7}};
  const Json now = state();
  ASSERT_EQ(now.at("workers").size(), 1u);
  EXPECT_EQ(now.at("workers")[0].at("frame"), 5);
  EXPECT_EQ(now.at("workers")[0].at("memory_bytes"), 350);
  EXPECT_EQ(now.at("died"), false);
  control_.now = {};
  EXPECT_EQ(state().at("died"), true);
}

TEST_F(LiveSiteTest, PostsAreHandedOn) {
  EXPECT_EQ(ask("/c/0/pause", "POST").status, 202);
  EXPECT_EQ(ask("/c/0/resume", "POST").status, 202);
  EXPECT_EQ(ask("/c/0/retry/5", "POST").status, 202);
  EXPECT_THAT(control_.asked, ElementsAre("pause", "resume", "retry 5"));
  control_.answer = fail(ErrorKind::kInput, "nobody is at work on it");
  const HttpResponse refused = ask("/c/0/pause", "POST");
  EXPECT_EQ(refused.status, 409);
  EXPECT_EQ(Json::parse(refused.body).at("error"), "nobody is at work on it");
}

TEST_F(LiveSiteTest, AGetChangesNothing) {
  for (const char* path : {"/c/0/pause", "/c/0/resume", "/c/0/retry/5"}) {
    EXPECT_EQ(ask(path).status, 404) << path;
  }
  EXPECT_THAT(control_.asked, IsEmpty());
}

TEST_F(LiveSiteTest, ThereIsNothingOutsideOfTheCampaigns) {
  for (const char* path :
       {"/c/1/", "/c/-1/", "/c/0", "/c//", "/c/0/../../etc/passwd", "/c/0/campaign.yaml",
        "/c/0/thumbnail/../../campaign.sqlite", "/c/0/thumbnail/", "/c/0/thumbnail/1x",
        "/c/0/thumbnail/99999999999999999999", "/etc/passwd", "", "/favicon.ico", "//c/0/"}) {
    EXPECT_EQ(ask(path).status, 404) << path;
  }
  for (const char* path : {"/", "/c/0/", "/c/0/live", "/c/0/retry/", "/c/0/retry/-1"}) {
    EXPECT_EQ(ask(path, "POST").status, 404) << path;
  }
  EXPECT_THAT(control_.asked, IsEmpty());
}

TEST_F(LiveSiteTest, AThumbnailIsOfAFinishedFrame) {
  EXPECT_EQ(ask("/c/0/thumbnail/3").status, 404);
  make_frames({{3}});
  const HttpResponse picture = ask("/c/0/thumbnail/3");
  EXPECT_EQ(picture.status, 200);
  EXPECT_EQ(picture.type, "image/webp");
  EXPECT_THAT(picture.body, StartsWith("RIFF"));
  EXPECT_EQ(ask("/c/0/thumbnail/4").status, 404);
}

TEST_F(LiveSiteTest, ThePageIsMadeAnewWhenTheCampaignHasChanged) {
  const std::string before = ask("/c/0/").body;
  EXPECT_EQ(ask("/c/0/").body, before);
  make_frames({{3}});
  now_ += std::chrono::seconds(1);
  EXPECT_NE(ask("/c/0/").body, before);
}

TEST_F(LiveSiteTest, WithoutTheTokenThereIsNothing) {
  const HttpResponse answer = site_->answer(
      {.method = "GET", .path = "/c/0/live", .headers = {{"host", "127.0.0.1:8123"}}});
  EXPECT_EQ(answer.status, 403);
  EXPECT_EQ(answer.headers.at("Cache-Control"), "no-store");
}

TEST_F(LiveSiteTest, WhoHoldsTheLockIsFoundAndOthersAreNotSignalled) {
  EXPECT_EQ(lock_holder(campaign().files.lock()), ::getpid());
  EXPECT_EQ(lock_holder(scratch_ / "nothing"), std::nullopt);
  ProcessControl control("/no/program", {});
  EXPECT_EQ(control.state(campaign()).scheduler, ::getpid());
  const Status resumed = control.resume(campaign(), std::nullopt);
  ASSERT_FALSE(resumed);
  EXPECT_THAT(resumed.error().message, HasSubstr("at work on it already"));
  const CampaignFiles files = campaign().files;
  locked_.reset();
  const auto opened = open_campaign(files.root());
  ASSERT_TRUE(opened);
  EXPECT_EQ(lock_holder(files.lock()), std::nullopt);
  const Status paused = control.pause(*opened);
  ASSERT_FALSE(paused);
  EXPECT_THAT(paused.error().message, HasSubstr("nobody is at work"));
}

TEST_F(LiveSiteTest, ARunThatCannotStartLeavesItsLastWords) {
  const CampaignFiles files = campaign().files;
  locked_.reset();
  const auto opened = open_campaign(files.root());
  ASSERT_TRUE(opened);
  ASSERT_TRUE(write_file(scratch_ / "program", "#!/bin/sh\necho no Blender here >&2\nexit 4\n"));
  std::filesystem::permissions(scratch_ / "program", std::filesystem::perms::owner_all);
  ProcessControl control(scratch_ / "program", {});
  ASSERT_TRUE(control.resume(*opened, 3));
  RunState state;
  for (int i = 0; i < 500 && state.last_words.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    state = control.state(*opened);
  }
  EXPECT_EQ(state.last_words, "no Blender here\n");
  EXPECT_FALSE(state.starting);
}

}  // namespace
}  // namespace seedframe
