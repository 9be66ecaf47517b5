// How many threads the measurement takes. Results do not depend on it (tests/determinism_test.cpp).
#pragma once
#include <tbb/global_control.h>

#include <cstdlib>
#include <optional>
#include <string>

namespace noonmark {

class ThreadLimit {
 public:
  // threads: of the rays and of Mesa's software renderer; 0: as many as there are cores. Before OpenGL is started.
  explicit ThreadLimit(int threads) {
    if (threads == 0) return;
    rays_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  }

 private:
  std::optional<tbb::global_control> rays_;  // holds as long as this object lives
};

}  // namespace noonmark
