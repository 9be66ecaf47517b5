#include "compare/store/sqlite.h"

#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "base/digest.h"
#include "base/error.h"
#include "base/system_error.h"

namespace noonmark::sqlite {
namespace {

// How long to wait for a reader, such as a query of an analyst, to release the file.
constexpr int busy_timeout_ms = 30000;

// way_out: from Database::way_out().
std::string advice(int code, std::string_view way_out) {
  switch (code & 0xff) {
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
      return std::string(way_out);
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program holds it; wait for it to end";
    case SQLITE_FULL:
      return "make room on the disk and run again; finished points are kept";
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      return "check that its folder exists and may be written to";
    default:
      return "check the disk";
  }
}

// SQLite opens these files by itself, beside the file that a link leads to. It would wait without end for a pipe.
void require_files_beside(const std::string& path, std::string_view way_out) {
  namespace fs = std::filesystem;
  std::error_code none;
  for (const fs::path& file : {fs::path(path), fs::canonical(path, none)}) {
    for (const char* ending : {"-journal", "-wal", "-shm"}) {
      const std::string beside = file.native() + ending;
      const fs::file_status status = fs::symlink_status(beside, none);
      if (!file.empty() && fs::exists(status) && !fs::is_regular_file(status))
        throw Error(ErrorKind::file, fmt::format("{}: is not a regular file; {}", beside, way_out));
    }
  }
}

}  // namespace

Database::Database(const std::string& path, Mode mode) : path_(path), mode_(mode) {
  std::error_code none;
  const auto status = std::filesystem::status(path, none);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw Error(ErrorKind::file, fmt::format("{}: is not a regular file; {}", path, way_out()));
  require_files_beside(path, way_out());
  // Without SQLite's own locks against other threads: each column that is read would take one. No two threads use one
  // connection at the same time.
  const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX | (mode == Mode::create ? SQLITE_OPEN_CREATE : 0);
  const int code = sqlite3_open_v2(path.c_str(), &handle_, flags, nullptr);
  if (code != SQLITE_OK) {
    // A failed open leaves a handle that must be closed here, because the destructor does not run.
    const std::string what = handle_ ? sqlite3_errmsg(handle_) : sqlite3_errstr(code);
    const int system = handle_ ? sqlite3_system_errno(handle_) : 0;
    sqlite3_close(handle_);
    throw Error(kind_of_failure(system), fmt::format("{}: cannot be opened: {}; {}", path, what,
                                                     advice_on_failure(system, advice(code, way_out()).c_str())));
  }
  if (struct stat found{}; ::stat(path.c_str(), &found) == 0) device_ = found.st_dev, inode_ = found.st_ino;
  sqlite3_extended_result_codes(handle_, 1);
  sqlite3_busy_timeout(handle_, busy_timeout_ms);
  // The file may come from anyone. These options keep its contents from running by themselves, and statements from
  // damaging it.
  for (const auto& [option, on] : {std::pair{SQLITE_DBCONFIG_DEFENSIVE, 1},
                                   {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
                                   {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0}})
    sqlite3_db_config(handle_, option, on, nullptr);
}

std::string_view Database::way_out() const {
  return mode_ == Mode::create ? "choose another --out, or pass --overwrite to replace it"
                               : "run the experiment into this folder again, with --overwrite";
}

Database::~Database() {
  for (const auto& [sql, statement] : free_) sqlite3_finalize(statement);
  sqlite3_close(handle_);
}

sqlite3_stmt* Database::take(const std::string& sql) {
  const auto found = free_.find(sql);
  if (found == free_.end()) return nullptr;
  sqlite3_stmt* const statement = found->second;
  free_.erase(found);
  return statement;
}

void Database::give_back(const std::string& sql, sqlite3_stmt* statement) {
  constexpr size_t most_free = 64;
  sqlite3_reset(statement);
  sqlite3_clear_bindings(statement);
  if (sqlite3_bind_parameter_count(statement) == 0 || free_.size() >= most_free ||
      !free_.emplace(sql, statement).second)
    sqlite3_finalize(statement);
}

void Database::require_in_place() const {
  struct stat found {};
  if (inode_ == 0 || (::stat(path_.c_str(), &found) == 0 && found.st_dev == device_ && found.st_ino == inode_)) return;
  throw Error(ErrorKind::file,
              fmt::format("{}: is no longer the file that this run writes: it or its folder was renamed, replaced or "
                          "removed meanwhile. What was measured is in that file; put it back, or run the command again",
                          path_));
}

void Database::execute(const std::string& sql) {
  const int code = sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code, "cannot be used");
}

std::optional<std::string> Database::ask(const std::string& sql) {
  Statement statement(*this, sql);
  if (!statement.step()) return std::nullopt;
  return statement.text(0);
}

void Database::fail(int code, std::string_view doing) const {
  const int system = (code & 0xff) == SQLITE_CANTOPEN ? sqlite3_system_errno(handle_) : 0;
  throw Error(kind_of_failure(system), fmt::format("{}: {}: {}; {}", path_, doing, sqlite3_errmsg(handle_),
                                                   advice_on_failure(system, advice(code, way_out()).c_str())));
}

Transaction::~Transaction() {
  // After some errors SQLite has rolled back by itself. Then this statement has no effect.
  if (open_) sqlite3_exec(db_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  db_.execute("COMMIT");
  open_ = false;
}

Statement::Statement(Database& db, const std::string& sql) : db_(db), sql_(sql), handle_(db.take(sql)) {
  if (handle_) return;
  check(sqlite3_prepare_v2(db.handle(), sql.c_str(), static_cast<int>(sql.size()), &handle_, nullptr),
        "cannot be read");
}

Statement::~Statement() { db_.give_back(sql_, handle_); }

void Statement::check(int code, std::string_view doing) const {
  if (code != SQLITE_OK) db_.fail(code, doing);
}

void Statement::bind(int index, int64_t value) {
  check(sqlite3_bind_int64(handle_, index, value), "cannot be written");
}
void Statement::bind(int index, double value) {
  check(sqlite3_bind_double(handle_, index, value), "cannot be written");
}
void Statement::bind(int index, std::string_view value) {
  check(sqlite3_bind_text64(handle_, index, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8),
        "cannot be written");
}
void Statement::bind_bytes(int index, std::string_view value) {
  check(sqlite3_bind_blob64(handle_, index, value.data(), value.size(), SQLITE_TRANSIENT), "cannot be written");
}
void Statement::bind(int index, const std::optional<double>& value) {
  if (value && std::isnan(*value))
    bind(index, std::string_view("nan"));  // SQLite stores a NaN as NULL, and NULL means that there is no value
  else if (value)
    bind(index, *value);
  else
    check(sqlite3_bind_null(handle_, index), "cannot be written");
}

bool Statement::step() {
  const int code = sqlite3_step(handle_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) db_.fail(code, "cannot be read");
  return false;
}

void Statement::finish() {
  const int code = sqlite3_step(handle_);
  const int reset = sqlite3_reset(handle_);
  if (code != SQLITE_DONE) db_.fail(reset, "cannot be written");
}

bool Statement::null(int column) const { return sqlite3_column_type(handle_, column) == SQLITE_NULL; }
int64_t Statement::integer(int column) const { return sqlite3_column_int64(handle_, column); }
double Statement::real(int column) const {
  sqlite3_value* const value = sqlite3_column_value(handle_, column);
  const int type = sqlite3_value_type(value);
  return type == SQLITE_FLOAT || type == SQLITE_INTEGER ? sqlite3_value_double(value)
                                                        : std::numeric_limits<double>::quiet_NaN();
}
std::string_view Statement::text_view(int column) const {
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
  return data ? std::string_view(data, static_cast<size_t>(sqlite3_column_bytes(handle_, column))) : std::string_view();
}
bool Statement::is_integer(int column) const { return sqlite3_column_type(handle_, column) == SQLITE_INTEGER; }

void Statement::add_to(Digest& digest) const {
  const int columns = sqlite3_column_count(handle_);
  digest.value(columns);
  for (int column = 0; column < columns; ++column) {
    // The value is asked for once, because each sqlite3_column_...() looks the column up again. Without SQLite's locks
    // (Database) it may be read like any other.
    sqlite3_value* const value = sqlite3_column_value(handle_, column);
    const int type = sqlite3_value_type(value);
    digest.value(type);
    if (type == SQLITE_INTEGER) {
      digest.value(int64_t{sqlite3_value_int64(value)});
    } else if (type == SQLITE_FLOAT) {
      digest.value(sqlite3_value_double(value));
    } else if (type != SQLITE_NULL) {
      const auto* const text = reinterpret_cast<const char*>(sqlite3_value_text(value));
      digest.text(text ? std::string_view(text, static_cast<size_t>(sqlite3_value_bytes(value))) : std::string_view());
    }
  }
}

}  // namespace noonmark::sqlite
