// Which verdicts join numbers of several machines.
#include "compare/judge/machines.h"

#include <gtest/gtest.h>

namespace noonmark {
namespace {

Results on_machines(const std::vector<Machine>& machines) {
  Results results;
  for (const Machine& machine : machines) {
    PointRecord point;
    point.id = static_cast<int64_t>(results.points.size());
    point.settings["map.resolution"] = point.id == 0 ? "512" : "1024";
    point.machine = machine;
    results.points.push_back(point);
  }
  return results;
}
BoundResult bound_on(const std::string& metric) {
  BoundResult bound;
  bound.metric = metric;
  return bound;
}
const Machine a{"a", "EPYC", "llvmpipe", "3.13.5 avx2", "2026-01-01T00:00:00Z"};
const Machine twin{"b", "EPYC", "llvmpipe", "3.13.5 avx2", "2026-01-02T00:00:00Z"};
const Machine other{"c", "EPYC", "llvmpipe", "3.13.5 avx512", "2026-01-02T00:00:00Z"};

TEST(MachineNotes, AreNoneForOneMachine) {
  Results results = on_machines({a, a});
  results.bounds = {bound_on("acne"), bound_on("shadow_ms")};
  EXPECT_TRUE(machine_notes(results).machines.empty());
  EXPECT_TRUE(machine_notes(results).warnings.empty());
}

TEST(MachineNotes, WarnOfTimesOfHostsThatAreAlike) {
  Results results = on_machines({a, twin});
  results.bounds = {bound_on("acne")};
  EXPECT_EQ(machine_notes(results).machines.size(), 2u);
  EXPECT_TRUE(machine_notes(results).warnings.empty()) << "they round alike";
  results.bounds.push_back(bound_on("shadow_ms"));
  ASSERT_EQ(machine_notes(results).warnings.size(), 1u);
  EXPECT_NE(machine_notes(results).warnings[0].find("the bound on shadow_ms"), std::string::npos);
  EXPECT_EQ(machine_notes(results).warnings[0].find("acne"), std::string::npos);
}

TEST(MachineNotes, WarnOfMetricsOfMachinesThatDiffer) {
  Results results = on_machines({a, other});
  results.bounds = {bound_on("acne")};
  ASSERT_EQ(machine_notes(results).warnings.size(), 1u);
  // A bound on the points of one of them hangs on that one alone.
  results.bounds[0].where = {{"map.resolution", {"512"}}};
  EXPECT_TRUE(machine_notes(results).warnings.empty());
  results.bounds.clear();
  results.info.cost = "shadow_ms";
  ASSERT_EQ(machine_notes(results).warnings.size(), 1u);
  EXPECT_NE(machine_notes(results).warnings[0].find("shadow_ms"), std::string::npos);
}

}  // namespace
}  // namespace noonmark
