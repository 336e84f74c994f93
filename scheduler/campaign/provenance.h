// With what frames were made. Of an attempt: all that may decide over its pixels beside the frame
// spec. Of a campaign, provenance.json: its inputs, and what its attempts were made with. No time,
// host or absolute path (docs/formats/campaign.md).
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/error.h"
#include "campaign/campaign.h"
#include "campaign/run_options.h"
#include "render/message.h"

namespace seedframe {

/// What the libraries say of themselves: name to version.
Json library_versions();

/// Name to SHA-256, as in provenance.json. That of an image is its folder's and its own.
std::map<std::string, std::string> asset_hashes(const UsedFiles& used);
std::map<std::string, std::string> image_hashes(const UsedFiles& used);

class Provenance {
 public:
  /// Starts from what an earlier run wrote, if there is any. `used`: by the frames that were
  /// expanded for this run.
  static Result<Provenance> load(const CampaignFiles& files, const PreparedCampaign& prepared,
                                 const UsedFiles& used, const RunSetup& setup);

  /// What is the same for all attempts of this run, known before any worker starts.
  const Json& common() const { return common_; }
  /// Of attempts of this worker: canonical JSON.
  std::string text_of_worker(const ReadyMessage& ready) const;
  /// The same; it goes into provenance.json if it is new.
  Result<std::string> of_worker(const ReadyMessage& ready);
  /// Of attempts that another machine has made, as its Provenance tells it. kCorrupt: it does not.
  Result<std::string> of_record(const std::string& attempt);
  /// What a further frame was drawn from; provenance.json has what is new of it.
  Status add_inputs(const UsedFiles& used);
  /// A sentence, if the campaign's earlier runs were made with others, so that pixels may differ.
  std::string departure(const std::string& attempt) const;
  /// Of attempts without a worker.
  Result<std::string> of_twin();
  Status write() const;

 private:
  Provenance(std::filesystem::path path, Json json, Json common)
      : path_(std::move(path)),
        json_(std::move(json)),
        earlier_(json_["attempts"]),
        common_(std::move(common)) {}
  Json json_of_worker(const ReadyMessage& ready) const;
  Result<std::string> add(Json attempt);

  std::filesystem::path path_;
  Json json_;
  Json earlier_;  ///< attempts of earlier runs
  Json common_;   ///< to all attempts of this run
};

/// What two provenances of attempts differ in, but for threads, which change no pixel:
/// "kernel avx instead of avx2, …"; empty if in nothing else.
std::string describe_difference(const Json& found, const Json& expected);

}  // namespace seedframe
