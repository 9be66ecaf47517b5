// What is no whole store of ours is refused before anything in it is believed, or works.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "compare/store.h"
#include "scenes/error.h"
#include "scenes/file.h"
#include "tests/sample_results.h"

namespace noonmark {
namespace {

const std::string fingerprint = "version = 0.1.0\n";

class StoreCheck : public testing::Test {
 protected:
  ResultStore fresh() { return ResultStore(path, fingerprint, Existing::resume); }
  // The message of the Error(scene) that opening throws.
  std::string refusal() {
    try {
      fresh();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::scene) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "was opened";
    return "";
  }
  TemporaryFolder folder;
  const std::string path = folder.file("results.sqlite");
};

TEST_F(StoreCheck, RefusesWhatIsNoFileBesideIt) {
  fresh().add(sample_point(1));
  for (const char* ending : {"-journal", "-wal", "-shm"}) {
    const std::string beside = path + ending;
    ASSERT_EQ(::mkfifo(beside.c_str(), 0600), 0);
    ::alarm(60);  // a pipe that nobody writes into would be waited for without end
    const std::string message = refusal();
    ::alarm(0);
    EXPECT_NE(message.find(beside + ": is not a regular file"), std::string::npos) << message;
    EXPECT_NE(message.find("--overwrite"), std::string::npos) << message;
    EXPECT_THROW(ResultStore::open(path), Error);
    ::unlink(beside.c_str());
    std::filesystem::create_symlink("elsewhere", beside);
    EXPECT_NE(refusal().find(beside + ": is not a regular file"), std::string::npos);
    ::unlink(beside.c_str());
  }
  EXPECT_EQ(fresh().finished().size(), 1u);
  // SQLite looks beside the file itself, where the store is a link to it.
  const std::string file = folder.file("file.sqlite");
  std::filesystem::rename(path, file);
  std::filesystem::create_symlink("file.sqlite", path);
  EXPECT_EQ(fresh().finished().size(), 1u);
  ASSERT_EQ(::mkfifo((file + "-journal").c_str(), 0600), 0);
  ::alarm(60);
  EXPECT_NE(refusal().find("file.sqlite-journal: is not a regular file"), std::string::npos);
  ::alarm(0);
}

}  // namespace
}  // namespace noonmark
