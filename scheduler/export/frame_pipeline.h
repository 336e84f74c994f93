// Frames through three steps: taken in order, worked on beside each other, given on in order.
#pragma once

#include <cstddef>
#include <memory>

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

namespace seedframe {

/// `next` gives a std::shared_ptr<Task>, null at the end; `make` works on a task in any thread;
/// `take` sees the tasks in the order of `next`, and may run beside it. At most twice as many tasks
/// as workers are there at a time.
template <class Task, class Next, class Make, class Take>
void run_frame_pipeline(int workers, const Next& next, const Make& make, const Take& take) {
  using Pointer = std::shared_ptr<Task>;
  const auto threads = static_cast<std::size_t>(workers);
  const tbb::global_control at_most(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(workers);
  arena.execute([&] {
    tbb::parallel_pipeline(
        2 * threads,
        tbb::make_filter<void, Pointer>(tbb::filter_mode::serial_in_order,
                                        [&](tbb::flow_control& control) -> Pointer {
                                          Pointer task = next();
                                          if (!task) control.stop();
                                          return task;
                                        }) &
            tbb::make_filter<Pointer, Pointer>(tbb::filter_mode::parallel,
                                               [&](Pointer task) {
                                                 make(*task);
                                                 return task;
                                               }) &
            tbb::make_filter<Pointer, void>(tbb::filter_mode::serial_in_order,
                                            [&](const Pointer& task) { take(*task); }));
  });
}

}  // namespace seedframe
