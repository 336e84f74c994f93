#include "render/local_executor.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "base/files.h"

namespace seedframe {

LocalExecutor::LocalExecutor(WorkerOptions options)
    : options_(std::move(options)), wake_fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

LocalExecutor::~LocalExecutor() {
  if (wake_fd_ >= 0) close(wake_fd_);
}

Result<std::shared_ptr<Worker>> LocalExecutor::start(int number) {
  if (wake_fd_ < 0) return fail(ErrorKind::kExhausted, "cannot make an eventfd");
  Result<std::shared_ptr<LocalWorker>> worker = LocalWorker::start(options_, number);
  if (!worker) return forward_error(worker);
  started_.push_back(*worker);
  return *worker;
}

Status LocalExecutor::check(const ReadyMessage& ready) const {
  return check_worker(options_.conditions, ready);
}

std::vector<std::shared_ptr<LocalWorker>> LocalExecutor::workers() {
  std::erase_if(started_, [](const auto& worker) { return worker.expired(); });
  std::vector<std::shared_ptr<LocalWorker>> workers;
  for (const auto& started : started_) workers.push_back(started.lock());
  return workers;
}

void LocalExecutor::wait(Clock::time_point deadline) {
  const auto watched = workers();
  std::vector<pollfd> waiting = {{wake_fd_, POLLIN, 0}};
  for (const auto& worker : watched) {
    worker->add_events(waiting);
    deadline = std::min(deadline, worker->next_end_step());
  }
  int timeout_ms = -1;
  if (deadline != Clock::time_point::max()) {
    constexpr std::int64_t kLongest = 60'000;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    timeout_ms = static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, kLongest));
  }
  poll(waiting.data(), waiting.size(), timeout_ms);
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t bytes = read(wake_fd_, &count, sizeof count);
  for (const auto& worker : watched) worker->move_bytes();
}

void LocalExecutor::wake() {
  const int saved_errno = errno;
  const std::uint64_t one = 1;
  // It fails only when the counter is full, and then the pool is awake anyway.
  [[maybe_unused]] const ssize_t written = write(wake_fd_, &one, sizeof one);
  errno = saved_errno;
}

}  // namespace seedframe
