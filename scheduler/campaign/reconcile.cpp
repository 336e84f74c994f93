// Makes a campaign's store and its disk agree; declared in campaign.h.

#include <tbb/parallel_for.h>

#include "campaign/campaign.h"
#include "frames/frame_fingerprint.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// What reconcile has to change in the store, found while reading it.
struct Changes {
  std::vector<std::pair<std::int64_t, FrameResult>> adopted;
  std::vector<std::pair<std::int64_t, std::string>> fingerprints;
  std::vector<std::int64_t> invalid;
};

struct ReconcileWishes {
  ImageEncoding pictures;
  bool verify = false;
};

FrameResult result_of(const Manifest& manifest, std::string fingerprint) {
  return {manifest.pixel_hash(), std::move(fingerprint), manifest.twin};
}

/// The manifest of a frame all of whose files are there, and as they should be.
Result<Manifest> complete_frame(const fs::path& folder, const FrameRow& row,
                                const ImageEncoding& pictures) {
  Result<Manifest> manifest = verify_frame(folder, row.frame_id, VerifyDepth::kContents);
  if (!manifest || manifest->picture_is(pictures)) return manifest;
  return fail(ErrorKind::kCorrupt, "{}: its picture is {}, and the campaign wants {}",
              folder.string(), describe(manifest->image), describe(pictures));
}

/// Whether a frame that the store calls done is so.
bool is_still_done(const FrameRow& row, const fs::path& folder, const std::string& fingerprint,
                   const ReconcileWishes& wishes, Changes& changes, Reconciliation& result) {
  const bool untouched = !fingerprint.empty() && fingerprint == row.fingerprint;
  if (untouched && !wishes.verify) return true;
  const Result<Manifest> manifest = complete_frame(folder, row, wishes.pictures);
  if (manifest && manifest->pixel_hash() == row.pixel_hash) {
    if (!untouched) changes.fingerprints.emplace_back(row.frame, fingerprint);
    return true;
  }
  result.invalid.push_back(manifest ? folder.string() + ": its pixel hash is not the store's"
                                    : manifest.error().message);
  changes.invalid.push_back(row.frame);
  return false;
}

/// `fingerprint` is of the frame's folder, empty if there is none.
void reconcile_frame(const FrameRow& row, const fs::path& folder, const std::string& fingerprint,
                     const ReconcileWishes& wishes, Changes& changes, Reconciliation& result) {
  if (row.state == FrameState::kDone) {
    if (is_still_done(row, folder, fingerprint, wishes, changes, result)) {
      ++result.already_done;
      return;
    }
  } else if (!fingerprint.empty()) {
    // What the store did not see being committed is believed only after reading all of it.
    const auto manifest = complete_frame(folder, row, wishes.pictures);
    if (manifest) {
      changes.adopted.emplace_back(row.frame, result_of(*manifest, fingerprint));
      return;
    }
  }
  if (row.state == FrameState::kQuarantined) {
    ++result.quarantined;
  } else {
    result.to_render.push_back({row.frame, row.attempts, row.crashes});
  }
}

Status apply(const Changes& changes, JobStore& store) {
  return store.write_together(JobStore::Sync::kNow, [&]() -> Status {
    for (const auto& [frame, result] : changes.adopted) {
      if (Status done = store.adopt(frame, result); !done) return done;
    }
    for (const auto& [frame, fingerprint] : changes.fingerprints) {
      if (Status done = store.set_fingerprint(frame, fingerprint); !done) return done;
    }
    for (const std::int64_t frame : changes.invalid) {
      if (Status done = store.reset(frame); !done) return done;
    }
    return {};
  });
}

}  // namespace

Result<Reconciliation> reconcile(Campaign& campaign, bool verify) {
  const Result<ImageEncoding> pictures = wanted_encoding(campaign);
  if (!pictures) return forward_error(pictures);
  const ReconcileWishes wishes{*pictures, verify};
  std::error_code error;
  fs::remove_all(campaign.files.work(), error);
  Reconciliation result;
  Changes changes;
  constexpr int kBatch = 4096;
  std::vector<std::string> fingerprints(kBatch);
  for (std::int64_t first = 0;;) {
    const auto rows = campaign.store.frames_from(first, kBatch);
    if (!rows) return forward_error(rows);
    if (rows->empty()) break;
    // Looking at a million small files is what takes the time.
    tbb::parallel_for(std::size_t{0}, rows->size(), [&](std::size_t i) {
      fingerprints[i] = frame_fingerprint(campaign.files.frame((*rows)[i].frame));
    });
    for (std::size_t i = 0; i < rows->size(); ++i) {
      const FrameRow& row = (*rows)[i];
      reconcile_frame(row, campaign.files.frame(row.frame), fingerprints[i], wishes, changes,
                      result);
    }
    first = rows->back().frame + 1;
  }
  if (Status applied = apply(changes, campaign.store); !applied) return forward_error(applied);
  result.adopted = static_cast<std::int64_t>(changes.adopted.size());
  return result;
}

}  // namespace seedframe
