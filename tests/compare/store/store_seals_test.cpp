// The store notices a change of its rows, in every cell.
#include <gtest/gtest.h>

#include "base/digest.h"
#include "base/error.h"
#include "compare/store/seals.h"
#include "compare/store/sqlite.h"
#include "compare/store/store.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

const auto any_point = [](const PointRecord&) { return true; };

class StoreSeals : public testing::Test {
 protected:
  void SetUp() override {
    {
      ResultStore store(whole, "x = 1\n", Existing::overwrite);
      store.set_info(sample_info(), 3);
      for (int id = 0; id < 3; ++id) store.add(sample_point(id));
      BoundResult bound;
      bound.metric = "acne";
      bound.max = 0.1;
      bound.found = 0.2;
      store.set_bounds({bound});
      store.set_laws({sample_law()});
      for (int id = 0; id < 2; ++id) store.add_phase(id, sample_phase());
    }
    afresh();  // of the closed store, because an open one has its newest rows in its log
  }
  void afresh() { std::filesystem::copy_file(whole, path, std::filesystem::copy_options::overwrite_existing); }
  void edit(const std::string& sql) {
    sqlite::Database db(path, sqlite::Database::Mode::existing);
    db.execute("PRAGMA synchronous = OFF;" + sql);
    ASSERT_NE(db.ask("SELECT total_changes()"), "0") << "this statement changed nothing: " << sql;
  }
  // Loading must fail with one line that names the file. Returns this message.
  std::string refusal() const {
    try {
      ResultStore::open(path).load();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::file);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
      return error.what();
    }
    ADD_FAILURE() << "the store was loaded";
    return "";
  }
  std::vector<std::string> columns(const std::string& table) const {
    sqlite::Database db(path, sqlite::Database::Mode::existing);
    std::vector<std::string> names;
    for (sqlite::Statement rows(db, "SELECT name FROM pragma_table_info('" + table + "')"); rows.step();)
      names.push_back(rows.text(0));  // without generated columns, which cannot be set
    return names;
  }
  TemporaryFolder folder;
  const std::string whole = folder.file("whole.sqlite"), path = folder.file("results.sqlite");
};

TEST_F(StoreSeals, HoldWhatWasStored) {
  EXPECT_EQ(ResultStore::open(path).load().points.size(), 3u);
  EXPECT_TRUE(ResultStore(path, "x = 1\n", Existing::resume).repair(3, any_point).empty());
  EXPECT_EQ(ResultStore::open(path).finished().size(), 3u);
}

// Seals of older stores must hold: a value is the bytes of it, however many of them are added at once.
TEST(Digest, OfAValueIsThatOfItsBytes) {
  const auto expect_same = [](const auto& value) {
    Digest of_value, of_bytes;
    of_value.text("before");
    of_bytes.text("before");
    of_value.value(value);
    of_bytes.bytes(&value, sizeof value);
    EXPECT_EQ(of_value.hex(), of_bytes.hex()) << +value << " of " << sizeof value << " bytes";
  };
  for (const int64_t value : {int64_t{0}, int64_t{1}, int64_t{255}, int64_t{256}, int64_t{-1}, int64_t{1} << 62}) {
    expect_same(value);
    expect_same(static_cast<int32_t>(value));
    expect_same(static_cast<uint64_t>(value));
    expect_same(static_cast<int16_t>(value));
    expect_same(static_cast<uint8_t>(value));
    expect_same(static_cast<int8_t>(value));
    expect_same(value != 0);
    expect_same(static_cast<double>(value));
  }
}

TEST_F(StoreSeals, NoticeARowWithoutANumber) {
  edit("UPDATE metrics SET point = 'one' WHERE point = 1 AND name = 'acne'");
  EXPECT_NE(refusal().find("holds data that Noonmark did not write"), std::string::npos);
}

TEST_F(StoreSeals, NoticeEveryCellOfAPoint) {
  int cells = 0;
  for (const char* table : {"finished", "settings", "metrics", "times", "curves", "curve_points", "pictures", "images"})
    for (const std::string& column : columns(table)) {
      SCOPED_TRACE(std::string(table) + "." + column);
      if (column == "point") continue;  // another test renumbers a point
      afresh();
      // Appends a digit to the value, in one row of point 1.
      edit("UPDATE " + std::string(table) + " SET " + column + " = coalesce(" + column +
           ", '') || '1' WHERE point = 1 AND " + columns(table)[1] + " = (SELECT max(" + columns(table)[1] + ") FROM " +
           table + " WHERE point = 1)");
      EXPECT_NE(refusal().find("rows of point 1 "), std::string::npos);
      ResultStore store(path, "x = 1\n", Existing::resume);
      EXPECT_EQ(store.repair(3, any_point).size(), 1u);
      EXPECT_EQ(store.finished(), (std::vector<int64_t>{0, 2}));
      store.add(sample_point(1));  // no old rows may be left
      EXPECT_TRUE(same(store.load().points.at(1), sample_point(1)));
      ++cells;
    }
  EXPECT_GT(cells, 40);
}

TEST_F(StoreSeals, NoticeEveryCellOfAPhaseDiagram) {
  int cells = 0;
  for (const std::string table : {"phases", "phase_rows", "phase_cells", "phase_points"})
    for (const std::string& column : columns(table)) {
      SCOPED_TRACE(table + "." + column);
      if (column == "phase") continue;
      afresh();
      std::string last;  // one row alone
      for (const std::string& key : columns(table))
        if (key == "row" || key == "i")
          last += " AND " + key + " = (SELECT max(" + key + ") FROM " + table + " WHERE phase = 1)";
      edit("UPDATE " + table + " SET " + column + " = coalesce(" + column + ", '') || '1' WHERE phase = 1" + last);
      EXPECT_NE(refusal().find("rows of phase diagram 1 "), std::string::npos);
      ResultStore store(path, "x = 1\n", Existing::resume);
      const auto any = [](int64_t, const PhaseDiagram&) { return true; };
      EXPECT_EQ(store.repair_phases(any).size(), 1u);
      EXPECT_EQ(store.phases(), std::vector<int64_t>{0});
      store.add_phase(1, sample_phase());  // no old rows may be left
      EXPECT_TRUE(same(store.load().phases.at(1), sample_phase()));
      EXPECT_EQ(store.finished().size(), 3u) << "no point is measured anew";
      ++cells;
    }
  EXPECT_GT(cells, 30);
}

TEST_F(StoreSeals, NoticeLostAndForeignRows) {
  for (const char* sql : {
           "DELETE FROM metrics WHERE point = 1 AND name = 'acne'",
           "DELETE FROM finished WHERE point = 1",
           "DELETE FROM curve_points WHERE point = 1",
           "DELETE FROM seals WHERE name = 'point 1'",
           "INSERT INTO metrics VALUES (1, 'another', 1)",
           "UPDATE metrics SET value = NULL WHERE point = 1 AND name = 'acne'",
       }) {
    SCOPED_TRACE(sql);
    afresh();
    edit(sql);
    EXPECT_NE(refusal().find("rows of point 1 "), std::string::npos);
    ResultStore store(path, "x = 1\n", Existing::resume);
    EXPECT_EQ(store.repair(3, any_point).size(), 1u);
    EXPECT_EQ(store.finished(), (std::vector<int64_t>{0, 2}));
    EXPECT_EQ(store.load().points.size(), 2u);
  }
  afresh();
  edit("INSERT INTO metrics VALUES (8, 'acne', 1)");
  EXPECT_NE(refusal().find("rows of point 8 "), std::string::npos);
  ResultStore store(path, "x = 1\n", Existing::resume);
  EXPECT_EQ(store.repair(3, any_point).size(), 1u);
  EXPECT_EQ(store.load().points.size(), 3u);
}

// If a point is moved to another number, its seal and its numbers move too, but the name in the seal does not fit.
TEST_F(StoreSeals, NoticeARenumberedPoint) {
  for (const char* table : {"finished", "settings", "metrics", "times", "curves", "curve_points", "pictures", "images",
                            "curve_windows", "worst_pixels", "cascades", "lookup_curves", "lookup_bounds"})
    edit("UPDATE " + std::string(table) + " SET point = 9 WHERE point = 1");
  edit("UPDATE seals SET name = 'point 9' WHERE name = 'point 1'");
  EXPECT_NE(refusal().find("rows of point 9 "), std::string::npos);
}

TEST_F(StoreSeals, NoticeAnEditedVerdict) {
  for (const char* sql : {"UPDATE bounds SET held = 1", "UPDATE laws SET held = 1 - held", "DELETE FROM bounds",
                          "UPDATE law_samples SET measured = 0 WHERE i = 0"}) {
    SCOPED_TRACE(sql);
    afresh();
    edit(sql);
    EXPECT_NE(refusal().find("bounds and laws"), std::string::npos);
    ResultStore store(path, "x = 1\n", Existing::resume);
    EXPECT_EQ(store.repair(3, any_point).size(), 1u);
    EXPECT_TRUE(store.load().bounds.empty()) << "the bounds must be judged again";
  }
}

TEST_F(StoreSeals, NoticeEditedFactsOfTheRun) {
  edit("UPDATE info SET value = '2' WHERE key = 'planned_points'");
  EXPECT_NE(refusal().find("facts of the run"), std::string::npos);
  ResultStore(path, "x = 1\n", Existing::resume).set_info(sample_info(), 3);  // every run begins with this
  EXPECT_EQ(ResultStore::open(path).load().planned_points, 3);
}

// A user who can write rows can also seal them. If such rows belong to no point, the error must report a damaged file,
// not a defect of Noonmark.
TEST_F(StoreSeals, SealedRowsThatDoNotFitTogetherAreADamagedFile) {
  for (const auto& [point, sql] :
       {std::pair(8, "INSERT INTO metrics VALUES (8, 'acne', 1)"),
        {8, "INSERT INTO curves (point) VALUES (8)"},
        {8, "INSERT INTO images VALUES (8, 0, 'a', 'b')"},
        {1, "UPDATE curves SET window_min_depth = 2, window_max_depth = 1 WHERE point = 1"}}) {
    SCOPED_TRACE(sql);
    afresh();
    edit(sql);
    {
      sqlite::Database db(path, sqlite::Database::Mode::existing);
      seal_point(db, point);
    }
    EXPECT_NE(refusal().find("holds data that Noonmark did not write"), std::string::npos);
    ResultStore store(path, "x = 1\n", Existing::resume);
    expect_refused(ErrorKind::file, {"--overwrite"}, [&] { store.repair(3, any_point); });
  }
}

TEST_F(StoreSeals, RemoveWhatTheExperimentDoesNotExpect) {
  ResultStore store(path, "x = 1\n", Existing::resume);
  const auto only_two = [](const PointRecord& point) { return point.id != 2; };
  EXPECT_EQ(store.repair(3, only_two).size(), 1u);
  EXPECT_EQ(store.finished(), (std::vector<int64_t>{0, 1}));
}

}  // namespace
}  // namespace noonmark
