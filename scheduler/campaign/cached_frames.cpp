#include "campaign/cached_frames.h"

#include "base/canonical_json.h"
#include "cache/known_worker.h"
#include "frames/frame_link.h"

namespace seedframe {
namespace fs = std::filesystem;

CachedFrames::CachedFrames(const fs::path& folder, Use use, const CampaignSettings& settings,
                           const Json& facts, const WorkerOptions& worker)
    : cache_(FrameCache::open(folder)),
      use_(use),
      settings_(settings),
      identity_(cache_ ? worker_identity(facts, worker) : std::string()) {}

std::optional<ReadyMessage> CachedFrames::expected_worker() {
  if (!cache_ || use_ == Use::kAdd) return std::nullopt;
  return recall_worker(*cache_, identity_);
}

void CachedFrames::worker_is_ready(const ReadyMessage& ready, const std::string& provenance) {
  if (!cache_) return;
  remember_worker(*cache_, identity_, ready);
  const std::lock_guard lock(mutex_);
  if (any_ready_) return;
  any_ready_ = true;
  mistaken_ = !made_with_.empty() && provenance != made_with_;
  made_with_ = provenance;
  key_ = key_of(provenance);
}

void CachedFrames::expect(const std::string& provenance) {
  const std::lock_guard lock(mutex_);
  made_with_ = provenance;
  key_ = key_of(provenance);
}

std::string CachedFrames::key_of(const std::string& provenance) const {
  return cache_key(Json::parse(provenance), settings_);
}

std::string CachedFrames::made_with() {
  const std::lock_guard lock(mutex_);
  return made_with_;
}

bool CachedFrames::was_mistaken() {
  const std::lock_guard lock(mutex_);
  return mistaken_;
}

std::optional<std::string> CachedFrames::key_to_take() {
  const std::lock_guard lock(mutex_);
  if (!cache_ || use_ == Use::kAdd || key_.empty()) return std::nullopt;
  return key_;
}

bool CachedFrames::has(const std::string& frame_id) {
  const std::optional<std::string> key = key_to_take();
  return key && cache_->find(frame_id, *key).has_value();
}

std::optional<Manifest> CachedFrames::take(const std::string& frame_id, const fs::path& attempt) {
  const std::optional<std::string> key = key_to_take();
  if (!key) return std::nullopt;
  const std::optional<fs::path> found = cache_->find(frame_id, *key);
  if (!found) return std::nullopt;
  Result<Manifest> manifest = link_frame(*found, frame_id, attempt);
  if (manifest) return std::move(*manifest);
  cache_->forget(frame_id, *key);
  return std::nullopt;
}

void CachedFrames::add(const std::string& frame_id, const std::string& provenance,
                       const fs::path& folder) {
  if (!cache_) return;
  std::error_code ignored;
  cache_->add(frame_id, key_of(provenance), fs::absolute(folder, ignored));
}

}  // namespace seedframe
