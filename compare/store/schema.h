// The tables of results.sqlite, as SQL.
#pragma once
#include <string>

namespace noonmark {

// "NnMk": marks a SQLite file as ours.
constexpr int store_application_id = 0x4e6e4d6b;
// Counts changes of the tables below. A store of another version is refused. (So is one whose schema differs by an
// edit, or because another build has other settings or metrics in the view `points`: compare/store/check.h.)
constexpr int store_version = 6;

// Tables, the view `points` and its legend `columns`, for an empty database.
std::string store_schema();

}  // namespace noonmark
