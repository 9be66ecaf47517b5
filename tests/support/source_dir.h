// Where the sources are. It is compiled into one file only, so that a compiler cache serves the tests of any clone.
#pragma once
#include <string>

namespace noonmark::test {

std::string source_dir();  // without a "/" at its end

}  // namespace noonmark::test
