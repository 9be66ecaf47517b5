// How long a pass took: GPU timer queries on hardware; on software renderers, whose queries are wrong by orders of
// magnitude, glFinish around a steady clock.
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
  Query query_;  // empty: clock
};

}  // namespace noonmark::gl
