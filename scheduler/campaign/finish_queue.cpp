#include "campaign/finish_queue.h"

#include <utility>

#include <pthread.h>

namespace seedframe {

FinishQueue::FinishQueue(int threads) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

FinishQueue::~FinishQueue() {
  for (std::size_t i = 0; i < threads_.size(); ++i) jobs_.push(nullptr);
}

void FinishQueue::push(std::function<void()> job) { jobs_.push(std::move(job)); }

void FinishQueue::work() {
  pthread_setname_np(pthread_self(), "finish");  // for whoever looks at what costs time
  while (true) {
    std::function<void()> job;
    jobs_.pop(job);
    if (!job) return;
    job();
  }
}

}  // namespace seedframe
