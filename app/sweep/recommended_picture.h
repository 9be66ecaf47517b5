// The pictures with which a report opens where it recommends another bias than the one that was set: the map and the causes
// of one point, measured once more at that bias, in full size.
//
//   keep_recommended_picture(results, store, out, [&](int64_t, const Settings& at_bias) { return bench.measure(at_bias, {}); });
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "compare/results/records.h"
#include "compare/store/store.h"
#include "measure/workbench.h"

namespace noonmark {

// measure: of a point by its id, with its settings at the other bias. It is called only if the report opens at a recommended
// bias (compare/report/opening.h) and the point has no pictures of it yet. Pictures of another point or bias are removed.
// results: judged; the records of the pictures are put into it and into the store.
void keep_recommended_picture(Results& results, ResultStore& store, const std::string& out,
                              const std::function<Measurement(int64_t, const Settings&)>& measure);

}  // namespace noonmark
