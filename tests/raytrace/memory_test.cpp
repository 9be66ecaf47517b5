// A scene whose tree does not fit into memory is refused before Embree begins to build it, because an allocation that
// fails during the build ends the program or waits for ever.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "base/error.h"
#include "raytrace/tracer.h"

namespace noonmark {
namespace {

// A sheet of side * side squares.
Scene sheet(uint32_t side) {
  Scene scene;
  for (uint32_t y = 0; y <= side; ++y)
    for (uint32_t x = 0; x <= side; ++x) scene.positions.emplace_back(x, 0, y);
  for (uint32_t y = 0; y < side; ++y)
    for (uint32_t x = 0; x < side; ++x) {
      const uint32_t corner = y * (side + 1) + x;
      scene.triangles.emplace_back(corner, corner + side + 1, corner + 1);
      scene.triangles.emplace_back(corner + 1, corner + side + 1, corner + side + 2);
    }
  return scene;
}

uint64_t address_space() {
  uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

// Ends with the exit code that the program would have.
void trace_within(uint64_t bytes) {
  const Scene scene = sheet(1000);
  const rlimit most{address_space() + bytes, address_space() + bytes};
  setrlimit(RLIMIT_AS, &most);
  alarm(60);
  try {
    const raytrace::Tracer tracer(scene);
  } catch (const Error& error) {
    std::exit(error.exit_code());
  }
  std::exit(0);
}

TEST(RaytraceMemory, ATreeThatDoesNotFitIsRefused) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "AddressSanitizer takes terabytes of address space";
#endif
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  // 2 million triangles: 96 MB of buffers, 214 MB for the build (and the threads' own, some 140 MB each).
  for (const uint64_t megabytes : {150, 250, 350, 450})
    EXPECT_EXIT(trace_within(megabytes << 20), testing::ExitedWithCode(static_cast<int>(ErrorKind::device)), "")
        << megabytes;
  EXPECT_EXIT(trace_within(uint64_t{4} << 30), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace noonmark
