#include "campaign/make_run.h"

#include "campaign/label_run.h"
#include "campaign/render_run.h"

namespace seedframe {

std::unique_ptr<CampaignRun> make_run(Campaign& campaign, const PreparedCampaign& prepared,
                                      Provenance& provenance, const RunSetup& setup,
                                      RunObserver& observer) {
  if (!setup.color) {
    return std::make_unique<LabelRun>(campaign, prepared, provenance, setup, observer);
  }
  return std::make_unique<RenderRun>(campaign, prepared, provenance, setup, observer);
}

}  // namespace seedframe
