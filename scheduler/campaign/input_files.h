// Which files a campaign's frames depend on, and whether they have changed since it was submitted.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "campaign/campaign.h"

namespace seedframe {

/// Every file that frames may depend on, by absolute path, with its size and time of modification
/// (of the config and its overrides: a hash); also this program. All files in asset and material
/// folders count. Empty when there are too many to look at.
using InputStamps = std::map<std::string, std::string>;
InputStamps input_stamps(const PreparedCampaign& prepared);

/// What of `now` is not in `before` as it is, and the other way round.
std::vector<std::string> changed_inputs(const InputStamps& before, const InputStamps& now);

/// The same between the campaign's submission (or its last renewal) and now.
Result<std::vector<std::string>> inputs_changed_since(const Campaign& campaign,
                                                      const PreparedCampaign& prepared);

struct RenewedFrames {
  std::int64_t frames = 0;          ///< that would come out as other ones
  std::int64_t finished = 0;        ///< of them
  std::int64_t added = 0;           ///< that the config asks for beyond those that there are
  std::vector<std::string> inputs;  ///< that have changed
  UsedFiles used;                   ///< by every frame, if they were expanded
};

/// Gives frames that would come out as other ones, since an input has changed, their new identity:
/// they are to be rendered again; so are those whose picture the config wants in another file now.
/// Frames that the config asks for beyond those that there are become part of the campaign, and
/// what was set with --set is remembered. Looks at the stamps first, and expands every frame only
/// when they differ. `may_replace` is asked before anything is written if finished frames would go.
/// kInput errors: it may not; fewer frames; more of them where `quality` chose what they are
/// rendered with; frames that would change though no input has, so that the program itself must
/// have.
Result<RenewedFrames> renew_changed_frames(
    Campaign& campaign, PreparedCampaign& prepared,
    const std::function<bool(const RenewedFrames&)>& may_replace);

struct HealedRows {
  std::vector<std::int64_t> lost;   ///< frames that the store had no row of
  std::vector<std::int64_t> wrong;  ///< frames whose id was not what the campaign makes of them
};

/// Expands every frame, however unchanged the inputs are, and gives the store the rows that it
/// should have: the frames are pending then, and done again if reconcile() finds them on the disk.
/// kInput error: a finished frame's own files agree with its row, so that this program (or a
/// library) must be another one; nothing is changed. kCorrupt: rows of frames that there are not.
Result<HealedRows> heal_rows(Campaign& campaign, const PreparedCampaign& prepared);

/// Of the files that frames depend on, those that are not as they were, this program left aside.
/// Does not see files that are new.
Result<std::vector<std::string>> inputs_touched(const Campaign& campaign);

}  // namespace seedframe
