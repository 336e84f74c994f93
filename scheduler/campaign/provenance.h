// provenance.json: with what a campaign was rendered. No time, host or absolute path.
#pragma once

#include <string>

#include "base/error.h"
#include "campaign/campaign.h"
#include "render/message.h"

namespace seedframe {

/// What the libraries say of themselves: name to version.
Json library_versions();

class Provenance {
 public:
  /// Starts from what an earlier run wrote, if there is any.
  static Result<Provenance> load(const CampaignFiles& files, const PreparedCampaign& prepared,
                                 const std::string& ocio_hash);

  /// Each distinct kind of worker is listed once.
  Status add_worker(const ReadyMessage& ready);
  Status write() const;

 private:
  Provenance(std::filesystem::path path, Json json)
      : path_(std::move(path)), json_(std::move(json)) {}

  std::filesystem::path path_;
  Json json_;
};

}  // namespace seedframe
