// A file that is not a complete store of Noonmark is refused before any of its data is used or any of its code runs.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/file.h"
#include "compare/store/check.h"
#include "compare/store/sqlite.h"
#include "compare/store/store.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

const std::string checked_fingerprint = "version = 0.1.0\n";

class StoreCheck : public testing::Test {
 protected:
  ResultStore fresh() { return ResultStore(path, checked_fingerprint, Existing::resume); }
  // The message of the Error(file) that opening throws.
  std::string refusal() {
    std::string message = "was opened";
    EXPECT_EQ(kind_thrown([&] { fresh(); }, &message), static_cast<int>(ErrorKind::file)) << message;
    return message;
  }
  TemporaryFolder folder;
  const std::string path = folder.file("results.sqlite");
};

TEST_F(StoreCheck, RefusesWhatIsNoFileBesideIt) {
  fresh().add(sample_point(1));
  for (const char* ending : {"-journal", "-wal", "-shm"}) {
    const std::string beside = path + ending;
    ASSERT_EQ(::mkfifo(beside.c_str(), 0600), 0);
    ::alarm(60);  // opening a pipe waits for a writer, so the test fails after 60 s
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
  // If the store is a link, SQLite looks for the journal beside the file itself.
  const std::string file = folder.file("file.sqlite");
  std::filesystem::rename(path, file);
  std::filesystem::create_symlink("file.sqlite", path);
  EXPECT_EQ(fresh().finished().size(), 1u);
  ASSERT_EQ(::mkfifo((file + "-journal").c_str(), 0600), 0);
  ::alarm(60);
  EXPECT_NE(refusal().find("file.sqlite-journal: is not a regular file"), std::string::npos);
  ::alarm(0);
}

TEST_F(StoreCheck, RefusesASchemaThatIsNotItsOwn) {
  struct Case {
    const char *sql, *says;
  };
  const Case cases[] = {
      {"CREATE TRIGGER t AFTER INSERT ON metrics WHEN new.name = 'error' BEGIN "
       "UPDATE metrics SET value = 0 WHERE name = 'acne'; END",
       "trigger t"},
      {"CREATE TRIGGER t INSTEAD OF INSERT ON points BEGIN DELETE FROM metrics; END", "trigger t"},
      {"CREATE VIEW mine AS SELECT 1 AS x", "view mine"},
      {"CREATE TABLE mine (x)", "table mine"},
      {"CREATE INDEX mine ON metrics (value)", "index mine"},
      {"DROP TABLE curves", "table curves is lost"},
      {"DROP VIEW points", "view points is lost"},
      {"ALTER TABLE finished ADD COLUMN mine", "table finished"},
      {"DROP TABLE info; CREATE VIEW info AS SELECT 'checked_fingerprint' AS key, 'x' AS value", "view info"},
      {"DROP VIEW points; CREATE VIEW points AS SELECT 0 AS acne", "view points"},
  };
  fresh().add(sample_point(1));
  const std::string whole = read_file(path);
  for (const Case& one : cases) {
    SCOPED_TRACE(one.sql);
    write_file_atomically(path, whole);
    sqlite::Database(path, sqlite::Database::Mode::existing).execute(one.sql);
    const std::string message = refusal();
    EXPECT_NE(message.find(one.says), std::string::npos) << message;
    EXPECT_NE(message.find("--overwrite"), std::string::npos) << message;
    expect_refused(ErrorKind::file, {"--overwrite"}, [&] { ResultStore::open(path); });
  }
  ResultStore(path, checked_fingerprint, Existing::overwrite).add(sample_point(1));
  EXPECT_EQ(fresh().finished().size(), 1u);
}

// Between the check and the later statements somebody else may write into the file.
TEST_F(StoreCheck, LetsNoTriggerOfAFileFire) {
  sqlite::Database db(path, sqlite::Database::Mode::create);
  db.execute(
      "CREATE TABLE a (x); CREATE TABLE b (x); "
      "CREATE TRIGGER t AFTER INSERT ON a BEGIN INSERT INTO b VALUES (1); END; INSERT INTO a VALUES (1)");
  EXPECT_EQ(db.ask("SELECT count(*) FROM a"), "1");
  EXPECT_EQ(db.ask("SELECT count(*) FROM b"), "0");
}

// A search does not find rows in the wrong order. SQLite's quick check does not check the order.
TEST_F(StoreCheck, RefusesAStoreWhosePagesWereExchanged) {
  {
    ResultStore store = fresh();
    for (int id = 0; id < 20; ++id) store.add(sample_point(id));
  }
  const std::string whole = read_file(path);
  constexpr size_t page = 4096;
  constexpr char leaf_of_rows_by_key = 10;  // the type of a page is its first byte
  const auto what_sqlite_says = [&](const char* pragma) {
    return sqlite::Database(path, sqlite::Database::Mode::existing).ask(pragma);
  };
  int found = 0, noticed = 0;
  for (size_t at = page; at + 2 * page <= whole.size(); at += page) {
    if (whole[at] != leaf_of_rows_by_key || whole[at + page] != leaf_of_rows_by_key) continue;
    std::string bytes = whole;
    std::swap_ranges(bytes.begin() + static_cast<ptrdiff_t>(at), bytes.begin() + static_cast<ptrdiff_t>(at + page),
                     bytes.begin() + static_cast<ptrdiff_t>(at + page));
    write_file_atomically(path, bytes);
    // Skips pages of two tables, and two empty pages: their exchange causes another error or none.
    if (what_sqlite_says("PRAGMA quick_check") != "ok" || what_sqlite_says("PRAGMA integrity_check") == "ok") continue;
    ++found;
    const std::string message = refusal();
    EXPECT_NE(message.find("is damaged: "), std::string::npos) << message;
    EXPECT_NE(message.find("--overwrite"), std::string::npos) << message;
    EXPECT_THROW(ResultStore::open(path), Error);
    try {  // looks for no damage, but notices it where it reads
      const Results read = ResultStore::read(path);
      ASSERT_EQ(read.points.size(), 20u);
      for (size_t i = 0; i < read.points.size(); ++i)
        EXPECT_TRUE(same(read.points[i], sample_point(static_cast<int>(i)))) << "after page " << at / page;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::file);
      ++noticed;
    }
  }
  EXPECT_GT(found, 0);
  EXPECT_GT(noticed, 0);
}

// A point is found by the digest of its scene, so the scenes of two fingerprints may differ.
TEST_F(StoreCheck, ResumesWhateverTheContentsOfItsScenes) {
  const std::string scene = "scene street.glb (45;0) = ", before = checked_fingerprint + scene + "a1\n",
                    after = checked_fingerprint + scene + "b2\nscene yard.glb (45;0) = c3\n";
  ResultStore(path, before, Existing::resume).add(sample_point(1));
  ResultStore store(path, after, Existing::resume);
  EXPECT_EQ(store.finished(), std::vector<int64_t>{1});
  store.set_plan(after, "");
  EXPECT_EQ(store.fingerprint(), after);
  store.set_plan(before, "");
  EXPECT_EQ(store.fingerprint(), before + "scene yard.glb (45;0) = c3\n") << "of points that were set aside";
}

TEST_F(StoreCheck, SaysWhoseResultsItHoldsAsFarAsItCanBeRead) {
  EXPECT_EQ(ResultStore::experiment_file(path), "");
  fresh();
  EXPECT_EQ(ResultStore::experiment_file(path), "") << "no run has said it yet";
  RunInfo info = sample_info();
  info.file = "../x.toml";
  fresh().set_info(info, 1);
  EXPECT_EQ(ResultStore::experiment_file(path), "../x.toml");
  sqlite::Database(path, sqlite::Database::Mode::existing).execute("PRAGMA user_version = 99");
  EXPECT_EQ(ResultStore::experiment_file(path), "../x.toml") << "of another version";
  write_file_atomically(
      path, "no database, but as long as the head of one has to be, which is a hundred bytes or more ......");
  EXPECT_EQ(ResultStore::experiment_file(path), "");
}

}  // namespace
}  // namespace noonmark
