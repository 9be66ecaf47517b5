// Describes chosen points in few words: "resolution at most 512 texels and filter none".
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/results/records.h"

namespace noonmark {

// The name in a Condition for the map's texel in metres, extent / resolution, which is not a setting.
inline constexpr std::string_view texel_size = "texel size";

struct Condition {
  enum class Is { equal, at_most, at_least } is = Is::equal;
  std::string setting, value;
};
struct Rule {
  std::vector<Condition> all;  // all conditions must be true
  size_t points = 0;           // how many chosen points the rule describes
};
// What describe_points may do, and what it did.
struct RuleSearch {
  size_t most_rules = std::numeric_limits<size_t>::max();  // the search ends after this many rules
  size_t tried = 0;  // out: how many candidates were compared with the points, over all rules
};
// The bounds of the search. Up to both of them, the search tries every rule of at most three conditions.
// - If a setting has more values, only this many of its values are tried as limits, evenly spaced. A limit of the rule
//   that is found is then moved as far as the points permit. Of the conditions "equal", those with the most chosen
//   points are tried.
// - If there are more candidates, rules have at most two conditions, or one.
// So the time for one rule is at most max_rule_candidates times the number of points / 64.
inline constexpr size_t max_rule_values = 64;
inline constexpr size_t max_rule_candidates = 300000;

// Finds rules that describe the chosen points. A rule has at most three conditions on swept settings or the texel's
// size. Each rule is true of chosen points only, and together they are true of every chosen point, unless that needs
// more conditions or more rules than the search may try. The search is greedy: it takes the rule with the most points
// that no rule describes yet, the shortest first. either_way: points of which a rule may be true although they are not
// chosen, because the statement has no meaning there; empty: none.
std::vector<Rule> describe_points(const Results& results, const std::vector<bool>& chosen,
                                  const std::vector<bool>& either_way = {}, RuleSearch* search = nullptr);

// The value that a Condition compares: the setting's text, or the texel's size from the point's curve ("" without a
// curve).
std::string rule_value(const PointRecord& point, const std::string& setting);

// The distinct values of a setting over the points, sorted as numbers if all are numbers, otherwise in order of
// appearance.
std::vector<std::string> values_of(const Results& results, const std::string& setting);

}  // namespace noonmark
