// Loaded before the C library (LD_PRELOAD). Refuses new threads when NOONMARK_TEST_THREADS of them exist, as a full
// process table or a container's limit does. `ulimit -u` does not limit root, and CI often runs as root.
#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>

namespace {

std::atomic<int> living = 0;

struct Start {
  void* (*routine)(void*);
  void* argument;
};

void* run(void* given) {
  const Start start = *static_cast<Start*>(given);
  delete static_cast<Start*>(given);
  struct Count {
    ~Count() { --living; }  // also when the thread is cancelled
  } count;
  return start.routine(start.argument);
}

}  // namespace

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*routine)(void*),
                              void* argument) {
  static const auto create = reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
  static const int most = std::atoi(std::getenv("NOONMARK_TEST_THREADS"));
  if (++living > most) {
    --living;
    return EAGAIN;
  }
  auto* start = new Start{routine, argument};
  const int error = create(thread, attributes, run, start);
  if (error != 0) {
    --living;
    delete start;
  }
  return error;
}
