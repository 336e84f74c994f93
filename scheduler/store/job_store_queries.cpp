// What can be asked of a job store.
#include <algorithm>
#include <array>

#include "base/sha256.h"
#include "store/job_store_database.h"

namespace seedframe {
namespace {

using sqlite::Statement;

constexpr std::array<const char*, 5> kStateNames = {"pending", "running", "done", "failed",
                                                    "quarantined"};
constexpr std::array<const char*, 5> kOutcomeNames = {"running", "done", "error", "crash", "lost"};

constexpr const char* kFrameColumns =
    "SELECT frame, scene, frame_id, state, attempts, crashes, pixel_hash, fingerprint, error, "
    "twin_pixels, twin_inside_px, twin_edge_px FROM frames ";

/// Empty for a word that no version of this program writes.
template <class Enum, std::size_t N>
std::optional<Enum> value_named(const std::string& name, const std::array<const char*, N>& names) {
  for (std::size_t i = 0; i < N; ++i) {
    if (name == names[i]) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

tl::unexpected<Error> damaged(const sqlite::Connection& connection) {
  return fail(ErrorKind::kCorrupt,
              "the job store {} is damaged: it holds a state that Seedframe never writes. What is "
              "in frames/ "
              "is untouched; submit the campaign again, or restore the store from a copy",
              connection.path().string());
}

std::int64_t& count_of(FrameCounts& counts, FrameState state) {
  switch (state) {
    case FrameState::kPending:
      return counts.pending;
    case FrameState::kRunning:
      return counts.running;
    case FrameState::kDone:
      return counts.done;
    case FrameState::kFailed:
      return counts.failed;
    case FrameState::kQuarantined:
      break;
  }
  return counts.quarantined;
}

Result<FrameRow> frame_row(const Statement& row, const sqlite::Connection& connection) {
  const auto state = value_named<FrameState>(row.text(3), kStateNames);
  if (!state) return damaged(connection);
  FrameRow frame;
  frame.frame = row.integer(0);
  frame.scene = row.integer(1);
  frame.frame_id = row.text(2);
  frame.state = *state;
  frame.attempts = static_cast<int>(row.integer(4));
  frame.crashes = static_cast<int>(row.integer(5));
  frame.pixel_hash = row.text(6);
  frame.fingerprint = row.text(7);
  frame.error = row.text(8);
  frame.twin = {row.integer(9), row.integer(10), row.integer(11)};
  return frame;
}

/// All rows that a statement has left.
Result<std::vector<FrameRow>> frame_rows(Statement& select, const sqlite::Connection& connection) {
  std::vector<FrameRow> rows;
  while (select.step()) {
    Result<FrameRow> row = frame_row(select, connection);
    if (!row) return forward_error(row);
    rows.push_back(std::move(*row));
  }
  if (Status done = select.status(); !done) return forward_error(done);
  return rows;
}

constexpr const char* kAttemptColumns =
    "SELECT frame, attempt, worker, outcome, started, build_s, render_s, finish_s, message, "
    "coalesce(json, '') FROM attempts LEFT JOIN provenances USING (provenance) ";

AttemptRow attempt_row(const Statement& row) {
  return {
      .frame = row.integer(0),
      .attempt = static_cast<int>(row.integer(1)),
      .worker = static_cast<int>(row.integer(2)),
      .outcome =
          value_named<AttemptOutcome>(row.text(3), kOutcomeNames).value_or(AttemptOutcome::kLost),
      .started = row.real(4),
      .build_s = row.real(5),
      .render_s = row.real(6),
      .finish_s = row.real(7),
      .message = row.text(8),
      .provenance = row.text(9)};
}

/// Whose outcome is that, newest first.
Result<std::vector<AttemptRow>> newest_attempts(const sqlite::Connection& connection,
                                                const char* outcome, int most) {
  const std::string sql = std::string(kAttemptColumns) + "WHERE outcome " + outcome +
                          " ORDER BY started DESC, frame DESC LIMIT ?";
  Statement select(connection, sql.c_str());
  select.bind(1, std::int64_t{most});
  std::vector<AttemptRow> rows;
  while (select.step()) rows.push_back(attempt_row(select));
  if (Status done = select.status(); !done) return forward_error(done);
  return rows;
}

Status hash_frames(const JobStore& store, DatasetHasher& hasher) {
  return store.for_each_frame([&](const FrameRow& row) -> Status {
    const bool done = row.state == FrameState::kDone;
    hasher.add(row.scene, row.frame, row.frame_id, done ? row.pixel_hash : std::string());
    return {};
  });
}

}  // namespace

const char* to_string(FrameState state) { return kStateNames[static_cast<std::size_t>(state)]; }
const char* to_string(AttemptOutcome outcome) {
  return kOutcomeNames[static_cast<std::size_t>(outcome)];
}

Result<std::string> JobStore::meta(const std::string& key) const {
  Statement select(database_->connection, "SELECT value, sha256 FROM meta WHERE key = ?");
  const bool found = select.bind(1, key).step();
  std::string value = found ? select.text(0) : std::string();
  // Of all that is in here, nothing else would notice if the disk altered these.
  const bool whole = !found || select.text(1) == sha256_hex(value);
  if (Status done = select.status(); !done) return forward_error(done);
  if (!whole) {
    return fail(ErrorKind::kCorrupt, "{} is damaged: its '{}' is not what was written there",
                database_->connection.path().string(), key);
  }
  return value;
}

Result<bool> JobStore::is_under_way(std::int64_t frame, int attempt) const {
  Statement select(database_->connection,
                   "SELECT 1 FROM frames WHERE frame = ? AND attempts = ? AND state = 'running'");
  const bool found = select.bind(1, frame).bind(2, std::int64_t{attempt}).step();
  if (Status done = select.status(); !done) return forward_error(done);
  return found;
}

Status JobStore::check_integrity() const {
  Statement check(database_->connection, "PRAGMA integrity_check(1)");
  const std::string found = check.step() ? check.text(0) : std::string();
  if (Status done = check.status(); !done) return done;
  if (found == "ok") return {};
  return fail(ErrorKind::kCorrupt,
              "the job store {} is damaged ({}). What is in frames/ is untouched; submit the "
              "campaign again, or restore the store from a copy",
              database_->connection.path().string(), found);
}

Result<FrameCounts> JobStore::counts() const {
  Statement select(database_->connection, "SELECT state, count(*) FROM frames GROUP BY state");
  FrameCounts counts;
  while (select.step()) {
    const auto state = value_named<FrameState>(select.text(0), kStateNames);
    if (!state) return damaged(database_->connection);
    count_of(counts, *state) = select.integer(1);
  }
  if (Status done = select.status(); !done) return forward_error(done);
  return counts;
}

Result<std::optional<FrameRow>> JobStore::frame(std::int64_t frame) const {
  const std::string sql = std::string(kFrameColumns) + "WHERE frame = ?";
  Statement select(database_->connection, sql.c_str());
  auto rows = frame_rows(select.bind(1, frame), database_->connection);
  if (!rows) return forward_error(rows);
  return rows->empty() ? std::optional<FrameRow>() : std::move(rows->front());
}

Status JobStore::for_each_frame(const std::function<Status(const FrameRow&)>& visit) const {
  const std::string sql = std::string(kFrameColumns) + "ORDER BY frame";
  Statement select(database_->connection, sql.c_str());
  while (select.step()) {
    const Result<FrameRow> row = frame_row(select, database_->connection);
    if (!row) return forward_error(row);
    if (Status done = visit(*row); !done) return done;
  }
  return select.status();
}

Result<std::vector<FrameRow>> JobStore::frames_from(std::int64_t first, int most) const {
  const std::string sql = std::string(kFrameColumns) + "WHERE frame >= ? ORDER BY frame LIMIT ?";
  Statement select(database_->connection, sql.c_str());
  select.bind(1, first).bind(2, std::int64_t{most});
  return frame_rows(select, database_->connection);
}

Result<std::vector<FrameRow>> JobStore::frames_in(FrameState state, int most) const {
  const std::string sql = std::string(kFrameColumns) + "WHERE state = ? ORDER BY frame LIMIT ?";
  Statement select(database_->connection, sql.c_str());
  select.bind(1, std::string(to_string(state))).bind(2, std::int64_t{most});
  return frame_rows(select, database_->connection);
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

Status JobStore::for_each_attempt(const std::function<Status(const AttemptRow&)>& visit) const {
  const std::string sql = std::string(kAttemptColumns) + "ORDER BY frame, attempt";
  Statement select(database_->connection, sql.c_str());
  while (select.step()) {
    if (Status done = visit(attempt_row(select)); !done) return done;
  }
  return select.status();
}

Result<std::vector<std::string>> JobStore::provenances() const {
  Statement select(database_->connection, "SELECT json FROM provenances ORDER BY provenance");
  std::vector<std::string> texts;
  while (select.step()) texts.push_back(select.text(0));
  if (Status done = select.status(); !done) return forward_error(done);
  return texts;
}

Result<std::vector<std::int64_t>> JobStore::done_by_worker_before(const AttemptRow& attempt,
                                                                  int most) const {
  Statement select(
      database_->connection,
      "SELECT frame FROM attempts WHERE worker = ? AND outcome = 'done' AND started < ? "
      "ORDER BY started DESC LIMIT ?");
  select.bind(1, std::int64_t{attempt.worker}).bind(2, attempt.started).bind(3, std::int64_t{most});
  std::vector<std::int64_t> frames;
  if (attempt.worker == kNoWorker) return frames;
  while (select.step()) frames.insert(frames.begin(), select.integer(0));
  if (Status done = select.status(); !done) return forward_error(done);
  return frames;
}

Result<std::vector<AttemptRow>> JobStore::recent_failures(int most) const {
  return newest_attempts(database_->connection, "IN ('error', 'crash')", most);
}

Result<std::vector<AttemptRow>> JobStore::recent_done(int most) const {
  return newest_attempts(database_->connection, "= 'done'", most);
}

Result<std::int64_t> JobStore::data_version() const {
  Statement select(database_->connection, "PRAGMA data_version");
  const std::int64_t version = select.step() ? select.integer(0) : 0;
  if (Status done = select.status(); !done) return forward_error(done);
  return version;
}

Result<std::optional<std::int64_t>> JobStore::last_process() const {
  Statement select(database_->connection, "SELECT process FROM runs ORDER BY run DESC LIMIT 1");
  std::optional<std::int64_t> process;
  if (select.step()) process = select.integer(0);
  if (Status done = select.status(); !done) return forward_error(done);
  return process;
}

Result<RunProgress> JobStore::run_progress() const {
  RunProgress progress;
  Statement ended(database_->connection,
                  "SELECT worker, count(CASE WHEN outcome = 'done' THEN 1 END), "
                  "count(CASE WHEN outcome IN ('error', 'crash') THEN 1 END), "
                  "avg(CASE WHEN outcome = 'done' THEN build_s + render_s END), min(started) "
                  "FROM attempts WHERE run = (SELECT max(run) FROM runs) AND worker >= 0 "
                  "GROUP BY worker ORDER BY worker");
  while (ended.step()) {
    WorkerRow& row = progress.workers.emplace_back();
    row.worker = static_cast<int>(ended.integer(0));
    row.done = ended.integer(1);
    row.failed = ended.integer(2);
    row.frame_s = ended.real(3);
    progress.done += row.done;
    const double started = ended.real(4);
    progress.began = progress.began == 0.0 ? started : std::min(progress.began, started);
  }
  if (Status done = ended.status(); !done) return forward_error(done);
  Statement running(database_->connection,
                    "SELECT worker, frame, started FROM attempts WHERE outcome = 'running' AND "
                    "run = (SELECT max(run) FROM runs) ORDER BY started DESC, frame DESC");
  while (running.step()) {
    for (WorkerRow& row : progress.workers) {
      if (row.worker != running.integer(0)) continue;
      row.frame = running.integer(1);
      row.since = running.real(2);
    }
  }
  if (Status done = running.status(); !done) return forward_error(done);
  return progress;
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
  Statement select(
      database_->connection,
      "SELECT count(*), avg(build_s), avg(render_s), avg(finish_s) FROM (SELECT * "
      "FROM attempts WHERE outcome = 'done' AND worker >= 0 ORDER BY started DESC LIMIT ?)");
  std::optional<AttemptTimings> mean;
  if (select.bind(1, std::int64_t{most}).step() && select.integer(0) > 0) {
    mean = {.build_s = select.real(1), .render_s = select.real(2), .finish_s = select.real(3)};
  }
  if (Status done = select.status(); !done) return forward_error(done);
  return mean;
}

Result<std::string> JobStore::dataset_hash() const {
  const Result<FrameCounts> frames = counts();
  if (!frames) return forward_error(frames);
  if (frames->done < frames->total()) return std::string();
  DatasetHasher hasher;
  if (Status hashed = hash_frames(*this, hasher); !hashed) return forward_error(hashed);
  return hasher.close();
}

Result<std::vector<SceneHash>> JobStore::scene_hashes() const {
  std::vector<SceneHash> scenes;
  DatasetHasher hasher([&](const SceneHash& scene) { scenes.push_back(scene); });
  if (Status hashed = hash_frames(*this, hasher); !hashed) return forward_error(hashed);
  (void)hasher.close();
  return scenes;
}

}  // namespace seedframe
