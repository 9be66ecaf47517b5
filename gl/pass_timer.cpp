#include "gl/pass_timer.h"

namespace noonmark::gl {

PassTimer::PassTimer(bool use_queries) {
  if (use_queries) query_ = make_query(GL_TIME_ELAPSED);
}

double PassTimer::measure(const std::function<void()>& pass) {
  if (query_) {
    glBeginQuery(GL_TIME_ELAPSED, query_.id());
    pass();
    glEndQuery(GL_TIME_ELAPSED);
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(query_.id(), GL_QUERY_RESULT, &nanoseconds);
    return static_cast<double>(nanoseconds) * 1e-6;
  }
  glFinish();
  const auto start = std::chrono::steady_clock::now();
  pass();
  glFinish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace noonmark::gl
