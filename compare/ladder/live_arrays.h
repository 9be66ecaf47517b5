// Writes the files of the report's live pictures (compare/ladder/live_file.h).
//
//   std::string file = live_head({{"kind", "stack"}, {"width", 320}});
//   append_array(file, lights);
#pragma once
#include <bit>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace noonmark {

static_assert(std::endian::native == std::endian::little, "the file's arrays are written as they lie in memory");

// Adds the names of the built-in causes to the head of a file, and ends its line.
std::string live_head(nlohmann::ordered_json head);

template <class T>
void append_array(std::string& file, const std::vector<T>& values) {
  file.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

}  // namespace noonmark
