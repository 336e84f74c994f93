#include "store/job_store.h"

#include <unistd.h>

#include "base/sha256.h"
#include "store/job_store_database.h"

namespace seedframe {
namespace {

using sqlite::Statement;

constexpr int kVersion = 4;

constexpr const char* kSchema = R"sql(
BEGIN;
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL, sha256 TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE frames (
  frame INTEGER PRIMARY KEY,
  scene INTEGER NOT NULL,
  frame_id TEXT NOT NULL,
  state TEXT NOT NULL
    CHECK (state IN ('pending', 'running', 'done', 'failed', 'quarantined')),
  attempts INTEGER NOT NULL DEFAULT 0,
  crashes INTEGER NOT NULL DEFAULT 0,
  pixel_hash TEXT NOT NULL DEFAULT '',
  fingerprint TEXT NOT NULL DEFAULT '',
  error TEXT NOT NULL DEFAULT '',
  twin_pixels INTEGER NOT NULL DEFAULT 0,
  twin_inside_px INTEGER NOT NULL DEFAULT 0,
  twin_edge_px INTEGER NOT NULL DEFAULT 0);
CREATE INDEX frames_by_state ON frames (state);
CREATE TABLE runs (
  run INTEGER PRIMARY KEY,
  started REAL NOT NULL,
  host TEXT NOT NULL,
  process INTEGER NOT NULL);
CREATE TABLE provenances (
  provenance INTEGER PRIMARY KEY,
  json TEXT NOT NULL UNIQUE);
CREATE TABLE attempts (
  frame INTEGER NOT NULL,
  attempt INTEGER NOT NULL,
  run INTEGER NOT NULL,
  worker INTEGER NOT NULL,
  outcome TEXT NOT NULL CHECK (outcome IN ('running', 'done', 'error', 'crash', 'lost')),
  started REAL NOT NULL,
  build_s REAL NOT NULL DEFAULT 0,
  render_s REAL NOT NULL DEFAULT 0,
  finish_s REAL NOT NULL DEFAULT 0,
  message TEXT NOT NULL DEFAULT '',
  provenance INTEGER REFERENCES provenances (provenance),
  PRIMARY KEY (frame, attempt)) WITHOUT ROWID;
CREATE INDEX attempts_by_outcome ON attempts (outcome, started);
PRAGMA user_version = 4;
COMMIT;
)sql";

/// Whether nobody of this machine changes it, nor could SQLite put beside it what a reader needs;
/// and whether it is all there is: no scheduler has left a WAL.
bool is_unchanging(const std::filesystem::path& path) {
  std::error_code error;
  return ::access(std::filesystem::absolute(path).parent_path().c_str(), W_OK) != 0 &&
         !std::filesystem::exists(path.string() + "-wal", error);
}

Status open_for_writing(sqlite::Connection& connection, const std::filesystem::path& path) {
  if (Status opened = connection.open(path, SQLITE_OPEN_READWRITE); !opened) return opened;
  // A checkpoint waits for the disk: one for 32 MiB of log delays few commits.
  for (const char* sql : {"PRAGMA journal_mode = WAL", "PRAGMA synchronous = FULL",
                          "PRAGMA wal_autocheckpoint = 8192"}) {
    if (Status done = connection.execute(sql); !done) return done;
  }
  return {};
}

}  // namespace

JobStore::JobStore(std::unique_ptr<Database> database) : database_(std::move(database)) {}
JobStore::~JobStore() = default;
JobStore::JobStore(JobStore&&) noexcept = default;
JobStore& JobStore::operator=(JobStore&&) noexcept = default;

Result<JobStore> JobStore::create(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error)) {
    return fail(ErrorKind::kInput, "{} exists already", path.string());
  }
  auto database = std::make_unique<Database>();
  const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  if (Status opened = database->connection.open(path, flags); !opened) return forward_error(opened);
  // One file and no log beside it while it is made: it is renamed when it is complete.
  for (const char* sql : {"PRAGMA journal_mode = DELETE", "PRAGMA synchronous = FULL", kSchema}) {
    if (Status done = database->connection.execute(sql); !done) return forward_error(done);
  }
  return JobStore(std::move(database));
}

Result<JobStore> JobStore::open(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return fail(ErrorKind::kInput, "there is no campaign here: {} is missing", path.string());
  }
  auto database = std::make_unique<Database>();
  const Status opened = is_unchanging(path) ? database->connection.open_unchanging(path)
                                            : open_for_writing(database->connection, path);
  if (!opened) return forward_error(opened);
  Statement version(database->connection, "PRAGMA user_version");
  if (!version.step()) return tl::unexpected(version.status().error());
  if (version.integer(0) != kVersion) {
    return fail(ErrorKind::kCorrupt,
                "{} is a job store of version {}; this program reads version {}: use the Seedframe "
                "that made it, or submit the campaign again",
                path.string(), version.integer(0), kVersion);
  }
  return JobStore(std::move(database));
}

Status JobStore::set_meta(const std::string& key, const std::string& value) {
  Statement insert(database_->connection,
                   "INSERT OR REPLACE INTO meta (key, value, sha256) VALUES (?, ?, ?)");
  return insert.bind(1, key).bind(2, value).bind(3, sha256_hex(value)).run();
}

Status JobStore::add_frames(const std::function<Result<std::optional<FrameRow>>()>& next) {
  return database_->transaction([&]() -> Status {
    Statement insert(database_->connection,
                     "INSERT INTO frames (frame, scene, frame_id, state) "
                     "VALUES (?, ?, ?, 'pending')");
    while (true) {
      const Result<std::optional<FrameRow>> row = next();
      if (!row) return forward_error(row);
      if (!*row) return {};
      insert.bind(1, (*row)->frame).bind(2, (*row)->scene).bind(3, (*row)->frame_id);
      if (Status done = insert.run(); !done) return done;
      insert.reset();
    }
  });
}

Status JobStore::begin_run(double unix_time, const std::string& host, std::int64_t process) {
  database_->run = 0;
  std::int64_t run = 0;
  Status begun = database_->transaction([&]() -> Status {
    Statement insert(database_->connection,
                     "INSERT INTO runs (started, host, process) VALUES (?, ?, ?)");
    if (Status done = insert.bind(1, unix_time).bind(2, host).bind(3, process).run(); !done) {
      return done;
    }
    run = sqlite3_last_insert_rowid(database_->connection.handle());
    if (Status done = database_->connection.execute(
            "UPDATE attempts SET outcome = 'lost', message = 'its scheduler ended before it' "
            "WHERE outcome = 'running'");
        !done) {
      return done;
    }
    return database_->connection.execute(
        "UPDATE frames SET state = 'pending' WHERE state = 'running'");
  });
  if (begun) database_->run = run;
  return begun;
}

Status JobStore::reset(std::int64_t frame) {
  return database_->transaction([&] {
    Statement update(database_->connection,
                     "UPDATE frames SET state = 'pending', pixel_hash = '', fingerprint = '', "
                     "crashes = 0 WHERE frame = ?");
    return update.bind(1, frame).run();
  });
}

Status JobStore::renew(std::int64_t frame, const std::string& frame_id) {
  return database_->transaction([&]() -> Status {
    if (Status done = reset(frame); !done) return done;
    Statement update(database_->connection, "UPDATE frames SET frame_id = ? WHERE frame = ?");
    return update.bind(1, frame_id).bind(2, frame).run();
  });
}

Status JobStore::adopt(std::int64_t frame, const FrameResult& result) {
  return database_->transaction([&] {
    Statement update(database_->connection,
                     "UPDATE frames SET state = 'done', pixel_hash = ?, fingerprint = ?, "
                     "error = '', twin_pixels = ?, twin_inside_px = ?, twin_edge_px = ? "
                     "WHERE frame = ?");
    update.bind(1, result.pixel_hash).bind(2, result.fingerprint).bind(3, result.twin.pixels);
    update.bind(4, result.twin.inside_px).bind(5, result.twin.edge_px);
    return update.bind(6, frame).run();
  });
}

Status JobStore::set_fingerprint(std::int64_t frame, const std::string& fingerprint) {
  return database_->transaction([&] {
    Statement update(database_->connection, "UPDATE frames SET fingerprint = ? WHERE frame = ?");
    return update.bind(1, fingerprint).bind(2, frame).run();
  });
}

Status JobStore::attempt_started(std::int64_t frame, int attempt, int worker, double unix_time,
                                 const std::string& provenance) {
  return database_->transaction([&]() -> Status {
    if (!provenance.empty()) {
      Statement add(database_->connection, "INSERT OR IGNORE INTO provenances (json) VALUES (?)");
      if (Status done = add.bind(1, provenance).run(); !done) return done;
    }
    Statement insert(database_->connection,
                     "INSERT INTO attempts (frame, attempt, run, worker, outcome, started, "
                     "provenance) VALUES (?, ?, ?, ?, 'running', ?, "
                     "(SELECT provenance FROM provenances WHERE json = ?))");
    insert.bind(1, frame).bind(2, std::int64_t{attempt}).bind(3, database_->run);
    insert.bind(4, std::int64_t{worker});
    if (Status done = insert.bind(5, unix_time).bind(6, provenance).run(); !done) return done;
    Statement update(database_->connection,
                     "UPDATE frames SET state = 'running', attempts = ? WHERE frame = ?");
    return update.bind(1, std::int64_t{attempt}).bind(2, frame).run();
  });
}

Status JobStore::frame_done(std::int64_t frame, int attempt, const FrameResult& result,
                            const AttemptTimings& timings) {
  return database_->transaction([&]() -> Status {
    const Result<bool> under_way = is_under_way(frame, attempt);
    if (!under_way) return forward_error(under_way);
    if (!*under_way) {
      return fail(ErrorKind::kCorrupt, "attempt {} of frame {} is not the one under way", attempt,
                  frame);
    }
    if (Status done = adopt(frame, result); !done) return done;
    Statement finish(database_->connection,
                     "UPDATE attempts SET outcome = 'done', build_s = ?, render_s = ?, "
                     "finish_s = ? WHERE frame = ? AND attempt = ?");
    finish.bind(1, timings.build_s).bind(2, timings.render_s).bind(3, timings.finish_s);
    return finish.bind(4, frame).bind(5, std::int64_t{attempt}).run();
  });
}

Status JobStore::attempt_failed(std::int64_t frame, int attempt, AttemptOutcome outcome,
                                FrameState next, const std::string& message) {
  return database_->transaction([&]() -> Status {
    const std::int64_t crashes = outcome == AttemptOutcome::kCrash ? 1 : 0;
    Statement update(database_->connection,
                     "UPDATE frames SET state = ?1, error = ?2, attempts = ?4, "
                     "crashes = crashes + ?5 WHERE frame = ?3 AND attempts <= ?4 "
                     "AND state <> 'done' AND NOT EXISTS (SELECT 1 FROM attempts "
                     "WHERE frame = ?3 AND attempt = ?4 AND outcome <> 'running')");
    update.bind(1, std::string(to_string(next))).bind(2, message).bind(3, frame);
    if (Status done = update.bind(4, std::int64_t{attempt}).bind(5, crashes).run(); !done) {
      return done;
    }
    if (sqlite3_changes(database_->connection.handle()) == 0) return {};
    // A request that could not be made fails before any worker starts on it.
    Statement finish(database_->connection,
                     "INSERT INTO attempts (frame, attempt, run, worker, outcome, started, message)"
                     " VALUES (?, ?, ?, -1, ?, 0, ?) ON CONFLICT (frame, attempt) "
                     "DO UPDATE SET outcome = excluded.outcome, message = excluded.message");
    finish.bind(1, frame).bind(2, std::int64_t{attempt}).bind(3, database_->run);
    return finish.bind(4, std::string(to_string(outcome))).bind(5, message).run();
  });
}

Status JobStore::write_together(Sync sync, const std::function<Status()>& body) {
  if (sync == Sync::kNow) return database_->transaction(body);
  // With NORMAL, SQLite writes the commit to its log but does not wait for the disk.
  if (Status set = database_->connection.execute("PRAGMA synchronous = NORMAL"); !set) return set;
  const Status written = database_->transaction(body);
  const Status reset = database_->connection.execute("PRAGMA synchronous = FULL");
  return written ? reset : written;
}

}  // namespace seedframe
