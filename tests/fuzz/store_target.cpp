// The input is the bytes of results.sqlite. They are opened and written as `noonmark report` does, and as `check`
// writes its verdict. The result must be one Error that says what is wrong with the file, or complete files. The bytes
// are mutated as a database (rows and columns changed, dropped, doubled; most are sealed again, so that the rows are
// read) and as bytes. The mutator plants text that is markup unless a writer escapes it.
#include <fmt/format.h>
#include <sqlite3.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "compare/judge/bounds.h"
#include "compare/judge/law_table.h"
#include "compare/judge/laws.h"
#include "compare/report/csv.h"
#include "compare/report/junit.h"
#include "compare/report/report.h"
#include "compare/report/summary.h"
#include "compare/store/seals.h"
#include "compare/store/sqlite.h"
#include "compare/store/store.h"
#include "tests/compare/report/sample.h"
#include "tests/fuzz/targets.h"
#include "tests/support/sample_results.h"

namespace noonmark::fuzz {
namespace {

// The program itself never writes this text. Every writer must escape its first character.
constexpr std::string_view markup = "<fuzzed>";

Folder& folder() {
  static Folder one;
  return one;
}

// The path of a new database. Files that an earlier database of this name left beside it are removed.
std::string written(const std::string& name, const std::string& bytes) {
  folder().write(name, bytes);
  for (const char* rest : {"-journal", "-wal", "-shm"}) ::unlink(folder().file(name + rest).c_str());
  return folder().file(name);
}

// RFC 4180: every row has as many fields as the first.
void require_csv(const std::string& csv) {
  size_t fields = 1, first = 0;
  bool quoted = false;
  for (size_t i = 0; i < csv.size(); ++i) {
    if (csv[i] == '"') quoted = !quoted;
    if (quoted) continue;
    if (csv[i] == ',') ++fields;
    if (csv[i] != '\n') continue;
    if (first == 0) first = fields;
    require(fields == first, "a row of the CSV with another number of fields");
    fields = 1;
  }
  require(!quoted, "a quote of the CSV that does not end");
}

void require_no_markup(const std::string& text, const char* what) {
  require(text.find(markup) == std::string::npos, std::string("markup from the store goes unescaped into the ") + what);
}

void require_report(const std::string& html) {
  require_no_markup(html, "report");
  constexpr std::string_view head = "id=\"noonmark-data\">";
  require(html.find(head) != std::string::npos, "the report has no data");
  const size_t begin = html.find(head) + head.size();
  const std::string data = html.substr(begin, html.find("</script>", begin) - begin);
  require(nlohmann::json::accept(data), "the report's data are no JSON");
}

void run(const std::string& bytes) {
  const std::string path = written("results.sqlite", bytes);
  try {
    const Results results = ResultStore::open(path).load();
    const std::string html = render_report(results, [](const std::string& picture) { return sample_picture(picture); });
    require_report(html);
    for (const CsvColumns columns : {CsvColumns::asked, CsvColumns::all}) require_csv(to_csv(results, columns));
    require_no_markup(to_junit(results), "JUnit file");
    to_summary(results);
    law_table(results.laws);
    for (const BoundResult& bound : results.bounds)
      describe(bound, find_point(results.points, bound.point), results.info.swept);
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::file || error.kind() == ErrorKind::usage,
            std::string("an error of another kind: ") + error.what());
    require(*error.what() != '\0', "an error without a message");
  }
}

// The store of a small sweep. `compact`: with small pages and without the legend, so that most edits hit data that is
// read.
std::string store_bytes(int points, bool compact) {
  const std::string path = folder().file("seed.sqlite");
  {
    ResultStore store(path, "a = 1\nb = 2\n", Existing::overwrite);
    store.set_info(sample_info(), points + 1);
    for (int id = 0; id < points; ++id) store.add(sample_point(id, id != 1));
    BoundResult bound;
    bound.metric = "acne";
    bound.max = 0.01;
    bound.where = {{"map.resolution", {"256", "512"}}};
    bound.join = "worst";
    bound.point = 1;
    bound.points = points;
    bound.found = 0.5;
    bound.reproduce = "noonmark render x.toml --point 1";
    store.set_bounds({bound});
    store.set_laws({sample_law()});
    store.add_phase(0, sample_phase());
  }
  if (compact) {
    sqlite3* db = nullptr;
    const bool done =
        sqlite3_open(path.c_str(), &db) == SQLITE_OK &&
        sqlite3_exec(db, "DELETE FROM columns; PRAGMA page_size = 512; VACUUM", nullptr, nullptr, nullptr) == SQLITE_OK;
    sqlite3_close(db);
    require(done, "the seed cannot be made compact");
  }
  return read_file(path);
}

std::vector<std::string> seeds() { return {store_bytes(3, true), store_bytes(1, true), store_bytes(0, true)}; }

std::vector<std::string> words() {
  return {"SQLite format 3",
          "CREATE TABLE",
          "info",
          "finished",
          "settings",
          "metrics",
          "curves",
          "curve_points",
          "pictures",
          "images",
          "bounds",
          "laws",
          "law_samples",
          std::string(markup),
          "nan",
          "auto",
          "[]",
          "{}",
          "null"};
}

// ---- damage as a database

std::string odd_sql_value(Random& random) {
  static const std::vector<std::string> odd = {"NULL",
                                               "0",
                                               "1",
                                               "-1",
                                               "2",
                                               "1e308",
                                               "-1e308",
                                               "9e999",
                                               "-9e999",
                                               "1e-320",
                                               "9223372036854775807",
                                               "-9223372036854775808",
                                               "4294967296",
                                               "''",
                                               "'auto'",
                                               "'nan'",
                                               "x'00ff80'",
                                               "'[]'",
                                               "'{}'",
                                               "'['",
                                               "'[1]'",
                                               "'{\"a\":[\"b\"]}'",
                                               "'<fuzzed>'",
                                               "'</script><fuzzed>'",
                                               "'\"><fuzzed>'",
                                               "']]><fuzzed>'",
                                               "'=1+1,\"x'",
                                               "'../../outside'",
                                               "'/etc/hostname'",
                                               "char(0)",
                                               "char(27)||'[2J'",
                                               "char(10,13)",
                                               "'acne'",
                                               "'map.resolution'",
                                               "'filter.kind'",
                                               "'bias.constant'",
                                               "'512'",
                                               "'1e999'",
                                               "'-'",
                                               "'slope over map.resolution'",
                                               "'<='",
                                               "'='",
                                               "'99999999999999999999'",
                                               "'x'||hex(zeroblob(300))",
                                               "random()",
                                               "0.5"};
  return odd[below(random, odd.size())];
}

// A view of a damaged schema may never end.
void forbid_endless(sqlite3* db) {
  sqlite3_progress_handler(
      db, 100000, [](void*) { return 1; }, nullptr);
}

class Scratch {
 public:
  // A database in memory, initialised with `bytes`.
  explicit Scratch(const std::string& bytes) {
    require(sqlite3_open(":memory:", &db_) == SQLITE_OK, "no database in memory");
    auto* copy = static_cast<unsigned char*>(sqlite3_malloc64(bytes.size() + 1));
    require(copy != nullptr, "no memory");
    std::memcpy(copy, bytes.data(), bytes.size());
    const auto size = static_cast<sqlite3_int64>(bytes.size());
    sqlite3_deserialize(db_, "main", copy, size, size, SQLITE_DESERIALIZE_FREEONCLOSE | SQLITE_DESERIALIZE_RESIZEABLE);
    forbid_endless(db_);
  }
  ~Scratch() { sqlite3_close(db_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  // Errors are ignored, because a statement may fail on a damaged database.
  void execute(const std::string& sql) { sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr); }

  // The first column of every row.
  std::vector<std::string> list(const std::string& sql) {
    std::vector<std::string> all;
    const auto add = [](void* to, int, char** values, char**) {
      if (values[0]) static_cast<std::vector<std::string>*>(to)->emplace_back(values[0]);
      return 0;
    };
    sqlite3_exec(db_, sql.c_str(), add, &all, nullptr);
    return all;
  }

  std::string bytes() const {
    sqlite3_int64 size = 0;
    unsigned char* data = sqlite3_serialize(db_, "main", &size, 0);
    if (!data) return "";
    std::string out(reinterpret_cast<const char*>(data), static_cast<size_t>(size));
    sqlite3_free(data);
    return out;
  }

 private:
  sqlite3* db_ = nullptr;
};

void edit_database(Scratch& db, Random& random) {
  const std::vector<std::string> tables =
      db.list("SELECT name FROM sqlite_schema WHERE type = 'table' AND name <> 'columns'");
  if (tables.empty()) return;
  const std::string table = "\"" + tables[below(random, tables.size())] + "\"";
  const std::vector<std::string> columns = db.list(fmt::format("SELECT name FROM pragma_table_info({})", table));
  if (columns.empty()) return;
  const auto any_column = [&] { return "\"" + columns[below(random, columns.size())] + "\""; };
  const size_t row = below(random, 24);
  const std::string key = any_column(), target = any_column();
  const std::string one_row =
      below(random, 4) == 0 ? ""
                            : fmt::format(" WHERE {0} IS (SELECT {0} FROM {1} LIMIT 1 OFFSET {2})", key, table, row);
  switch (below(random, 8)) {
    case 0:
      return db.execute(fmt::format("DELETE FROM {}{}", table, one_row));
    case 1: {  // a copy of a row, with another value in one place
      std::string values;
      for (const std::string& column : columns)
        values += fmt::format("{}{}", values.empty() ? "" : ", ",
                              below(random, columns.size()) == 0 ? odd_sql_value(random) : "\"" + column + "\"");
      return db.execute(
          fmt::format("INSERT OR REPLACE INTO {0} SELECT {1} FROM {0} LIMIT 1 OFFSET {2}", table, values, row));
    }
    case 2:
      return db.execute(fmt::format("UPDATE OR REPLACE {0} SET {1} = (SELECT {2} FROM {0} LIMIT 1 OFFSET {3}){4}",
                                    table, target, key, below(random, 24), one_row));
    case 3:
      if (below(random, 4) != 0) return;
      return db.execute(below(random, 2) == 0 ? "DROP TABLE " + table
                                              : fmt::format("ALTER TABLE {} RENAME COLUMN {} TO other", table, target));
    case 4:
      if (below(random, 4) != 0) return;
      return db.execute(fmt::format("PRAGMA {} = {}", below(random, 2) == 0 ? "user_version" : "application_id",
                                    static_cast<int>(random() % 5)));
    default:
      return db.execute(
          fmt::format("UPDATE OR REPLACE {} SET {} = {}{}", table, target, odd_sql_value(random), one_row));
  }
}

// The same rows, sealed again as if the program had written them. Otherwise an edited store is refused before its
// values are read. If the store is too damaged to be sealed, the bytes stay as they are.
std::string sealed(const std::string& bytes) {
  const std::string path = written("sealed.sqlite", bytes);
  try {
    sqlite::Database db(path, sqlite::Database::Mode::existing);
    forbid_endless(db.handle());
    db.execute("PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF");
    sqlite::Transaction all(db);
    for (int64_t point : broken_points(db)) seal_point(db, point);
    for (int64_t phase : broken_phases(db)) seal_phase(db, phase);
    seal_info(db);
    seal_verdict(db);
    all.commit();
  } catch (const Error&) {
    return bytes;
  }
  return read_file(path);
}

std::string edited(const std::string& bytes, Random& random, const EditBytes& edit) {
  if (!bytes.starts_with("SQLite format 3") || below(random, 8) == 0) return edit(bytes, random);
  Scratch db(bytes);
  for (size_t edits = 1 + below(random, 4); edits > 0; --edits) edit_database(db, random);
  const std::string next = db.bytes();
  return next.empty() ? edit(bytes, random) : next;
}

std::string mutate(const std::string& bytes, Random& random, const EditBytes& edit) {
  const std::string next = edited(bytes, random, edit);
  return below(random, 4) == 0 ? next : sealed(next);
}

}  // namespace

const Target store_target = {"store", run, seeds, words, mutate};

}  // namespace noonmark::fuzz
