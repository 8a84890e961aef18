#include "synthetic/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace goniofit {

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& task,
                  const std::function<void(std::size_t, std::size_t)>& progress, std::size_t threads) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::exception_ptr> thrown(count);
  std::atomic<std::size_t> next{0};
  std::mutex reporting;
  std::size_t done = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        task(i);
      } catch (...) {
        thrown[i] = std::current_exception();
      }
      const std::scoped_lock one_at_a_time(reporting);
      ++done;
      if (progress) progress(done, count);
    }
  };
  {
    std::vector<std::jthread> workers;  // joined at the end of this scope
    for (std::size_t t = 1; t < std::min(threads, count); ++t) workers.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& e : thrown) {
    if (e) std::rethrow_exception(e);
  }
}

}  // namespace goniofit
