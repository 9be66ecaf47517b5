// The limits of a [[bound]] on a share.
#include <gtest/gtest.h>

#include <string>

#include "app/definition/experiment_file.h"
#include "base/error.h"
#include "tests/support/kind_thrown.h"

namespace noonmark {
namespace {

std::string refused_bound(const std::string& limit, const std::string& metric = "acne") {
  return refusal_of(ErrorKind::usage,
                    [&] { parse_experiment("[[bound]]\nmetric = \"" + metric + "\"\n" + limit + "\n", "x.toml"); });
}

TEST(LimitOfAShare, IsNeverBelowZero) {
  EXPECT_EQ(refused_bound("max = \"-5%\""), "x.toml:3:7: max = -5%: acne is a share, which is never below 0");
  EXPECT_EQ(refused_bound("max = -0.05"), "x.toml:3:7: max = -0.05: acne is a share, which is never below 0");
  EXPECT_EQ(refused_bound("min = \"-1 %\""), "x.toml:3:7: min = -1 %: acne is a share, which is never below 0");
  for (const char* allowed : {"max = 0", "max = \"0%\"", "max = \"5%\"", "min = -0.0"})
    EXPECT_EQ(refused_bound(allowed), "");
  EXPECT_EQ(refused_bound("min = -1", "edge_displacement_texels"), "") << "no share";
}

}  // namespace
}  // namespace noonmark
