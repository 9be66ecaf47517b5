// A list of words as one text, for lists in which a line for each word says nothing.
#pragma once
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace noonmark::test {

// The words of the text, which blanks and line ends separate.
inline std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

}  // namespace noonmark::test
