#include <fmt/format.h>

#include "app/definition/experiment_schema.h"
#include "app/verbs/verbs.h"

namespace noonmark {

int verb_schema() {
  fmt::print("{}", experiment_schema());
  return 0;
}

}  // namespace noonmark
