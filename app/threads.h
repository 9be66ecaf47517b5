// How many threads the measurement takes. Results do not depend on it (tests/determinism_test.cpp).
#pragma once
#include <tbb/global_control.h>

#include <optional>

namespace noonmark {

class ThreadLimit {
 public:
  // threads: of the rays and of Mesa's software renderer; 0: as many as there are cores. Fewer, with a note on standard
  // error, where the system does not let so many start. To be made before OpenGL is started. Throws Error(device) where
  // not even one of each can start: libraries end the program without a word when a thread of theirs cannot.
  explicit ThreadLimit(int threads);

 private:
  std::optional<tbb::global_control> rays_;  // holds as long as this object lives
};

}  // namespace noonmark
