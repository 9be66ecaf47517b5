// A table of the store for one kind of record, described once. Each column has a name, a type and a member. The SQL
// that makes, writes and reads the table is made from the columns.
//
//   const Table<PictureRecord> pictures("pictures", {"point", "i"}, {column("name", &PictureRecord::name)});
//   db.execute(pictures.create());
//   Table<PictureRecord>::Insert insert(db, pictures);
//   insert.row({7, 0}, record);
//   pictures.read(db, [](std::span<const int64_t> key, PictureRecord record) { print(key[0], record.name); });
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "compare/store/sqlite.h"

namespace noonmark {

template <class Record>
struct Column {
  std::string_view name;
  std::string_view type;  // of SQL
  std::function<void(sqlite::Statement&, int, const Record&)> bind;
  std::function<void(const sqlite::Statement&, int, Record&)> read;
};

// member: text, a double, an optional double, an integer or a bool.
template <class Record, class Member>
Column<Record> column(std::string_view name, Member Record::*member) {
  constexpr bool is_text = std::is_same_v<Member, std::string>;
  constexpr bool is_real = std::is_same_v<Member, double> || std::is_same_v<Member, std::optional<double>>;
  return {name,
          is_text   ? "TEXT"
          : is_real ? "REAL"
                    : "INTEGER",
          [member](sqlite::Statement& row, int index, const Record& record) {
            if constexpr (is_text || is_real)
              row.bind(index, record.*member);
            else
              row.bind(index, static_cast<int64_t>(record.*member));
          },
          [member](const sqlite::Statement& row, int index, Record& record) {
            if constexpr (is_text)
              record.*member = row.text(index);
            else if constexpr (std::is_same_v<Member, std::optional<double>>)
              record.*member = row.null(index) ? std::nullopt : std::optional(row.real(index));
            else if constexpr (is_real)
              record.*member = row.real(index);
            else if constexpr (std::is_same_v<Member, bool>)
              record.*member = row.integer(index) != 0;
            else
              record.*member = static_cast<Member>(row.integer(index));
          }};
}

template <class Record>
class Table {
 public:
  // keys: the integers with which each row begins. No two rows have the same keys.
  Table(std::string_view name, std::vector<std::string_view> keys, std::vector<Column<Record>> columns)
      : name_(name), keys_(std::move(keys)), columns_(std::move(columns)) {}

  // before_columns: white space. A store holds the text that made its tables, and check_store() compares it.
  std::string create(std::string_view before_columns = "") const {
    std::string sql = fmt::format("CREATE TABLE {} ({}", name_, before_columns);
    for (std::string_view key : keys_)
      sql += fmt::format("{} INTEGER{}, ", key, keys_.size() == 1 ? " PRIMARY KEY" : "");
    for (size_t i = 0; i < columns_.size(); ++i)
      sql += fmt::format("{}{} {}", i ? ", " : "", columns_[i].name, columns_[i].type);
    if (keys_.size() == 1) return sql + ");\n";
    return sql + fmt::format(", PRIMARY KEY ({})) WITHOUT ROWID;\n", fmt::join(keys_, ", "));
  }

  class Insert {
   public:
    Insert(sqlite::Database& db, const Table& table) : table_(table), statement_(db, table.insert_sql()) {}
    void row(std::initializer_list<int64_t> key, const Record& record) {
      int index = 0;
      for (int64_t k : key) statement_.bind(++index, k);
      for (const Column<Record>& column : table_.columns_) column.bind(statement_, ++index, record);
      statement_.run();
    }

   private:
    const Table& table_;
    sqlite::Statement statement_;
  };

  // Calls use(key, record) for each row, ordered by key.
  template <class Use>
  void read(sqlite::Database& db, const Use& use) const {
    std::vector<int64_t> key(keys_.size());
    for (sqlite::Statement row(db,
                               fmt::format("SELECT {} FROM {} ORDER BY {}", names(), name_, fmt::join(keys_, ", ")));
         row.step();) {
      int index = 0;
      for (int64_t& k : key) k = row.integer(index++);
      use(std::span<const int64_t>(key), record_of(row));
    }
  }

  // The record of a row that has all columns of the table, in its order.
  Record record_of(const sqlite::Statement& row) const {
    Record record;
    auto index = static_cast<int>(keys_.size());
    for (const Column<Record>& column : columns_) column.read(row, index++, record);
    return record;
  }

 private:
  std::string names() const {
    std::string list = fmt::format("{}", fmt::join(keys_, ", "));
    for (const Column<Record>& column : columns_) list += fmt::format(", {}", column.name);
    return list;
  }
  std::string insert_sql() const {
    std::string values = "?";
    for (size_t i = 1; i < keys_.size() + columns_.size(); ++i) values += ", ?";
    return fmt::format("INSERT INTO {} ({}) VALUES ({})", name_, names(), values);
  }

  std::string_view name_;
  std::vector<std::string_view> keys_;
  std::vector<Column<Record>> columns_;
};

}  // namespace noonmark
