#include "app/threads.h"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "scenes/error.h"

namespace noonmark {
namespace {

// Beside those of the rays and the renderer: what Mesa, OpenEXR and OpenImageIO's libraries start for themselves, two
// thirds of it measured on Debian 12.
constexpr int threads_of_libraries = 12;

struct Gate {
  pthread_mutex_t closed = PTHREAD_MUTEX_INITIALIZER;
};

// How many threads can live at once, up to `most`. Not std::thread, which frees memory as it ends: the C library then
// sets aside 64 MB of address space for that thread, of some of them, by chance, and what is left under ulimit -v would
// be another number in every run.
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
    fmt::print(stderr, "note: no more than {} threads can be started here; going on with --threads {}\n", possible,
               threads);
  }
  if (threads == 0) return;
  rays_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
}

}  // namespace noonmark
