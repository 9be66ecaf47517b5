#include "app/threads.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "scenes/error.h"

namespace noonmark {
namespace {

// Beside those of the rays and the renderer: what Mesa, OpenEXR and OpenImageIO's libraries start for themselves, two
// thirds of it measured on Debian 12.
constexpr int threads_of_libraries = 12;

// How many threads can live at once, up to `most`.
int startable(int most) {
  std::mutex mutex;
  std::condition_variable ended;
  bool end = false;
  std::vector<std::thread> threads;
  try {
    for (int i = 0; i < most; ++i)
      threads.emplace_back([&] {
        std::unique_lock lock(mutex);
        ended.wait(lock, [&] { return end; });
      });
  } catch (const std::system_error&) {  // the limit
  }
  {
    const std::lock_guard lock(mutex);
    end = true;
  }
  ended.notify_all();
  for (std::thread& thread : threads) thread.join();
  return static_cast<int>(threads.size());
}

}  // namespace

ThreadLimit::ThreadLimit(int threads) {
  const int wanted = threads > 0 ? threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int all = 2 * wanted + threads_of_libraries;
  const int possible = startable(all);
  if (possible < 2 + threads_of_libraries)
    throw Error(
        ErrorKind::device,
        fmt::format("threads: only {} can be started here, and a measurement needs {}; raise the limit (ulimit -u, "
                    "ulimit -v, or the container's number of processes)",
                    possible, 2 + threads_of_libraries));
  if (possible < all) {
    threads = (possible - threads_of_libraries) / 2;
    fmt::print(stderr, "note: no more than {} threads can be started here; going on with --threads {}\n", possible,
               threads);
  }
  if (threads == 0) return;
  rays_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
}

}  // namespace noonmark
