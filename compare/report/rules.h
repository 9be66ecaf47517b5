// Which points were chosen, said in few words: "resolution at most 512 texels and filter none".
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/store/records.h"

namespace noonmark {

// Stands in a Condition for the map's texel in metres, extent / resolution, which no setting holds by itself.
inline constexpr std::string_view texel_size = "texel size";

struct Condition {
  enum class Is { equal, at_most, at_least } is = Is::equal;
  std::string setting, value;
};
struct Rule {
  std::vector<Condition> all;  // every one of these
  size_t points = 0;           // how many chosen points the rule speaks for
};
// Says in few words which points were chosen: rules of at most three conditions on swept settings or the texel's size,
// each true of chosen points only, together true of every chosen point (greedy: the rule with the most points not yet
// spoken for, shortest first). either_way: points that a rule may also be true of, because what is said does not arise
// there; empty: none.
std::vector<Rule> describe_points(const Results& results, const std::vector<bool>& chosen,
                                  const std::vector<bool>& either_way = {});

// What a Condition compares: the setting's text, or the texel's size from the point's curve ("" without one).
std::string rule_value(const PointRecord& point, const std::string& setting);

// Distinct values of a setting over the points: by number when all are numbers, else in order of appearance.
std::vector<std::string> values_of(const Results& results, const std::string& setting);
std::optional<double> number_of(const std::string& text);

}  // namespace noonmark
