// The frame cache as one run uses it.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "base/error.h"
#include "cache/frame_cache.h"
#include "frames/manifest.h"
#include "render/message.h"
#include "render/worker_options.h"
#include "spec/campaign_settings.h"

namespace seedframe {

/// Takes frames that were made with what the run's workers make frames with, and adds those that
/// they made. What workers make frames with is believed from earlier runs until one has started,
/// and is what that one says from then on. From any thread.
class CachedFrames {
 public:
  enum class Use { kTakeAndAdd, kAdd };
  /// `facts`: see worker_identity. An empty folder: there is no cache. The settings must outlive
  /// it.
  CachedFrames(const std::filesystem::path& folder, Use use, const CampaignSettings& settings,
               const Json& facts, const WorkerOptions& worker);

  /// What a worker of this machine would say, if frames may be taken and it is known.
  std::optional<ReadyMessage> expected_worker();
  /// A worker is ready; its attempts have this provenance.
  void worker_is_ready(const ReadyMessage& ready, const std::string& provenance);
  /// Until a worker is ready: frames are made with this.
  void expect(const std::string& provenance);
  /// The provenance of frames that are taken; empty if none can be.
  std::string made_with();
  /// A worker is another one than was expected.
  bool was_mistaken();

  bool has(const std::string& frame_id);
  /// Links a frame into `attempt`, an empty folder. None if it is not there, or not whole.
  std::optional<Manifest> take(const std::string& frame_id, const std::filesystem::path& attempt);
  /// A frame that lies committed in `folder`; `provenance` is that of its attempt.
  void add(const std::string& frame_id, const std::string& provenance,
           const std::filesystem::path& folder);

 private:
  std::optional<std::string> key_to_take();
  std::string key_of(const std::string& provenance) const;

  std::unique_ptr<FrameCache> cache_;  ///< null: there is none
  Use use_;
  const CampaignSettings& settings_;
  std::string identity_;
  std::mutex mutex_;       ///< guards what follows
  std::string made_with_;  ///< by the first worker that was ready, or that is expected
  std::string key_;        ///< of that
  bool any_ready_ = false;
  bool mistaken_ = false;
};

}  // namespace seedframe
