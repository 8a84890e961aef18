#pragma once
// Independent tasks on all cores.

#include <cstddef>
#include <functional>

namespace goniofit {

/// Calls task(0) ... task(count - 1), each once, on up to `threads` threads (0: as many as the machine has), in no
/// particular order. A task writes only what is its own, so results do not depend on the number of threads. Of the
/// exceptions thrown, the one of the lowest index passes on, after all tasks have ended.
/// `progress(done, count)` is called after each task, one call at a time.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& task,
                  const std::function<void(std::size_t, std::size_t)>& progress = {}, std::size_t threads = 0);

}  // namespace goniofit
