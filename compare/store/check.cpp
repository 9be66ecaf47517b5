#include "compare/store/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "compare/store/schema.h"
#include "compare/store/sqlite.h"

namespace noonmark {
namespace {

using sqlite::Database;
using sqlite::Statement;

constexpr size_t most_differences = 5;  // the most that one message names
constexpr size_t longest_name = 60;     // in characters; a foreign name can have any length

// "table metrics" -> the table that it belongs to, and its SQL.
using Schema = std::multimap<std::string, std::string>;

Schema schema_of(Database& db) {
  Schema schema;
  for (Statement rows(db, "SELECT type, name, tbl_name, sql FROM sqlite_schema"); rows.step();)
    schema.emplace(fmt::format("{} {}", rows.text(0), rows.text(1)), rows.text(2) + "\n" + rows.text(3));
  return schema;
}

const Schema& own_schema() {
  static const Schema own = [] {
    Database db(":memory:", Database::Mode::create);
    db.execute(store_schema());
    return schema_of(db);
  }();
  return own;
}

// Empty if the schema is that of this Noonmark.
std::string difference(const Schema& there) {
  const Schema& own = own_schema();
  std::vector<std::string> all;
  const auto say = [&](const std::string& name, const char* what) {
    all.push_back(fmt::format("{}{} {}", name.substr(0, longest_name), name.size() > longest_name ? "..." : "", what));
  };
  for (auto one = there.begin(); one != there.end(); one = there.upper_bound(one->first)) {
    const auto ours = own.find(one->first);
    if (ours == own.end())
      say(one->first, "is foreign");
    else if (there.count(one->first) > 1 || one->second != ours->second)
      say(one->first, "is different");
  }
  for (const auto& [name, sql] : own)
    if (!there.contains(name)) say(name, "is lost");
  if (all.size() > most_differences) {
    const size_t more = all.size() - most_differences;
    all.resize(most_differences);
    all.push_back(fmt::format("{} more", more));
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

// SQLite's text begins with the headline "*** in database main ***".
std::string first_finding(const std::string& text) {
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    if (end > begin && !text.substr(begin, end - begin).starts_with("***")) return text.substr(begin, end - begin);
    begin = end + 1;
  }
  return text;
}

}  // namespace

void check_tables(Database& db) {
  if (db.ask("PRAGMA application_id") != std::to_string(store_application_id))
    throw Error(ErrorKind::file,
                fmt::format("{}: is a database, but not one of Noonmark's results; {}", db.path(), db.way_out()));
  if (const std::string version = db.ask("PRAGMA user_version").value_or("?"); version != std::to_string(store_version))
    throw Error(ErrorKind::usage,
                fmt::format("{}: was written by another version of Noonmark (store version {}, not {}); {}", db.path(),
                            version, store_version, db.way_out()));
  // Checked before any row is read, because a view in a table's place can be endless.
  if (const std::string found = difference(schema_of(db)); !found.empty())
    throw Error(ErrorKind::file, fmt::format("{}: holds other tables than the ones that this Noonmark makes ({}); {}",
                                             db.path(), found, db.way_out()));
}

void check_store(Database& db) {
  check_tables(db);
  // integrity_check and not quick_check, because quick_check does not look at the order of rows, and a search does not
  // find rows that are out of order.
  if (const std::string found = db.ask("PRAGMA integrity_check(1)").value_or("?"); found != "ok")
    throw Error(ErrorKind::file, fmt::format("{}: is damaged: {}; {}", db.path(), first_finding(found), db.way_out()));
}

}  // namespace noonmark
