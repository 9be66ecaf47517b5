// Limits the number of threads of a measurement. Results do not depend on it (tests/program/determinism_test.cpp).
#pragma once
#include <tbb/global_control.h>

#include <optional>

namespace noonmark {

// The most threads that compress an image's rows, beside those of the rays: as many as the rays have, but no more than this.
inline constexpr int most_image_threads = 4;

class ThreadLimit {
 public:
  // threads: the number for the rays and for Mesa's software renderer; 0: the number of cores. If the system does not
  // let so many start, fewer are used, with a note on standard error. Make this object before OpenGL is started. Throws
  // Error(device) if not even one thread of each kind can start, because libraries end the program without a message if
  // they cannot start a thread.
  explicit ThreadLimit(int threads);

 private:
  std::optional<tbb::global_control> rays_;  // in effect as long as this object lives
};

}  // namespace noonmark
