#include "store/job_store.h"

#include <array>

#include "base/sha256.h"
#include "store/sqlite.h"

namespace seedframe {
namespace {

using sqlite::Statement;

constexpr int kVersion = 2;
constexpr std::array<const char*, 4> kStateNames = {"pending", "running", "done", "failed"};

constexpr const char* kSchema = R"sql(
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE frames (
  frame INTEGER PRIMARY KEY,
  scene INTEGER NOT NULL,
  frame_id TEXT NOT NULL,
  state TEXT NOT NULL CHECK (state IN ('pending', 'running', 'done', 'failed')),
  attempts INTEGER NOT NULL DEFAULT 0,
  pixel_hash TEXT NOT NULL DEFAULT '',
  error TEXT NOT NULL DEFAULT '',
  twin_pixels INTEGER NOT NULL DEFAULT 0,
  twin_inside_px INTEGER NOT NULL DEFAULT 0,
  twin_edge_px INTEGER NOT NULL DEFAULT 0);
CREATE INDEX frames_by_state ON frames (state);
CREATE TABLE attempts (
  frame INTEGER NOT NULL,
  attempt INTEGER NOT NULL,
  worker INTEGER NOT NULL,
  outcome TEXT NOT NULL CHECK (outcome IN ('running', 'done', 'failed')),
  started REAL NOT NULL,
  build_s REAL NOT NULL DEFAULT 0,
  render_s REAL NOT NULL DEFAULT 0,
  finish_s REAL NOT NULL DEFAULT 0,
  message TEXT NOT NULL DEFAULT '',
  PRIMARY KEY (frame, attempt)) WITHOUT ROWID;
CREATE INDEX attempts_by_outcome ON attempts (outcome, started);
PRAGMA user_version = 2;
)sql";

constexpr const char* kFrameColumns =
    "SELECT frame, scene, frame_id, state, attempts, pixel_hash, error, twin_pixels, "
    "twin_inside_px, twin_edge_px FROM frames ";

FrameRow frame_row(const Statement& row) {
  FrameRow frame;
  frame.frame = row.integer(0);
  frame.scene = row.integer(1);
  frame.frame_id = row.text(2);
  const std::string state = row.text(3);
  for (std::size_t i = 0; i < kStateNames.size(); ++i) {
    if (state == kStateNames[i]) frame.state = static_cast<FrameState>(i);
  }
  frame.attempts = static_cast<int>(row.integer(4));
  frame.pixel_hash = row.text(5);
  frame.error = row.text(6);
  frame.twin = {row.integer(7), row.integer(8), row.integer(9)};
  return frame;
}

constexpr const char* kAttemptColumns =
    "SELECT frame, attempt, worker, outcome, started, build_s, render_s, finish_s, message "
    "FROM attempts ";

AttemptRow attempt_row(const Statement& row) {
  return {.frame = row.integer(0),
          .attempt = static_cast<int>(row.integer(1)),
          .worker = static_cast<int>(row.integer(2)),
          .outcome = row.text(3),
          .started = row.real(4),
          .build_s = row.real(5),
          .render_s = row.real(6),
          .finish_s = row.real(7),
          .message = row.text(8)};
}

}  // namespace

const char* to_string(FrameState state) { return kStateNames[static_cast<std::size_t>(state)]; }

struct JobStore::Database {
  sqlite::Connection connection;

  /// Runs `body` between BEGIN and COMMIT; an error rolls back. Inside a transaction it is part of
  /// that.
  template <class Body>
  Status transaction(Body body) {
    if (sqlite3_get_autocommit(connection.handle()) == 0) return body();
    if (Status begun = connection.execute("BEGIN IMMEDIATE"); !begun) return begun;
    Status done = body();
    if (done) done = connection.execute("COMMIT");
    if (!done) (void)connection.execute("ROLLBACK");
    return done;
  }
};

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
  for (const char* sql : {"PRAGMA journal_mode = WAL", "PRAGMA synchronous = FULL", kSchema}) {
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
  if (Status opened = database->connection.open(path, SQLITE_OPEN_READWRITE); !opened) {
    return forward_error(opened);
  }
  for (const char* sql : {"PRAGMA journal_mode = WAL", "PRAGMA synchronous = FULL"}) {
    if (Status done = database->connection.execute(sql); !done) return forward_error(done);
  }
  Statement version(database->connection, "PRAGMA user_version");
  if (!version.step()) return tl::unexpected(version.status().error());
  if (version.integer(0) != kVersion) {
    return fail(ErrorKind::kCorrupt,
                "{} is a job store of version {}; this program reads version {}: use the Seedframe "
                "that made it, or submit the campaign anew",
                path.string(), version.integer(0), kVersion);
  }
  return JobStore(std::move(database));
}

Status JobStore::set_meta(const std::string& key, const std::string& value) {
  Statement insert(database_->connection,
                   "INSERT INTO meta VALUES (?, ?) ON CONFLICT (key) DO UPDATE SET value = "
                   "excluded.value");
  return insert.bind(1, key).bind(2, value).run();
}

Result<std::string> JobStore::meta(const std::string& key) const {
  Statement select(database_->connection, "SELECT value FROM meta WHERE key = ?");
  std::string value;
  if (select.bind(1, key).step()) value = select.text(0);
  if (Status done = select.status(); !done) return forward_error(done);
  return value;
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

Status JobStore::reset_running() {
  return database_->transaction([&]() -> Status {
    if (Status done = database_->connection.execute(
            "UPDATE attempts SET outcome = 'failed', message = 'the scheduler stopped' "
            "WHERE outcome = 'running'");
        !done) {
      return done;
    }
    return database_->connection.execute(
        "UPDATE frames SET state = 'pending' WHERE state = 'running'");
  });
}

Status JobStore::reset(std::int64_t frame) {
  Statement update(database_->connection,
                   "UPDATE frames SET state = 'pending', pixel_hash = '' WHERE frame = ?");
  return update.bind(1, frame).run();
}

Status JobStore::adopt(std::int64_t frame, const std::string& pixel_hash, const TwinTally& twin) {
  Statement update(database_->connection,
                   "UPDATE frames SET state = 'done', pixel_hash = ?, error = '', twin_pixels = ?, "
                   "twin_inside_px = ?, twin_edge_px = ? WHERE frame = ?");
  update.bind(1, pixel_hash).bind(2, twin.pixels).bind(3, twin.inside_px).bind(4, twin.edge_px);
  return update.bind(5, frame).run();
}

Status JobStore::attempt_started(std::int64_t frame, int attempt, int worker, double unix_time) {
  return database_->transaction([&]() -> Status {
    Statement insert(database_->connection,
                     "INSERT INTO attempts (frame, attempt, worker, outcome, started) "
                     "VALUES (?, ?, ?, 'running', ?)");
    insert.bind(1, frame).bind(2, std::int64_t{attempt}).bind(3, std::int64_t{worker});
    if (Status done = insert.bind(4, unix_time).run(); !done) return done;
    Statement update(database_->connection,
                     "UPDATE frames SET state = 'running', attempts = ? WHERE frame = ?");
    return update.bind(1, std::int64_t{attempt}).bind(2, frame).run();
  });
}

Status JobStore::frame_done(std::int64_t frame, int attempt, const std::string& pixel_hash,
                            const TwinTally& twin, const AttemptTimings& timings) {
  return database_->transaction([&]() -> Status {
    // Only the attempt that is under way may commit: a late report changes nothing.
    Statement update(database_->connection,
                     "UPDATE frames SET state = 'done', pixel_hash = ?, error = '', "
                     "twin_pixels = ?, twin_inside_px = ?, twin_edge_px = ? "
                     "WHERE frame = ? AND attempts = ? AND state = 'running'");
    update.bind(1, pixel_hash).bind(2, twin.pixels).bind(3, twin.inside_px).bind(4, twin.edge_px);
    update.bind(5, frame).bind(6, std::int64_t{attempt});
    if (Status done = update.run(); !done) return done;
    if (sqlite3_changes(database_->connection.handle()) != 1) {
      return fail(ErrorKind::kCorrupt, "attempt {} of frame {} is not the one under way", attempt,
                  frame);
    }
    Statement finish(database_->connection,
                     "UPDATE attempts SET outcome = 'done', build_s = ?, render_s = ?, "
                     "finish_s = ? WHERE frame = ? AND attempt = ?");
    finish.bind(1, timings.build_s).bind(2, timings.render_s).bind(3, timings.finish_s);
    return finish.bind(4, frame).bind(5, std::int64_t{attempt}).run();
  });
}

Status JobStore::attempt_failed(std::int64_t frame, int attempt, const std::string& message,
                                bool final) {
  return database_->transaction([&]() -> Status {
    Statement update(database_->connection,
                     "UPDATE frames SET state = ?1, error = ?2, attempts = ?4 "
                     "WHERE frame = ?3 AND attempts <= ?4 AND state <> 'done'");
    update.bind(1, std::string(final ? "failed" : "pending")).bind(2, message).bind(3, frame);
    if (Status done = update.bind(4, std::int64_t{attempt}).run(); !done) return done;
    // A request that could not be made fails before any worker starts on it.
    Statement finish(database_->connection,
                     "INSERT INTO attempts (frame, attempt, worker, outcome, started, message) "
                     "VALUES (?, ?, -1, 'failed', 0, ?) ON CONFLICT (frame, attempt) "
                     "DO UPDATE SET outcome = 'failed', message = excluded.message");
    finish.bind(1, frame).bind(2, std::int64_t{attempt});
    return finish.bind(3, message).run();
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

Result<FrameCounts> JobStore::counts() const {
  Statement select(database_->connection, "SELECT state, count(*) FROM frames GROUP BY state");
  FrameCounts counts;
  while (select.step()) {
    const std::string state = select.text(0);
    const std::int64_t count = select.integer(1);
    if (state == "pending") counts.pending = count;
    if (state == "running") counts.running = count;
    if (state == "done") counts.done = count;
    if (state == "failed") counts.failed = count;
  }
  if (Status done = select.status(); !done) return forward_error(done);
  return counts;
}

Result<std::optional<FrameRow>> JobStore::frame(std::int64_t frame) const {
  const std::string sql = std::string(kFrameColumns) + "WHERE frame = ?";
  Statement select(database_->connection, sql.c_str());
  std::optional<FrameRow> row;
  if (select.bind(1, frame).step()) row = frame_row(select);
  if (Status done = select.status(); !done) return forward_error(done);
  return row;
}

Status JobStore::for_each_frame(const std::function<Status(const FrameRow&)>& visit) const {
  const std::string sql = std::string(kFrameColumns) + "ORDER BY frame";
  Statement select(database_->connection, sql.c_str());
  while (select.step()) {
    if (Status done = visit(frame_row(select)); !done) return done;
  }
  return select.status();
}

Result<std::vector<FrameRow>> JobStore::frames_from(std::int64_t first, int most) const {
  const std::string sql = std::string(kFrameColumns) + "WHERE frame >= ? ORDER BY frame LIMIT ?";
  Statement select(database_->connection, sql.c_str());
  select.bind(1, first).bind(2, std::int64_t{most});
  std::vector<FrameRow> rows;
  while (select.step()) rows.push_back(frame_row(select));
  if (Status done = select.status(); !done) return forward_error(done);
  return rows;
}

Result<std::vector<AttemptRow>> JobStore::attempts(std::int64_t frame) const {
  const std::string sql = std::string(kAttemptColumns) + "WHERE frame = ? ORDER BY attempt";
  Statement select(database_->connection, sql.c_str());
  select.bind(1, frame);
  std::vector<AttemptRow> rows;
  while (select.step()) rows.push_back(attempt_row(select));
  if (Status done = select.status(); !done) return forward_error(done);
  return rows;
}

Result<std::vector<AttemptRow>> JobStore::recent_failures(int most) const {
  const std::string sql = std::string(kAttemptColumns) +
                          "WHERE outcome = 'failed' ORDER BY started DESC, frame DESC LIMIT ?";
  Statement select(database_->connection, sql.c_str());
  select.bind(1, std::int64_t{most});
  std::vector<AttemptRow> rows;
  while (select.step()) rows.push_back(attempt_row(select));
  if (Status done = select.status(); !done) return forward_error(done);
  return rows;
}

Result<TwinSummary> JobStore::twin_summary() const {
  Statement select(
      database_->connection,
      "SELECT count(*), count(CASE WHEN twin_inside_px + twin_edge_px > 0 THEN 1 END), "
      "sum(twin_pixels), sum(twin_inside_px), sum(twin_edge_px) FROM frames "
      "WHERE state = 'done' AND twin_pixels > 0");
  TwinSummary summary;
  if (select.step()) {
    summary.frames = select.integer(0);
    summary.frames_differing = select.integer(1);
    summary.sum = {select.integer(2), select.integer(3), select.integer(4)};
  }
  if (Status done = select.status(); !done) return forward_error(done);
  return summary;
}

Result<std::optional<AttemptTimings>> JobStore::mean_timings(int most) const {
  Statement select(database_->connection,
                   "SELECT count(*), avg(build_s), avg(render_s), avg(finish_s) FROM (SELECT * "
                   "FROM attempts WHERE outcome = 'done' ORDER BY started DESC LIMIT ?)");
  std::optional<AttemptTimings> mean;
  if (select.bind(1, std::int64_t{most}).step() && select.integer(0) > 0) {
    mean = {.build_s = select.real(1), .render_s = select.real(2), .finish_s = select.real(3)};
  }
  if (Status done = select.status(); !done) return forward_error(done);
  return mean;
}

Result<std::string> JobStore::dataset_hash() const {
  Sha256 hash;
  bool complete = true;
  const Status visited = for_each_frame([&](const FrameRow& row) -> Status {
    complete = complete && row.state == FrameState::kDone;
    hash.update(fmt::format("{} {} {}\n", row.frame, row.frame_id, row.pixel_hash));
    return {};
  });
  if (!visited) return forward_error(visited);
  return complete ? hash.hex() : std::string();
}

}  // namespace seedframe
