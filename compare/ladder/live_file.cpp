#include "compare/ladder/live_file.h"

#include <algorithm>
#include <cmath>

#include "compare/ladder/ladder.h"
#include "compare/ladder/live_arrays.h"

namespace noonmark {

uint8_t live_cosine(float n_dot_l) { return static_cast<uint8_t>(std::lround(255 * std::clamp(n_dot_l, 0.0f, 1.0f))); }

std::string live_head(nlohmann::ordered_json head) {
  for (int cause = 0; cause < cause_count; ++cause) head["causes"].push_back(cause_name(static_cast<Cause>(cause)));
  std::string line = head.dump();
  line.append(3 - line.size() % 4, ' ');  // with the line's end a multiple of 4, so that the floats are aligned
  return line + '\n';
}

}  // namespace noonmark
