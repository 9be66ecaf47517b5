// The part of SQLite that the store needs: an owned connection, owned statements, errors as exceptions.
//
//   sqlite::Statement insert(db, "INSERT INTO metrics VALUES (?, ?, ?)");
//   insert.run(id, name, value);
//   for (sqlite::Statement rows(db, "SELECT name, value FROM metrics"); rows.step();) use(rows.text(0), rows.real(1));
//
// A NaN is written as NULL, because SQLite has no NaN, and NULL is read back as NaN. A column of REAL loses the sign of
// a zero. Infinities and all other doubles come back bit for bit.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

struct sqlite3;
struct sqlite3_stmt;

namespace noonmark {
class Digest;
}

namespace noonmark::sqlite {

class Database {
 public:
  enum class Mode { create, existing };
  // Throws Error(file) if the file cannot be opened or is not a regular file (reading a pipe would wait without end).
  // The same holds for the files that SQLite keeps beside it; those must not be links either.
  Database(const std::string& path, Mode mode);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  // Throws Error(file) if the path leads to another file than when it was opened, or to none: the file or its folder was renamed,
  // replaced or removed. SQLite would go on writing into the file, wherever it is now.
  void require_in_place() const;

  // One or more statements without results.
  void execute(const std::string& sql);
  // Returns the first column of the first row, or empty if there is no row.
  std::optional<std::string> ask(const std::string& sql);

  // Throws Error(file) with SQLite's message for `code` and what to do.
  [[noreturn]] void fail(int code, std::string_view doing) const;

  // The advice for a file that is not a store of Noonmark, or is a damaged one.
  std::string_view way_out() const;

  const std::string& path() const { return path_; }
  sqlite3* handle() const { return handle_; }

 private:
  friend class Statement;
  // Statements with parameters are compiled once and then lent to one Statement after the other, because compiling the
  // statements of a point takes longer than running them. null: none is free.
  sqlite3_stmt* take(const std::string& sql);
  void give_back(const std::string& sql, sqlite3_stmt* statement);
  std::unordered_map<std::string, sqlite3_stmt*> free_;

  std::string path_;
  Mode mode_;
  sqlite3* handle_ = nullptr;
  uint64_t device_ = 0, inode_ = 0;  // 0: it has no file
};

// All statements between begin and commit take effect, or none. Rolled back if destroyed before commit.
class Transaction {
 public:
  explicit Transaction(Database& db) : db_(db) {
    db_.require_in_place();
    db_.execute("BEGIN IMMEDIATE");
  }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& db_;
  bool open_ = true;
};

class Statement {
 public:
  Statement(Database& db, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  // Binds the values in order and executes. Then the statement can run again.
  template <class... Values>
  void run(const Values&... values) {
    int index = 0;
    (bind(++index, values), ...);
    finish();
  }

  void bind(int index, int64_t value);
  void bind(int index, int value) { bind(index, static_cast<int64_t>(value)); }
  void bind(int index, double value);
  void bind(int index, std::string_view value);
  void bind(int index, const std::string& value) { bind(index, std::string_view(value)); }
  void bind(int index, const char* value) { bind(index, std::string_view(value)); }
  void bind_bytes(int index, std::string_view value);        // a BLOB; text() reads it
  void bind(int index, const std::optional<double>& value);  // empty: NULL; NaN: the text "nan"

  // Moves to the next row. Returns false after the last.
  bool step();
  bool null(int column) const;
  int64_t integer(int column) const;
  double real(int column) const;  // NULL and text: NaN
  std::string text(int column) const { return std::string(text_view(column)); }
  std::string_view text_view(int column) const;  // valid until the next step
  bool is_integer(int column) const;             // not text, a real or NULL
  // Adds every column with its type.
  void add_to(Digest& digest) const;

 private:
  void finish();
  void check(int code, std::string_view doing) const;
  Database& db_;
  std::string sql_;
  sqlite3_stmt* handle_ = nullptr;
};

}  // namespace noonmark::sqlite
