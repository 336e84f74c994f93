// Ctrl-C and the like end a run in good order.
#pragma once

#include <csignal>

namespace seedframe {

class CampaignRunner;

/// While this lives, SIGINT and SIGTERM drain the runner. One at a time.
class DrainOnSignals {
 public:
  explicit DrainOnSignals(CampaignRunner& runner);
  ~DrainOnSignals();
  DrainOnSignals(const DrainOnSignals&) = delete;
  DrainOnSignals& operator=(const DrainOnSignals&) = delete;

 private:
  struct sigaction interrupt_ = {};
  struct sigaction terminate_ = {};
};

}  // namespace seedframe
