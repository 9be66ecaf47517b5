#include "base/threads.h"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"

namespace noonmark {
namespace {

// Threads beside those of the rays and the renderer: Mesa, OpenEXR (most_image_threads) and OpenImageIO start them. Two thirds of this
// number were measured on Debian 12.
constexpr int threads_of_libraries = 12;

struct Gate {
  pthread_mutex_t closed = PTHREAD_MUTEX_INITIALIZER;
};

// How many threads can live at the same time, up to `most`. std::thread is not used, because it frees memory when it
// ends. Then the C library, for some threads and by chance, reserves 64 MB of address space, and the space left under
// ulimit -v would differ from run to run.
int startable(int most) {
  Gate gate;
  pthread_mutex_lock(&gate.closed);
  std::vector<pthread_t> threads;
  threads.reserve(static_cast<size_t>(most));
  const auto wait = [](void* at) -> void* {
    pthread_mutex_lock(&static_cast<Gate*>(at)->closed);
    pthread_mutex_unlock(&static_cast<Gate*>(at)->closed);
    return nullptr;
  };
  for (pthread_t thread{}; std::ssize(threads) < most && pthread_create(&thread, nullptr, wait, &gate) == 0;)
    threads.push_back(thread);
  pthread_mutex_unlock(&gate.closed);
  for (const pthread_t thread : threads) pthread_join(thread, nullptr);
  pthread_mutex_destroy(&gate.closed);
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
    fmt::print(stderr, "note: no more than {} threads can be started here; continuing with --threads {}\n", possible,
               threads);
  }
  if (threads == 0) return;
  rays_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
}

}  // namespace noonmark
