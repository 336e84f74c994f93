#include "campaign/make_run.h"

#include "campaign/label_run.h"
#include "campaign/render_run.h"

namespace seedframe {

std::unique_ptr<CampaignRun> make_run(Campaign& campaign, PreparedCampaign& prepared,
                                      const ColorManagement* color, Provenance& provenance,
                                      const RunOptions& options, RunObserver& observer) {
  if (color == nullptr) {
    return std::make_unique<LabelRun>(campaign, prepared, provenance, options, observer);
  }
  return std::make_unique<RenderRun>(campaign, prepared, *color, provenance, options, observer);
}

}  // namespace seedframe
