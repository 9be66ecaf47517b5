// The time of a pass, by the clock that fits the device (gl/renderer.h, TimeSource).
#pragma once
#include <functional>

#include "gl/gl_objects.h"
#include "gl/renderer.h"

namespace noonmark::gl {

class PassTimer {
 public:
  // The context must be current, here and in measure().
  explicit PassTimer(TimeSource source);

  // Runs `pass` and waits for it; returns its milliseconds.
  double measure(const std::function<void()>& pass);

 private:
  TimeSource source_;
  Query query_;  // TimeSource::timer_query
};

}  // namespace noonmark::gl
