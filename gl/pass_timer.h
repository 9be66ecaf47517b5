// The time of a pass. On hardware it is measured by GPU timer queries. The queries of software renderers are wrong by
// orders of magnitude, so there a steady clock is read before and after, with glFinish.
#pragma once
#include <chrono>
#include <functional>

#include "gl/gl_objects.h"

namespace noonmark::gl {

class PassTimer {
 public:
  // The context must be current, here and in measure().
  explicit PassTimer(bool use_queries);

  // Runs `pass` and waits for it; returns its milliseconds.
  double measure(const std::function<void()>& pass);

 private:
  Query query_;  // empty: the clock is used
};

}  // namespace noonmark::gl
