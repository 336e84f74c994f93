// A campaign on disk: its folder, its store, and the config it was made from.
#pragma once

#include <filesystem>
#include <vector>

#include "base/error.h"
#include "base/folder_lock.h"
#include "frames/campaign_files.h"
#include "frames/manifest.h"
#include "render/frame_job.h"
#include "scene/prepared_campaign.h"
#include "store/job_store.h"

namespace seedframe {

struct Campaign {
  CampaignFiles files;
  JobStore store;
};

/// A campaign that no other process may work on.
struct LockedCampaign {
  Campaign campaign;
  FolderLock lock;
};

/// Whether create_campaign could begin there now; see there.
Status check_new_campaign(const std::filesystem::path& folder);

/// Which frames a new campaign has.
enum class FirstFrames {
  kAll,   ///< those of its config
  kNone,  ///< they come later, each with a line in the campaign's own graphs
};

/// Makes the folder, campaign.yaml and the store with every frame pending, and locks it. The folder
/// must not exist, or be empty but for what a submission left that was killed (kInput). Every frame
/// is expanded on its way into the store, so memory does not grow with their number. The store gets
/// its name last: until then there is no campaign. A folder that was made here goes again when
/// something fails.
Result<LockedCampaign> create_campaign(const std::filesystem::path& folder,
                                       const PreparedCampaign& prepared,
                                       FirstFrames first = FirstFrames::kAll);

/// A campaign of just these frames of another one, to be run and thrown away: without
/// campaign.yaml, and its run has begun. `folder` becomes new. `used` takes what the frames were
/// drawn from.
Result<Campaign> create_scratch_campaign(const std::filesystem::path& folder,
                                         const std::vector<std::int64_t>& frames,
                                         const PreparedCampaign& prepared, UsedFiles& used);

/// Key in the store's meta: InputStamps of the frames' identities, as JSON (input_files.h).
inline constexpr const char* kInputsKey = "inputs";

/// Key in the store's meta: what was given with --set, as JSON.
inline constexpr const char* kOverridesKey = "overrides";
std::string overrides_text(const CampaignSource& source);

/// Expands the frames from `first` to the last on their way into the store.
Status add_frames_from(std::int64_t first, const PreparedCampaign& prepared, JobStore& store);

/// Key in the store's meta: what frames are rendered with, where the config wants that chosen
/// (RenderChoices as JSON).
inline constexpr const char* kChoicesKey = "choices";

/// Key in the store's meta: how wrong frames may be (QualityWish as JSON); empty: nothing is said.
inline constexpr const char* kQualityKey = "quality";
std::string quality_text(const CampaignSettings& settings);

/// Key in the store's meta: how the pictures of all frames that are done are encoded, as JSON.
inline constexpr const char* kEncodingKey = "image";
/// What is there; PNG in a store from before there was a choice.
Result<ImageEncoding> wanted_encoding(const Campaign& campaign);

/// Opens what create_campaign made. Not a campaign, or damaged: an error that says so.
Result<Campaign> open_campaign(const std::filesystem::path& folder);

/// The source that the campaign was made from: its own campaign.yaml, and from the store the
/// overrides, the folder at which relative paths start, and the folders that were allowed; besides
/// these, `allowed` are.
Result<CampaignSource> source_of(const Campaign& campaign, const std::filesystem::path& home,
                                 const std::vector<std::string>& allowed = {});

/// Whether its frames are those of its own graphs (CampaignFiles::graphs), and may become more.
Result<bool> has_own_graphs(const Campaign& campaign);

/// prepare() of that source, with `more` set. Its errors tell places by the name that the config
/// was submitted under; a line about the campaign's copy follows.
Result<PreparedCampaign> prepare_again(const Campaign& campaign, const std::filesystem::path& home,
                                       const std::vector<std::string>& allowed = {},
                                       const std::vector<Override>& more = {});

struct Reconciliation {
  std::vector<PendingFrame> to_render;  ///< in order
  std::int64_t already_done = 0;
  std::int64_t adopted = 0;  ///< complete on disk though the store did not know
  std::int64_t quarantined = 0;
  std::vector<std::string> invalid;  ///< why frames that were done must be rendered again
};

/// From here on the campaign is ours (JobStore::begin_run).
Status begin_run(Campaign& campaign);

/// Makes store and disk agree, as a scheduler does when it starts: what is done and untouched
/// (frame_fingerprint.h) stays, what lies complete in its final folder is taken over, all else is
/// to be rendered, but for frames in quarantine; scratch folders are removed. A frame with a
/// picture that is not encoded as wanted_encoding says is not complete. With `verify`, every file
/// is read, however untouched it looks.
Result<Reconciliation> reconcile(Campaign& campaign, bool verify);

/// "seedframe resume DIR --frame N --workers 1".
std::string command_to_reproduce(const std::filesystem::path& folder, std::int64_t frame);

}  // namespace seedframe
