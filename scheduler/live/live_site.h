// The pages of a server: from a request to an answer, without any socket.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <vector>

#include "base/error.h"
#include "live/gate.h"
#include "live/http.h"
#include "live/live_campaign.h"
#include "live/run_control.h"

namespace seedframe {

/// Answers to what the gate lets in, and to nothing but:
///
///   GET  /                       the campaign's page, or a list of several
///   GET  /c/0/                   a campaign's page
///   GET  /c/0/live               how far it is, as JSON
///   GET  /c/0/thumbnail/12       a frame's picture, as WebP
///   POST /c/0/pause, /c/0/resume, /c/0/retry/12
///
/// A GET changes nothing. Safe to use from several threads.
class LiveSite {
 public:
  /// `control` must outlive it.
  static Result<std::unique_ptr<LiveSite>> open(const std::vector<std::filesystem::path>& folders,
                                                const std::filesystem::path& home, Gate gate,
                                                RunControl& control, const LiveClock& clock);

  HttpResponse answer(const HttpRequest& request);

 private:
  struct Shown {
    std::mutex mutex;
    std::unique_ptr<LiveCampaign> campaign;
  };
  LiveSite(Gate gate, RunControl& control) : gate_(std::move(gate)), control_(control) {}
  HttpResponse route(const HttpRequest& request);
  HttpResponse list();
  HttpResponse of_campaign(std::size_t number, const std::string& rest, bool posts);
  Json others(std::size_t number) const;

  Gate gate_;
  RunControl& control_;
  std::mutex control_mutex_;
  std::vector<std::unique_ptr<Shown>> shown_;
};

}  // namespace seedframe
