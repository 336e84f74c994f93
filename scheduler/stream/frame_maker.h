// Makes frames for values of a config's variables, one by one, by whatever fidelity is asked for.
// Nothing of them stays, unless those that are rendered are to be kept (frame_keeper.h).
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "annotate/labels.h"
#include "base/error.h"
#include "campaign/finish_queue.h"
#include "campaign/run_options.h"
#include "frames/frame_finisher.h"
#include "image/image.h"
#include "preview/shading_images.h"
#include "render/local_executor.h"
#include "render/worker_pool.h"
#include "scene/prepared_campaign.h"
#include "stream/frame_keeper.h"
#include "stream/request.h"
#include "twin/twin.h"

namespace seedframe {

struct MadeFrame {
  std::string frame_id;
  int width = 0;
  int height = 0;
  std::optional<FrameLabels> labels;                ///< as asked for
  std::optional<Image<std::uint8_t>> image;         ///< RGB, for a display
  std::optional<Image<std::uint16_t>> ids;          ///< 0 is background
  std::optional<Image<float>> depth;                ///< planar, metres; kNoDepth where nothing is
  std::map<std::string, std::string> pixel_hashes;  ///< as a campaign's manifest has them
  double made_s = 0.0;                              ///< from when it was begun
  double worker_s = 0.0;                            ///< of that in Blender
  std::optional<std::int64_t> kept;                 ///< its number in the campaign that keeps it
};

/// Told once, by some thread of the maker's.
using FrameDone = std::function<void(Result<MadeFrame>)>;

/// A frame that somebody waits for; `cancelled` may be set at any time.
struct FrameOrder {
  FrameRequest request;
  FrameDone done;
  std::shared_ptr<std::atomic<bool>> cancelled = std::make_shared<std::atomic<bool>>(false);
  std::chrono::steady_clock::time_point came = std::chrono::steady_clock::now();
};

class FrameMaker : private RenderClient {
 public:
  /// Sets up what rendering needs, when the first frame is to be rendered.
  using SetUp = std::function<Result<RunSetup>()>;

  /// `threads` trace or finish frames; files of a rendering are written into `scratch` and removed.
  /// `keeper`: null, nothing is kept; else `scratch` is what its campaign gives to workers. They
  /// must outlive it.
  FrameMaker(const PreparedCampaign& prepared, int threads, std::filesystem::path scratch,
             SetUp set_up, FrameKeeper* keeper = nullptr);
  /// Waits for what is under way.
  ~FrameMaker() override;

  /// From any thread.
  void make(FrameOrder order);

 private:
  /// Between expansion and the answer.
  struct Rendering {
    FrameOrder order;
    ExpandedFrame frame;
    std::chrono::steady_clock::time_point begun;
    // Of the last attempt, and those before it:
    int worker = 0;
    double started = 0.0;  ///< Unix time, seconds
    ReadyMessage made_by = {};
    std::vector<AttemptFailure> failures = {};
  };

  /// Workers until there is no room for what they need: then the next request begins anew.
  struct Pool {
    std::unique_ptr<LocalExecutor> executor;
    std::unique_ptr<WorkerPool> workers;
    std::jthread thread;
  };

  void begin(FrameOrder order);
  Result<ExpandedFrame> expand(const FrameRequest& request) const;
  Result<MadeFrame> trace(const FrameRequest& request, const ExpandedFrame& frame);
  Status shade(const ExpandedFrame& frame, MadeFrame& made);

  Status start_pool();
  Status set_up_rendering();
  void begin_pool();
  Status can_render();
  Result<RenderRequest> prepare(const FrameJob& job, const Rendering& rendering) const;
  void finish(const FrameJob& job, const RenderTimings& timings);
  Status finish(const FrameJob& job, const RenderTimings& timings, const Rendering& rendering);
  void keep(const FrameJob& job, const RenderTimings& timings, const Rendering& rendering,
            const FinishTask& task, const FinishedFrame& finished, MadeFrame made);
  /// Where the worker writes, and where it is finished: a folder that no worker gets at if the
  /// frame is kept.
  std::filesystem::path given_folder(const FrameJob& job) const;
  std::filesystem::path attempt_folder(const FrameJob& job) const;
  std::shared_ptr<Rendering> rendering_of(std::int64_t number);
  /// After the worker is done with it.
  void settle(const FrameJob& job, Result<MadeFrame> made);
  void answer(std::int64_t number, Result<MadeFrame> made);

  // What the pool asks and tells.
  Result<std::optional<RenderRequest>> request(const FrameJob& job) override;
  void started(const FrameJob& job, int worker) override;
  void rendered(const FrameJob& job, const RenderTimings& timings, int worker) override;
  void attempt_failed(const FrameJob& job, const AttemptFailure& failure) override;
  Status check_system() override { return {}; }
  void worker_ready(int worker, const ReadyMessage& ready) override;

  const PreparedCampaign& prepared_;
  std::filesystem::path scratch_;
  SetUp set_up_;
  FrameKeeper* keeper_;
  TwinTracer tracer_;
  FrameFinisher finisher_;
  ShadingImages images_;
  std::mutex mutex_;  ///< guards what follows
  std::map<std::int64_t, std::shared_ptr<Rendering>> renderings_;
  std::int64_t last_number_ = 0;
  std::map<int, ReadyMessage> ready_;  ///< what each worker said of itself
  Status pool_state_;
  std::optional<RunSetup> setup_;
  std::vector<std::unique_ptr<Pool>> pools_;  ///< those that are over, too: others may post to them
  std::atomic<WorkerPool*> pool_ = nullptr;   ///< the last one
  std::unique_ptr<FinishQueue> queue_;        ///< its threads use all of the above
};

}  // namespace seedframe
