// The journal of a store that is being written: which file systems hold a log, and which files are left.
#include <gtest/gtest.h>
#include <linux/magic.h>

#include <filesystem>

#include "compare/store/journal.h"
#include "compare/store/sqlite.h"
#include "compare/store/store.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

TEST(StoreJournal, ALogIsForFileSystemsOfThisMachine) {
  for (uint64_t local : {EXT4_SUPER_MAGIC, XFS_SUPER_MAGIC, TMPFS_MAGIC, OVERLAYFS_SUPER_MAGIC})
    EXPECT_TRUE(holds_a_log(local)) << std::hex << local;
  EXPECT_TRUE(holds_a_log(BTRFS_SUPER_MAGIC));
  constexpr uint64_t cifs = 0xff534d42, smb2 = 0xfe534d42, fuse = 0x65735546, ceph = 0x00c36400, lustre = 0x0bd00bd0;
  for (uint64_t other : {uint64_t{NFS_SUPER_MAGIC}, uint64_t{SMB_SUPER_MAGIC}, uint64_t{V9FS_MAGIC}, cifs, smb2, fuse,
                         ceph, lustre, uint64_t{0}})
    EXPECT_FALSE(holds_a_log(other)) << std::hex << other;
}

class StoreFiles : public testing::Test {
 protected:
  void SetUp() override {
    if (ResultStore(path, "x = 1\n", Existing::overwrite); !log_was_made())
      GTEST_SKIP() << "the folder for tests is on a file system that holds no log";
  }
  bool log_was_made() const {
    ResultStore store(path, "x = 1\n", Existing::resume);
    store.set_info(sample_info(), 3);
    return fs::exists(path + "-wal");
  }
  bool one_file() const {
    for (const char* ending : {"-journal", "-wal", "-shm"})
      if (fs::exists(path + ending)) return false;
    return true;
  }
  TemporaryFolder folder;
  const std::string path = folder.file("results.sqlite");
};

TEST_F(StoreFiles, AFinishedStoreIsOneFileThatNeedsNoOther) {
  {
    ResultStore store(path, "x = 1\n", Existing::resume);
    store.add(sample_point(0));
    EXPECT_FALSE(one_file());
  }
  EXPECT_TRUE(one_file());
  sqlite::Database db(path, sqlite::Database::Mode::existing);
  EXPECT_EQ(db.ask("PRAGMA journal_mode"), "delete") << "a reader without the right to write could not open it";
}

TEST_F(StoreFiles, OfAKilledRunTogetherHaveEveryPoint) {
  const std::string killed = folder.file("killed.sqlite");
  ResultStore store(path, "x = 1\n", Existing::resume);
  for (int id = 0; id < 3; ++id) {
    store.add(sample_point(id));
    fs::copy_file(path, killed, fs::copy_options::overwrite_existing);
    fs::copy_file(path + "-wal", killed + "-wal", fs::copy_options::overwrite_existing);
    EXPECT_EQ(ResultStore::open(killed).load().points.size(), static_cast<size_t>(id + 1));
    EXPECT_FALSE(fs::exists(killed + "-wal")) << "the reader has moved the log into the store";
  }
}

TEST_F(StoreFiles, AReaderAtTheEndLosesNothing) {
  {
    sqlite::Database reader(path, sqlite::Database::Mode::existing);
    {
      ResultStore store(path, "x = 1\n", Existing::resume);
      store.add(sample_point(0));
      reader.execute("BEGIN");
      EXPECT_EQ(reader.ask("SELECT count(*) FROM finished"), "1");
      store.add(sample_point(1));  // neither waits for the other
      EXPECT_EQ(reader.ask("SELECT count(*) FROM finished"), "1");
    }
    reader.execute("COMMIT");
    EXPECT_EQ(reader.ask("SELECT count(*) FROM finished"), "2");
  }
  EXPECT_EQ(ResultStore(path, "x = 1\n", Existing::resume).load().points.size(), 2u);
  EXPECT_TRUE(one_file());
}

}  // namespace
}  // namespace noonmark
