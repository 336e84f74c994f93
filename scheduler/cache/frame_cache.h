// Which frames have been rendered on this machine, and where they are, so that none is rendered
// twice. An index only: the frames stay in their campaigns. Beside it what programs said of
// themselves, so that they need not be started to be asked again (known_worker.h).
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "spec/campaign_settings.h"
#include "store/sqlite.h"

namespace seedframe {

/// What must be the same for a frame of the same id to have the same files: the provenance of its
/// attempt but for threads, which change no pixel, and what decides over labels, over the picture's
/// file, and over whether a frame is accepted. 64 hex digits.
std::string cache_key(const Json& provenance, const CampaignSettings& settings);

/// One SQLite file, for all processes of the user. Nothing here is an error: a cache that cannot be
/// used is empty. From any thread.
class FrameCache {
 public:
  /// `folder` is made if need be. Null if there can be no cache.
  static std::unique_ptr<FrameCache> open(const std::filesystem::path& folder);

  /// The folder of a frame; it may be gone or altered since.
  std::optional<std::filesystem::path> find(const std::string& frame_id, const std::string& key);
  /// `folder` is absolute.
  void add(const std::string& frame_id, const std::string& key,
           const std::filesystem::path& folder);
  void forget(const std::string& frame_id, const std::string& key);

  /// What was said last of a subject.
  std::optional<std::string> recall(const std::string& subject);
  void remember(const std::string& subject, const std::string& said);

 private:
  FrameCache() = default;

  std::mutex mutex_;
  sqlite::Connection connection_;
};

}  // namespace seedframe
