#include "tests/support/source_dir.h"

namespace noonmark::test {

std::string source_dir() { return NOONMARK_SOURCE_DIR; }

}  // namespace noonmark::test
