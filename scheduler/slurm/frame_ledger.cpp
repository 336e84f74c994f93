#include "slurm/frame_ledger.h"

#include <algorithm>
#include <iterator>

namespace seedframe {

void FrameLedger::add(const PendingFrame& frame, std::string frame_id) {
  const std::lock_guard lock(mutex_);
  Entry entry;
  entry.frame_id = std::move(frame_id);
  entry.attempts = frame.attempts_used;
  entry.crashes = frame.crashes;
  if (frames_.emplace(frame.frame, std::move(entry)).second) ++counts_[Place::kFree];
}

void FrameLedger::move(Entry& entry, Place place) {
  --counts_[entry.place];
  ++counts_[place];
  entry.place = place;
}

void FrameLedger::give_out(std::int64_t frame, const BatchId& batch) {
  const std::lock_guard lock(mutex_);
  const auto found = frames_.find(frame);
  if (found == frames_.end() || found->second.place != Place::kFree) return;
  move(found->second, Place::kOut);
  found->second.batch = batch;
}

std::map<int, std::vector<std::int64_t>> FrameLedger::free_frames() const {
  const std::lock_guard lock(mutex_);
  std::map<int, std::vector<std::int64_t>> free;
  for (const auto& [frame, entry] : frames_) {
    if (entry.place == Place::kFree) free[entry.losses].push_back(frame);
  }
  return free;
}

int FrameLedger::crashes(std::int64_t frame) const {
  const std::lock_guard lock(mutex_);
  const auto found = frames_.find(frame);
  return found == frames_.end() ? 0 : found->second.crashes;
}

std::optional<FrameLedger::Taken> FrameLedger::take(std::int64_t frame, int attempts) {
  const std::lock_guard lock(mutex_);
  const auto found = frames_.find(frame);
  if (found == frames_.end()) return std::nullopt;
  Entry& entry = found->second;
  if (entry.place == Place::kSettling || entry.place == Place::kOver) return std::nullopt;
  move(entry, Place::kSettling);
  const int first = entry.attempts + 1;
  entry.attempts += attempts;
  return Taken{entry.frame_id, first};
}

FrameLedger::Lost FrameLedger::lose(std::int64_t frame, bool alone) {
  const std::lock_guard lock(mutex_);
  Entry& entry = frames_.at(frame);
  ++entry.losses;
  if (alone) ++entry.lost_alone;
  if (entry.lost_alone < limits_.crashes) {
    move(entry, Place::kFree);
    return {};
  }
  move(entry, Place::kSettling);
  return {Consequence::kQuarantined, ++entry.attempts};
}

void FrameLedger::give_back(std::int64_t frame) {
  const std::lock_guard lock(mutex_);
  move(frames_.at(frame), Place::kFree);
}

Consequence FrameLedger::refuse(std::int64_t frame) {
  const std::lock_guard lock(mutex_);
  return ++frames_.at(frame).errors < limits_.errors ? Consequence::kRetry : Consequence::kFailed;
}

void FrameLedger::settle_done(std::int64_t frame) {
  const std::lock_guard lock(mutex_);
  move(frames_.at(frame), Place::kOver);
  ++summary_.committed;
}

void FrameLedger::settle_failed(std::int64_t frame, Consequence consequence) {
  const std::lock_guard lock(mutex_);
  if (consequence == Consequence::kRetry) return move(frames_.at(frame), Place::kFree);
  move(frames_.at(frame), Place::kOver);
  ++(consequence == Consequence::kFailed ? summary_.failed : summary_.quarantined);
}

std::vector<std::int64_t> FrameLedger::out_with(const BatchId& batch,
                                                const std::vector<std::int64_t>& frames) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::int64_t> out;
  std::copy_if(frames.begin(), frames.end(), std::back_inserter(out), [&](std::int64_t frame) {
    const auto found = frames_.find(frame);
    return found != frames_.end() && found->second.place == Place::kOut &&
           found->second.batch == batch;
  });
  return out;
}

bool FrameLedger::all_over() const {
  const std::lock_guard lock(mutex_);
  const auto over = counts_.find(Place::kOver);
  return (over == counts_.end() ? 0 : over->second) == static_cast<std::int64_t>(frames_.size());
}

bool FrameLedger::any_settling() const {
  const std::lock_guard lock(mutex_);
  const auto settling = counts_.find(Place::kSettling);
  return settling != counts_.end() && settling->second > 0;
}

std::int64_t FrameLedger::out() const {
  const std::lock_guard lock(mutex_);
  const auto out = counts_.find(Place::kOut);
  return out == counts_.end() ? 0 : out->second;
}

RunSummary FrameLedger::summary() const {
  const std::lock_guard lock(mutex_);
  RunSummary summary = summary_;
  summary.left = static_cast<std::int64_t>(frames_.size()) - summary.committed - summary.failed -
                 summary.quarantined;
  return summary;
}

}  // namespace seedframe
