// Runs post-processing beside the rendering.
#pragma once

#include <functional>
#include <thread>
#include <vector>

#include <tbb/concurrent_queue.h>

namespace seedframe {

/// A few threads that take jobs in order. The destructor waits for all jobs. The threads are not
/// TBB's: jobs wait for the disk, and as many as asked for run at once on any machine.
class FinishQueue {
 public:
  explicit FinishQueue(int threads);
  ~FinishQueue();
  FinishQueue(const FinishQueue&) = delete;
  FinishQueue& operator=(const FinishQueue&) = delete;

  void push(std::function<void()> job);

 private:
  void work();

  tbb::concurrent_bounded_queue<std::function<void()>> jobs_;  ///< an empty one ends a thread
  std::vector<std::jthread> threads_;                          ///< joined before jobs_ goes
};

}  // namespace seedframe
