// The tables of results.sqlite, as SQL.
#pragma once
#include <cstdint>
#include <string>

namespace noonmark {

// "NnMk": marks a SQLite file as Noonmark's.
constexpr int store_application_id = 0x4e6e4d6b;
// Counts the changes of the tables below. A store of another version is refused. A store whose schema differs for
// another reason is refused too: it was edited, or another build has other settings or metrics in the view `points`
// (compare/store/check.h).
constexpr int store_version = 22;

// Points that the present experiment does not have keep their rows, under ids from here on (ResultStore::replace).
constexpr int64_t first_aside = 1'000'000'000'000;

// The SQL that makes the tables, the view `points` and its legend `columns` in an empty database.
std::string store_schema();

}  // namespace noonmark
