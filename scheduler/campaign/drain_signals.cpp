#include "campaign/drain_signals.h"

#include <atomic>

#include "campaign/campaign_runner.h"

namespace seedframe {
namespace {

std::atomic<CampaignRunner*> g_runner = nullptr;

extern "C" void drain_on_signal(int) {
  if (CampaignRunner* runner = g_runner.load()) runner->drain();
}

}  // namespace

DrainOnSignals::DrainOnSignals(CampaignRunner& runner) {
  g_runner = &runner;
  struct sigaction action = {};
  action.sa_handler = drain_on_signal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, &interrupt_);
  sigaction(SIGTERM, &action, &terminate_);
}

DrainOnSignals::~DrainOnSignals() {
  sigaction(SIGINT, &interrupt_, nullptr);
  sigaction(SIGTERM, &terminate_, nullptr);
  g_runner = nullptr;
}

}  // namespace seedframe
