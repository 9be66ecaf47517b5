// The row of a table that has a name.
//
//   const Filter& filter = find_row(filters(), "box", "filter");
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>

namespace noonmark {

// what: what a row is, for the message. Throws std::logic_error if no row has that name: a name that a user gives is checked
// before.
template <class Rows>
const auto& find_row(const Rows& rows, std::string_view name, const char* what) {
  for (const auto& row : rows)
    if (row.name == name) return row;
  throw std::logic_error("there is no " + std::string(what) + " '" + std::string(name) + "'");
}

}  // namespace noonmark
