// How much memory is available, and the estimate of what a point needs. tests/program/memory_test.cpp measures what a
// point really needs.
#include "base/memory.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "measure/memory_estimate.h"
#include "scenes/library.h"
#include "scenes/scene_size.h"
#include "tests/scenes/gltf/files.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

constexpr uint64_t MiB = 1 << 20;

TEST(AvailableMemory, IsTheLeastOfTheMachinesAndTheGroups) {
  const TemporaryFolder root;
  const auto available = [&] { return available_memory(root.path().string()); };
  EXPECT_EQ(available().bytes, UINT64_MAX) << "no limit is known here";

  root.write("proc/meminfo", "MemTotal:       9000 kB\nMemFree:  100 kB\nMemAvailable:    8192 kB\n");
  EXPECT_EQ(available().bytes, 8 * MiB);
  EXPECT_EQ(available().limit, "the machine's free memory");

  // Version 2: 7 MiB are allowed and 4 are in use; 1 of these is file cache, which can be given back.
  root.write("proc/self/cgroup", "0::/a.slice/b.service\n");
  root.write("sys/fs/cgroup/a.slice/b.service/memory.max", "7340032\n");
  root.write("sys/fs/cgroup/a.slice/b.service/memory.current", "4194304\n");
  root.write("sys/fs/cgroup/a.slice/b.service/memory.stat", "anon 3145728\ninactive_file 1048576\n");
  EXPECT_EQ(available().bytes, 4 * MiB);
  EXPECT_EQ(available().limit, "the control group's limit");
  EXPECT_EQ(available().text(), "4.2 MB are available (the control group's limit)");

  // The parent group may allow less.
  root.write("sys/fs/cgroup/a.slice/memory.max", "6291456\n");
  root.write("sys/fs/cgroup/a.slice/memory.current", "4194304\n");
  EXPECT_EQ(available().bytes, 2 * MiB);
  root.write("sys/fs/cgroup/a.slice/memory.max", "max\n");
  EXPECT_EQ(available().bytes, 4 * MiB);
  root.write("sys/fs/cgroup/a.slice/b.service/memory.max", "1024\n");
  EXPECT_EQ(available().bytes, 0u) << "more is in use than is now allowed";
}

TEST(AvailableMemory, KnowsGroupsOfVersionOneAndInsideContainers) {
  const TemporaryFolder root;
  const auto available = [&] { return available_memory(root.path().string()); };
  root.write("proc/meminfo", "MemAvailable:    8192 kB\n");
  root.write("proc/self/cgroup", "9:name=systemd:/x\n4:cpu,memory:/docker/1234\n2:cpuacct:/y\n");
  root.write("sys/fs/cgroup/memory/docker/1234/memory.limit_in_bytes", "5242880\n");
  root.write("sys/fs/cgroup/memory/docker/1234/memory.usage_in_bytes", "2097152\n");
  EXPECT_EQ(available().bytes, 3 * MiB);

  // The path is that of the host and does not exist here. The container's own group is mounted at the top.
  root.write("proc/self/cgroup", "4:memory:/docker/5678\n");
  root.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "4194304\n");
  root.write("sys/fs/cgroup/memory/memory.usage_in_bytes", "3145728\n");
  EXPECT_EQ(available().bytes, 1 * MiB);
  // Version 1 writes a number near 2^63 if there is no limit.
  root.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(available().bytes, 8 * MiB);
}

TEST(AvailableMemory, IsKnownHere) {
  EXPECT_LT(available_memory().bytes, uint64_t{1} << 50);
  EXPECT_GT(resident_bytes(), 1 * MiB);
}

TEST(AvailableMemory, IsToldInTwoDigits) {
  EXPECT_EQ(bytes_text(999), "999 bytes");
  EXPECT_EQ(bytes_text(1234), "1.2 kB");
  EXPECT_EQ(bytes_text(9.96e6), "10 MB");
  EXPECT_EQ(bytes_text(640e6), "640 MB");
  EXPECT_EQ(bytes_text(999.6e6), "1.0 GB");
  EXPECT_EQ(bytes_text(2.5e13), "25 TB");
}

class Estimate : public testing::Test {
 protected:
  MemoryEstimate estimate(LightKind light = LightKind::directional, SceneSize scene = {100, 100}, bool curve = true,
                          bool pictures = false) const {
    return estimate_memory({settings_, light, scene, 0, 0, curve, pictures});
  }
  double bytes(LightKind light = LightKind::directional, SceneSize scene = {100, 100}, bool curve = true,
               bool pictures = false) const {
    return estimate(light, scene, curve, pictures).bytes();
  }
  Settings settings_;
};

// Large points of several kinds.
TEST_F(Estimate, SeesWhatTakesTooMuch) {
  EXPECT_LT(bytes(), 1e9) << "the default settings";
  settings_.map.resolution = 16384;
  EXPECT_GT(bytes(LightKind::point), 6.0 * 16384 * 16384 * 4);  // the cube itself, of 4 bytes a texel
  EXPECT_EQ(estimate(LightKind::point).largest().what, std::string("the shadow map"));
  settings_.map.resolution = 1024;
  const SceneSize instances = {67'000'000 / 2, 67'000'000};
  EXPECT_GT(bytes(LightKind::directional, instances), 19e9);
  EXPECT_EQ(estimate(LightKind::directional, instances).largest().what, std::string("the scene"));
}

TEST_F(Estimate, KnowsTheLivePicture) {
  const auto live = [&] {
    for (const MemoryShare& share : estimate(LightKind::directional, {100, 100}, true, true).shares)
      if (share.what == std::string("the live picture")) return share.bytes;
    return -1.0;
  };
  EXPECT_EQ(estimate().shares.front().bytes, 0) << "no pictures, no live picture";
  const double one_tap = live();
  EXPECT_GT(one_tap, 1e6);
  settings_.view.width_px *= 2;
  EXPECT_EQ(live(), one_tap) << "it has a size of its own";
  settings_.filter.kind = "box";
  settings_.filter["size"] = 15;
  EXPECT_GT(live(), 57600 * 2 * 225 * sizeof(float)) << "a threshold on each of two maps for each of 225 taps";
  const double at_every_bias = live();
  settings_.filter["size"] = 31;
  EXPECT_LT(live(), at_every_bias) << "too many taps for thresholds: a stack of pictures";
  EXPECT_GT(live(), 57600 * 13 * 8.0) << "an answer for each picture";
}

// Beside the small picture's own, so that they are counted twice.
TEST_F(Estimate, KeepsSmallMapsForTheNextPoint) {
  const auto waiting = [&](bool pictures) {
    const MemoryEstimate found = estimate(LightKind::directional, {100, 100}, true, pictures);
    EXPECT_EQ(found.bytes(), found.needed() + found.waiting);
    return found.waiting;
  };
  settings_.map.resolution = 512;
  EXPECT_EQ(waiting(false), 0) << "nothing is drawn between two points";
  const double small = waiting(true);
  EXPECT_GT(small, 2.0 * 512 * 512 * 4) << "the drawn map and the exact one";
  EXPECT_LT(small, static_cast<double>(most_beside_live_bytes));
  settings_.filter.kind = "box";
  settings_.filter["size"] = 15;
  EXPECT_EQ(waiting(true), 0) << "207 million taps";
  settings_.filter["size"] = 1;
  settings_.map.resolution = 8192;
  EXPECT_EQ(waiting(true), 0) << "maps of 256 MB";
}

// They are kept to save time, so no point is refused for them.
TEST_F(Estimate, RefusesNoPointForWhatWaits) {
  settings_.map.resolution = 512;
  const MemoryEstimate found = estimate(LightKind::directional, {100, 100}, true, true);
  ASSERT_GT(found.waiting, 0);
  const auto available = [](double bytes) { return AvailableMemory{static_cast<uint64_t>(bytes), "as given"}; };
  const AvailableMemory enough = available(found.bytes() + 1), little = available(found.needed() + found.waiting / 2);
  EXPECT_TRUE(fits(found, enough));
  EXPECT_TRUE(fits_waiting(found, enough));
  EXPECT_TRUE(fits(found, little));
  EXPECT_FALSE(fits_waiting(found, little));
  EXPECT_NO_THROW(require_memory(found, little, "this point"));
  EXPECT_FALSE(fits(found, available(found.needed() - 1)));
}

TEST_F(Estimate, IsRefusedWithTheSettingToChange) {
  settings_.map.resolution = 16384;
  const MemoryEstimate cube = estimate(LightKind::point);
  EXPECT_TRUE(fits(cube, {UINT64_MAX, ""}));
  EXPECT_FALSE(fits(cube, {uint64_t{1} << 30, ""}));
  const auto needed = static_cast<uint64_t>(cube.bytes());
  EXPECT_FALSE(fits(cube, {needed - 64 * MiB, ""}));
  EXPECT_TRUE(fits(cube, {needed + 1, ""}));
  expect_refused(ErrorKind::usage, {"1.1 GB are available (a limit); lower map.resolution"}, [&] {
    require_memory(cube, {uint64_t{1} << 30, "a limit"}, "point 3");
  });
}

// The memory that the process holds already counts as available. The message says so if this decides.
TEST(MemoryOfProgram, HoldsWhatItHasAlready) {
  const AvailableMemory machine = memory_of_program({}, 0);
  EXPECT_TRUE(machine.limit.ends_with(" that the program holds already")) << machine.limit;
  EXPECT_GT(machine.bytes, resident_bytes());
}

// The result must not depend on the address space that the process has taken since the start.
TEST(MemoryOfProgram, OfAddressSpaceIsToldFromTheStart) {
  const AvailableMemory start{1000 * MiB, "ulimit -v"};
  const AvailableMemory space = memory_of_program(start, 800 * MiB);
  EXPECT_EQ(space.limit, "ulimit -v, minus the space that libraries and threads reserve");
  EXPECT_EQ(memory_of_program(start, 700 * MiB).bytes - space.bytes, 100 * MiB);
  EXPECT_EQ(memory_of_program(start, 2000 * MiB).bytes, memory_of_program(start, 1000 * MiB).bytes);
  EXPECT_GT(space.bytes, 400 * MiB) << "200 MiB and the program itself, which an estimate contains too";
  const std::vector<char> more(64 * MiB, 1);
  EXPECT_EQ(memory_of_program(start, 800 * MiB).bytes, space.bytes);
}

// A texel outside the map needs more memory than one inside it.
TEST(OutsideTexels, AreThoseThatTheSceneReaches) {
  Settings settings;
  settings.scene.name = "cube-room";
  settings.map.fit = MapFit::tight;
  const Scene scene = make_scene(settings.scene);
  const auto outside = [&] { return outside_texels(scene, Technique(scene, settings)); };
  const double resolution = settings.map.resolution;
  EXPECT_LT(outside(), 8.1 * resolution) << "a rim of two texels around a map that covers the whole scene";
  settings.map.extent_scale = 0.5;
  EXPECT_GT(outside(), 1.5 * resolution * resolution)
      << "the scene is longer than wide, and 3.5 times as large as the map now";
}

}  // namespace
}  // namespace noonmark
