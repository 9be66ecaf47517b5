#include "gl/pass_timer.h"

#include <ctime>

namespace noonmark::gl {
namespace {

double now_ms(TimeSource source) {
  timespec time{};
  clock_gettime(source == TimeSource::process_cpu ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace

PassTimer::PassTimer(TimeSource source) : source_(source) {
  if (source == TimeSource::timer_query) query_ = make_query(GL_TIME_ELAPSED);
}

double PassTimer::measure(const std::function<void()>& pass) {
  if (source_ == TimeSource::timer_query) {
    glBeginQuery(GL_TIME_ELAPSED, query_.id());
    pass();
    glEndQuery(GL_TIME_ELAPSED);
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(query_.id(), GL_QUERY_RESULT, &nanoseconds);
    return static_cast<double>(nanoseconds) * 1e-6;
  }
  glFinish();
  const double start = now_ms(source_);
  pass();
  glFinish();
  return now_ms(source_) - start;
}

}  // namespace noonmark::gl
