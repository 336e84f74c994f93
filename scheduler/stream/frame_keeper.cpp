#include "stream/frame_keeper.h"

#include <charconv>

#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/files.h"
#include "campaign/input_files.h"
#include "draws/graphs.h"
#include "export/kept_inputs.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// Of a SHA-256; whoever finds a frame by it compares all of it.
std::uint64_t key_of(const std::string& frame_id) {
  std::uint64_t key = 0;
  std::from_chars(frame_id.data(), frame_id.data() + std::min<std::size_t>(16, frame_id.size()),
                  key, 16);
  return key;
}

/// Whether a stream of the same config has made it.
Status check_same(const Campaign& campaign, const PreparedCampaign& prepared) {
  const std::string folder = campaign.files.root().string();
  const Result<bool> grows = has_own_graphs(campaign);
  if (!grows) return forward_error(grows);
  if (!*grows) {
    return fail(ErrorKind::kInput,
                "--keep {}: this campaign was not made by a stream: give another folder", folder);
  }
  const Result<std::string> text = read_file(campaign.files.config());
  if (!text) return forward_error(text);
  const Result<std::string> overrides = campaign.store.meta(kOverridesKey);
  if (!overrides) return forward_error(overrides);
  if (*text == prepared.source.text && *overrides == overrides_text(prepared.source)) return {};
  return fail(ErrorKind::kInput,
              "--keep {}: its frames are of another config, or were made with other --set: give "
              "another folder",
              folder);
}

Result<LockedCampaign> go_on(const fs::path& folder, const PreparedCampaign& prepared,
                             std::int64_t& pending) {
  Result<Campaign> campaign = open_campaign(folder);
  if (!campaign) return forward_error(campaign);
  Result<FolderLock> lock = FolderLock::acquire(campaign->files.lock());
  if (!lock) return forward_error(lock);
  if (Status same = check_same(*campaign, prepared); !same) return forward_error(same);
  Result<PreparedCampaign> kept = prepare_again(*campaign, prepared.source.home);
  if (!kept) return forward_error(kept);
  if (Status begun = begin_run(*campaign); !begun) return forward_error(begun);
  const auto nobody_asks = [](const RenewedFrames&) { return false; };
  const auto renewed = renew_changed_frames(*campaign, *kept, nobody_asks);
  if (!renewed) return forward_error(renewed);
  const Result<Reconciliation> state = reconcile(*campaign, /*verify=*/false);
  if (!state) return forward_error(state);
  pending = static_cast<std::int64_t>(state->to_render.size());
  return LockedCampaign{std::move(*campaign), std::move(*lock)};
}

Result<LockedCampaign> begin_new(const fs::path& folder, const PreparedCampaign& prepared) {
  Result<LockedCampaign> made = create_campaign(folder, prepared, FirstFrames::kNone);
  if (!made) return made;
  if (Status begun = begin_run(made->campaign); !begun) return forward_error(begun);
  return made;
}

}  // namespace

/// What a transaction has changed that it cannot take back by itself.
struct FrameKeeper::Changes {
  std::int64_t next = 0;  ///< before
  std::uint64_t graph_bytes = 0;
  std::vector<std::string> made_with = {};  ///< of the frames, in order
  std::vector<std::int64_t> numbers = {};
  std::vector<std::uint64_t> new_keys = {};
  std::vector<std::pair<fs::path, fs::path>> moved = {};  ///< from where to where
};

Result<std::unique_ptr<FrameKeeper>> FrameKeeper::open(const fs::path& folder,
                                                       const PreparedCampaign& prepared) {
  if (prepared.settings.labels == LabelSource::kTwin) {
    return fail(ErrorKind::kInput,
                "--keep: rendered frames are kept, and this config renders nothing: leave 'labels: "
                "geometry' out");
  }
  std::error_code missing;
  std::int64_t pending = 0;
  Result<LockedCampaign> campaign = fs::exists(CampaignFiles(folder).store(), missing)
                                        ? go_on(folder, prepared, pending)
                                        : begin_new(folder, prepared);
  if (!campaign) return forward_error(campaign);
  std::unique_ptr<FrameKeeper> keeper(new FrameKeeper(std::move(*campaign), prepared));
  keeper->pending_before_ = pending;
  if (Status looked = keeper->look(); !looked) return forward_error(looked);
  return keeper;
}

FrameKeeper::FrameKeeper(LockedCampaign campaign, const PreparedCampaign& prepared)
    : campaign_(std::move(campaign)),
      prepared_(prepared),
      root_(campaign_.campaign.files.root()),
      thread_([this] { work(); }) {}

FrameKeeper::~FrameKeeper() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  thread_.join();
  std::error_code ignored;
  fs::remove_all(files().work(), ignored);
}

Status FrameKeeper::look() {
  JobStore& store = campaign_.campaign.store;
  Status visited = store.for_each_frame([this](const FrameRow& row) -> Status {
    numbers_.emplace(key_of(row.frame_id), row.frame);
    next_ = row.frame + 1;
    return {};
  });
  if (!visited) return visited;
  frames_before_ = next_;
  const Result<std::string> graphs = read_file(files().graphs(), kMostGraphBytes);
  if (!graphs) return forward_error(graphs);
  graph_bytes_ = graphs->rfind('\n') + 1;  // npos + 1: there is no line
  for (const fs::path& folder : {files().workers(), files().logs(), files().frames()}) {
    if (Status made = make_folders_in(files().root(), folder); !made) return made;
  }
  const Result<KeptInputs> inputs = inputs_of(prepared_);
  if (!inputs) return forward_error(inputs);
  return keep_inputs(files(), *inputs);
}

Status FrameKeeper::begin(RunSetup& setup) {
  const Result<std::uint64_t> bytes = expected_frame_bytes(campaign_.campaign, prepared_.settings);
  if (!bytes) return forward_error(bytes);
  setup.frame_bytes = *bytes;
  room_needed_ = room_for_attempts(setup);
  Result<Provenance> provenance = Provenance::load(files(), prepared_, UsedFiles(), setup);
  if (!provenance) return forward_error(provenance);
  if (Status written = provenance->write(); !written) return written;
  provenance_ = std::move(*provenance);
  return {};
}

Status FrameKeeper::check_room() const {
  return seedframe::check_room(files().root(), room_needed_);
}

Status FrameKeeper::check_disk() const { return seedframe::check_disk(files(), room_needed_); }

void FrameKeeper::keep(FrameToKeep frame) {
  {
    const std::lock_guard lock(mutex_);
    frames_.push_back(std::move(frame));
  }
  changed_.notify_all();
}

void FrameKeeper::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return frames_.empty() && !busy_; });
}

void FrameKeeper::work() {
  pthread_setname_np(pthread_self(), "keeper");  // for whoever looks at what costs time
  while (true) {
    std::vector<FrameToKeep> frames;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return closed_ || !frames_.empty(); });
      if (frames_.empty()) return;
      frames.swap(frames_);
      busy_ = true;
    }
    commit(std::move(frames));
    {
      const std::lock_guard lock(mutex_);
      busy_ = false;
    }
    changed_.notify_all();
  }
}

// ---- A transaction ----

void FrameKeeper::commit(std::vector<FrameToKeep> frames) {
  Changes changes{.next = next_, .graph_bytes = graph_bytes_};
  Status written = root_.check();
  if (written) written = name_makers(frames, changes);
  if (written) {
    written = campaign_.campaign.store.write_together(JobStore::Sync::kNow,
                                                      [&] { return write(frames, changes); });
  }
  if (!written) take_back(changes);
  if (!written && frames.size() > 1) {  // one may be to blame
    for (FrameToKeep& frame : frames) {
      std::vector<FrameToKeep> alone;
      alone.push_back(std::move(frame));
      commit(std::move(alone));
    }
    return;
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::error_code ignored;
    fs::remove_all(frames[i].attempt, ignored);
    if (written) {
      frames[i].done(changes.numbers[i]);
    } else {
      frames[i].done(forward_error(written));
    }
  }
}

Status FrameKeeper::name_makers(const std::vector<FrameToKeep>& frames, Changes& changes) {
  for (const FrameToKeep& frame : frames) {
    if (Status added = provenance_->add_inputs(frame.used); !added) return added;
    Result<std::string> made_with = provenance_->of_worker(frame.made_by);
    if (!made_with) return forward_error(made_with);
    changes.made_with.push_back(std::move(*made_with));
  }
  return {};
}

/// Lines are on the disk before any folder has a frame's name, so that whatever has one is known by
/// its line, should we be killed here.
Status FrameKeeper::write(const std::vector<FrameToKeep>& frames, Changes& changes) {
  if (Status added = add_rows(frames, changes); !added) return added;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (Status done = put(frames[i], i, changes); !done) return done;
  }
  return sync_filesystem(files().frames());
}

Status FrameKeeper::add_rows(const std::vector<FrameToKeep>& frames, Changes& changes) {
  std::string lines;
  std::vector<FrameRow> rows;
  for (const FrameToKeep& frame : frames) {
    const auto known = number_of(frame.frame_id);
    if (!known) return forward_error(known);
    changes.numbers.push_back(*known ? **known : next_);
    if (*known) continue;
    if (next_ == static_cast<std::int64_t>(kMostGraphs) ||
        graph_bytes_ + lines.size() + frame.graph.size() >= kMostGraphBytes) {
      return fail(ErrorKind::kInput, "{} is full: keep further frames in another folder",
                  files().graphs().string());
    }
    lines += frame.graph + "\n";
    FrameRow row;
    row.frame = row.scene = next_++;
    row.frame_id = frame.frame_id;
    rows.push_back(std::move(row));
    const std::uint64_t key = key_of(frame.frame_id);
    if (numbers_.emplace(key, rows.back().frame).second) changes.new_keys.push_back(key);
  }
  if (rows.empty()) return {};
  auto next = rows.begin();
  const Status added =
      campaign_.campaign.store.add_frames([&]() -> Result<std::optional<FrameRow>> {
        if (next == rows.end()) return std::nullopt;
        return *next++;
      });
  return added ? append(lines) : added;
}

Result<std::optional<std::int64_t>> FrameKeeper::number_of(const std::string& frame_id) const {
  const auto found = numbers_.find(key_of(frame_id));
  if (found == numbers_.end()) return std::nullopt;
  const auto row = campaign_.campaign.store.frame(found->second);
  if (!row) return forward_error(row);
  // A row that was only just thought of is this frame's: the ids of two are never alike.
  if (*row && (*row)->frame_id != frame_id) return std::nullopt;
  return found->second;
}

Status FrameKeeper::put(const FrameToKeep& frame, std::size_t index, Changes& changes) {
  JobStore& store = campaign_.campaign.store;
  const std::int64_t number = changes.numbers[index];
  const auto row = store.frame(number);
  if (!row) return forward_error(row);
  if ((*row)->state == FrameState::kDone) return {};
  int attempt = (*row)->attempts;
  for (const AttemptFailure& failure : frame.failures) {
    const auto outcome =
        failure.failure == Failure::kCrash ? AttemptOutcome::kCrash : AttemptOutcome::kError;
    Status told =
        store.attempt_failed(number, ++attempt, outcome, FrameState::kPending, failure.message);
    if (!told) return told;
  }
  Status started = store.attempt_started(number, ++attempt, frame.worker, frame.started,
                                         changes.made_with[index]);
  if (!started) return started;
  const Result<std::string> fingerprint = put_into_place(files(), frame.attempt, number);
  if (!fingerprint) return forward_error(fingerprint);
  changes.moved.emplace_back(frame.attempt, files().frame(number));
  return store.frame_done(number, attempt,
                          {frame.finished.pixel_hash, *fingerprint, frame.finished.twin},
                          frame.timings);
}

Status FrameKeeper::append(const std::string& lines) {
  const fs::path path = files().graphs();
  const int file = ::open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return system_failure("open", path, errno);
  const auto end = static_cast<off_t>(graph_bytes_);
  // What a transaction left that failed goes first: after a crash no line may be half of two.
  Status written;
  if (::ftruncate(file, end) != 0) written = system_failure("write", path, errno);
  for (std::size_t done = 0; written && done < lines.size();) {
    const ssize_t bytes =
        ::pwrite(file, lines.data() + done, lines.size() - done, end + static_cast<off_t>(done));
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) written = system_failure("write", path, errno);
    if (bytes > 0) done += static_cast<std::size_t>(bytes);
  }
  if (written && ::fdatasync(file) != 0) written = system_failure("write", path, errno);
  ::close(file);
  if (written) graph_bytes_ += lines.size();
  return written;
}

void FrameKeeper::take_back(const Changes& changes) {
  std::error_code error;
  for (const auto& [from, to] : changes.moved) fs::rename(to, from, error);
  for (const std::uint64_t key : changes.new_keys) numbers_.erase(key);
  next_ = changes.next;
  graph_bytes_ = changes.graph_bytes;
  if (root_.check()) fs::resize_file(files().graphs(), graph_bytes_, error);
}

}  // namespace seedframe
