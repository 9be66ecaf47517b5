#include "base/build_facts.h"

#include <gtest/gtest.h>

#include <cctype>

namespace noonmark {
namespace {

TEST(BuildFacts, NameTheVersionTheCompilerAndACommit) {
  const BuildFacts& facts = build_facts();
  EXPECT_EQ(facts.version, NOONMARK_VERSION);
  EXPECT_NE(facts.compiler.find(' '), std::string_view::npos) << facts.compiler;
  EXPECT_FALSE(facts.build_type.empty());
  if (facts.commit == "unknown") GTEST_SKIP() << "built outside a git checkout";
  const std::string_view hash = facts.commit.substr(0, facts.commit.find('-'));
  EXPECT_GE(hash.size(), 12u);
  for (char c : hash) EXPECT_TRUE(std::isxdigit(static_cast<unsigned char>(c))) << facts.commit;
  const std::string_view rest = facts.commit.substr(hash.size());
  EXPECT_TRUE(rest.empty() || rest == "-dirty") << facts.commit;
}

TEST(BuildFacts, GiveEveryLibraryAVersionNumber) {
  ASSERT_FALSE(build_facts().libraries.empty());
  for (const LibraryVersion& library : build_facts().libraries) {
    EXPECT_FALSE(library.name.empty());
    ASSERT_FALSE(library.version.empty()) << library.name;
    EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(library.version[0]))) << library.name << ' ' << library.version;
  }
}

}  // namespace
}  // namespace noonmark
