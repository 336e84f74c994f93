#include "cache/frame_cache.h"

#include "base/files.h"
#include "base/sha256.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// A power loss may cost entries, or the whole index: nothing is lost with it.
constexpr const char* kCacheSchema = R"sql(
PRAGMA journal_mode = WAL;
PRAGMA synchronous = OFF;
CREATE TABLE IF NOT EXISTS frames_1 (
  frame_id TEXT NOT NULL,
  made_with TEXT NOT NULL,
  folder TEXT NOT NULL,
  PRIMARY KEY (frame_id, made_with)
) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS said_1 (subject TEXT PRIMARY KEY, said TEXT NOT NULL) WITHOUT ROWID;
)sql";

}  // namespace

std::string cache_key(const Json& provenance, const CampaignSettings& settings) {
  const TwinCheck& check = settings.twin_check;
  Json made_with = provenance;
  made_with.erase("threads");
  Json key = {
      {"made_with", made_with},
      {"categories", settings.categories},
      {"check", {check.wanted, check.tolerance.inside_share, check.tolerance.outline_share}}};
  if (settings.image_encoding != ImageEncoding{}) key["image"] = to_json(settings.image_encoding);
  return sha256_hex(canonical_json(key));
}

std::unique_ptr<FrameCache> FrameCache::open(const fs::path& folder) {
  if (folder.empty() || !make_folders(folder)) return nullptr;
  std::unique_ptr<FrameCache> cache(new FrameCache());
  constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
  const bool usable = cache->connection_.open(folder / "frames.sqlite", kFlags).has_value() &&
                      cache->connection_.execute(kCacheSchema).has_value();
  return usable ? std::move(cache) : nullptr;
}

std::optional<fs::path> FrameCache::find(const std::string& frame_id, const std::string& key) {
  const std::lock_guard lock(mutex_);
  sqlite::Statement select(connection_,
                           "SELECT folder FROM frames_1 WHERE frame_id = ? AND made_with = ?");
  if (!select.bind(1, frame_id).bind(2, key).step()) return std::nullopt;
  return fs::path(select.text(0));
}

void FrameCache::add(const std::string& frame_id, const std::string& key, const fs::path& folder) {
  const std::lock_guard lock(mutex_);
  sqlite::Statement insert(connection_, "INSERT OR REPLACE INTO frames_1 VALUES (?, ?, ?)");
  (void)insert.bind(1, frame_id).bind(2, key).bind(3, folder.string()).run();
}

void FrameCache::forget(const std::string& frame_id, const std::string& key) {
  const std::lock_guard lock(mutex_);
  sqlite::Statement remove(connection_,
                           "DELETE FROM frames_1 WHERE frame_id = ? AND made_with = ?");
  (void)remove.bind(1, frame_id).bind(2, key).run();
}

std::optional<std::string> FrameCache::recall(const std::string& subject) {
  const std::lock_guard lock(mutex_);
  sqlite::Statement select(connection_, "SELECT said FROM said_1 WHERE subject = ?");
  if (!select.bind(1, subject).step()) return std::nullopt;
  return std::string(select.text(0));
}

void FrameCache::remember(const std::string& subject, const std::string& said) {
  const std::lock_guard lock(mutex_);
  sqlite::Statement insert(connection_, "INSERT OR REPLACE INTO said_1 VALUES (?, ?)");
  (void)insert.bind(1, subject).bind(2, said).run();
}

}  // namespace seedframe
