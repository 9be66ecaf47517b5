#include "compare/report/rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "compare/results/quantities.h"

namespace noonmark {
namespace {

// One bit per point.
class Mask {
 public:
  explicit Mask(size_t points) : words_((points + 63) / 64) {}
  void set(size_t point) { words_[point / 64] |= uint64_t{1} << (point % 64); }
  bool at(size_t point) const { return (words_[point / 64] >> (point % 64) & 1) != 0; }
  void assign_both(const Mask& a, const Mask& b) {
    for (size_t i = 0; i < words_.size(); ++i) words_[i] = a.words_[i] & b.words_[i];
  }
  void remove(const Mask& other) {
    for (size_t i = 0; i < words_.size(); ++i) words_[i] &= ~other.words_[i];
  }
  bool within(const Mask& outer) const {
    for (size_t i = 0; i < words_.size(); ++i)
      if ((words_[i] & ~outer.words_[i]) != 0) return false;
    return true;
  }
  size_t count() const { return count_of(*this, *this, *this); }
  // The number of points that are in all three.
  static size_t count_of(const Mask& a, const Mask& b, const Mask& c) {
    size_t sum = 0;
    for (size_t i = 0; i < a.words_.size(); ++i)
      sum += static_cast<size_t>(std::popcount(a.words_[i] & b.words_[i] & c.words_[i]));
    return sum;
  }

 private:
  std::vector<uint64_t> words_;
};

// A setting (or the texel's size), its values, and for each point the index of its value.
struct Axis {
  std::string name;
  std::vector<std::string> values;
  std::vector<double> numbers;     // of the values; empty if one of them is not a number
  std::vector<uint32_t> value_at;  // by point
  bool thinned = false;            // not all values were tried as limits
};

struct Single {
  Condition condition;
  size_t axis = 0;
  Mask matches;
};

Axis axis_of(const Results& results, const std::string& name) {
  Axis axis{name, values_of(results, name), {}, {}};
  std::unordered_map<std::string_view, uint32_t> place;
  for (const std::string& value : axis.values) {
    place.emplace(value, static_cast<uint32_t>(place.size()));
    if (const std::optional<double> number = number_of(value)) axis.numbers.push_back(*number);
  }
  if (axis.numbers.size() != axis.values.size()) axis.numbers.clear();
  for (const PointRecord& point : results.points) axis.value_at.push_back(place.at(rule_value(point, name)));
  return axis;
}

bool holds(const Axis& axis, const Condition& condition, uint32_t value) {
  if (condition.is == Condition::Is::equal) return axis.values[value] == condition.value;
  const double number = axis.numbers[value], limit = *number_of(condition.value);
  return condition.is == Condition::Is::at_most ? number <= limit : number >= limit;
}

// At most max_rule_values of the values, evenly spaced, and two more: the limits that make a rule by themselves.
std::vector<bool> tried_limits(const Axis& axis, const Mask& allowed) {
  const size_t count = axis.values.size();
  std::vector<bool> tried(count, count <= max_rule_values);
  if (count <= max_rule_values) return tried;
  for (size_t i = 0; i < max_rule_values; ++i) tried[i * (count - 1) / (max_rule_values - 1)] = true;
  std::vector<bool> forbidden(count);
  for (size_t i = 0; i < axis.value_at.size(); ++i)
    if (!allowed.at(i)) forbidden[axis.value_at[i]] = true;
  const auto first = std::find(forbidden.begin(), forbidden.end(), true) - forbidden.begin();
  const auto last = std::find(forbidden.rbegin(), forbidden.rend(), true) - forbidden.rbegin();
  if (first > 0) tried[static_cast<size_t>(first) - 1] = true;
  if (last > 0) tried[count - static_cast<size_t>(last)] = true;
  return tried;
}
// At most max_rule_values of the values, those with the most chosen points.
std::vector<bool> tried_equals(const Axis& axis, const std::vector<bool>& chosen) {
  const size_t count = axis.values.size();
  if (count <= max_rule_values) return std::vector<bool>(count, true);
  std::vector<size_t> points(count), order(count);
  for (size_t i = 0; i < chosen.size(); ++i) points[axis.value_at[i]] += chosen[i];
  for (size_t i = 0; i < count; ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return points[a] > points[b]; });
  std::vector<bool> tried(count);
  for (size_t i = 0; i < max_rule_values; ++i) tried[order[i]] = true;
  return tried;
}

// Adds every single condition on the axis that is true of some points but not of all.
void add_conditions(Axis& axis, size_t index, const std::vector<bool>& chosen, const Mask& allowed,
                    std::vector<Single>& out) {
  const size_t count = axis.values.size();
  if (count < 2) return;
  axis.thinned = count > max_rule_values;
  const auto add = [&](Condition::Is is, size_t value) {
    Single single{{is, axis.name, axis.values[value]}, index, Mask(chosen.size())};
    std::vector<bool> true_of(count);
    for (size_t v = 0; v < count; ++v)
      true_of[v] = is == Condition::Is::equal     ? v == value
                   : is == Condition::Is::at_most ? axis.numbers[v] <= axis.numbers[value]
                                                  : axis.numbers[v] >= axis.numbers[value];
    for (size_t i = 0; i < chosen.size(); ++i)
      if (true_of[axis.value_at[i]]) single.matches.set(i);
    out.push_back(std::move(single));
  };
  const bool derived = axis.name == texel_size;  // it never gets the condition "equal"
  const std::vector<bool> equals = tried_equals(axis, chosen), limits = tried_limits(axis, allowed);
  for (size_t i = 0; !derived && i < count; ++i)
    if (equals[i]) add(Condition::Is::equal, i);
  for (size_t i = 0; !axis.numbers.empty() && i < count; ++i) {
    if (!limits[i]) continue;
    // At an end of the values the condition would be "equal" or always true.
    const bool first = i == 0, last = i + 1 == count;
    if (!last && (!first || derived)) add(Condition::Is::at_most, i);
    if (!first && (!last || derived)) add(Condition::Is::at_least, i);
  }
}

// The number of rules of exactly 1, 2 and 3 conditions on different axes.
std::vector<double> candidates_by_length(const std::vector<Single>& singles, size_t axes) {
  std::vector<double> of_axis(axes), sums(4);
  sums[0] = 1;
  for (const Single& single : singles) ++of_axis[single.axis];
  for (double here : of_axis)
    for (size_t length = 3; length > 0; --length) sums[length] += here * sums[length - 1];
  return sums;
}

// The rule with the most points of `left`. Rules grow condition by condition, in the order of the axes. A rule that is
// true of allowed points only needs no further condition. Branch and bound: a rule that does not match more points of
// `left` than the best one so far is not grown, because each further condition removes points.
class BestRule {
 public:
  BestRule(const std::vector<Single>& singles, const Mask& allowed, const Mask& left)
      : singles_(singles), allowed_(allowed), left_(left) {}

  // Indices of the best rule's conditions; empty if there is none.
  const std::vector<size_t>& find(size_t longest) {
    for (size_t length = 1; length <= longest; ++length) {
      std::vector<Mask> matches(length, left_);
      std::vector<size_t> rule;
      grow(length, rule, nullptr, matches);
    }
    return best_;
  }
  size_t tried() const { return tried_; }

 private:
  void grow(size_t length, std::vector<size_t>& rule, const Mask* so_far, std::vector<Mask>& matches) {
    for (size_t i = 0; i < singles_.size(); ++i) {
      const Single& single = singles_[i];
      if (!rule.empty() && single.axis <= singles_[rule.back()].axis) continue;
      ++tried_;
      const size_t covered = Mask::count_of(so_far ? *so_far : single.matches, single.matches, left_);
      if (covered <= best_count_) continue;
      Mask& here = matches[rule.size()];
      here.assign_both(so_far ? *so_far : single.matches, single.matches);
      const bool complete = here.within(allowed_);
      rule.push_back(i);
      if (complete && rule.size() == length) {
        best_ = rule;
        best_count_ = covered;
      } else if (!complete && rule.size() < length) {
        grow(length, rule, &here, matches);
      }
      rule.pop_back();
    }
  }

  const std::vector<Single>& singles_;
  const Mask &allowed_, &left_;
  std::vector<size_t> best_;
  size_t best_count_ = 0, tried_ = 0;
};

// Moves each limit on an axis of which not all values were tried: outwards while the rule is true of allowed points
// only, then back to the outermost point of `left` that it describes. The limit stays away from the end of the values,
// where the condition would be always true.
void move_limits(std::vector<Condition>& rule, const std::vector<const Axis*>& axes, const Mask& allowed,
                 const Mask& left, size_t points) {
  for (size_t c = 0; c < rule.size(); ++c) {
    const Axis& axis = *axes[c];
    if (!axis.thinned || rule[c].is == Condition::Is::equal) continue;
    const bool up = rule[c].is == Condition::Is::at_most;
    const size_t count = axis.values.size();
    std::vector<bool> forbidden(count), wanted(count);
    for (size_t i = 0; i < points; ++i) {
      bool others = true;
      for (size_t o = 0; o < rule.size(); ++o)
        others = others && (o == c || holds(*axes[o], rule[o], axes[o]->value_at[i]));
      if (!others) continue;
      if (!allowed.at(i)) forbidden[axis.value_at[i]] = true;
      if (left.at(i)) wanted[axis.value_at[i]] = true;
    }
    std::optional<size_t> limit;
    for (size_t step = 0; step + 1 < count; ++step) {
      const size_t value = up ? step : count - 1 - step;
      if (forbidden[value]) break;
      if (wanted[value]) limit = step;
    }
    if (!limit) continue;
    rule[c].value = axis.values[up ? *limit : count - 1 - *limit];
    if (*limit == 0 && axis.name != texel_size) rule[c].is = Condition::Is::equal;
  }
}

}  // namespace

std::string rule_value(const PointRecord& point, const std::string& setting) {
  if (setting != texel_size) return setting_of(point, setting);
  // Nine digits, so that two ways of rounding extent / resolution give one size.
  return point.curve ? fmt::format("{:.9g}", point.curve->m_per_depth / point.curve->texels_per_depth) : "";
}

std::vector<std::string> values_of(const Results& results, const std::string& setting) {
  std::vector<std::string> values;
  std::unordered_set<std::string> seen;
  for (const PointRecord& point : results.points)
    if (std::string value = rule_value(point, setting); seen.insert(value).second) values.push_back(std::move(value));
  std::vector<std::pair<double, std::string>> numbered;
  for (const std::string& value : values)
    if (const std::optional<double> number = number_of(value)) numbered.emplace_back(*number, value);
  if (numbered.size() != values.size()) return values;
  std::stable_sort(numbered.begin(), numbered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t i = 0; i < values.size(); ++i) values[i] = std::move(numbered[i].second);
  return values;
}

std::vector<Rule> describe_points(const Results& results, const std::vector<bool>& chosen,
                                  const std::vector<bool>& either_way, RuleSearch* search) {
  const size_t points = results.points.size();
  Mask left(points), allowed(points);
  for (size_t i = 0; i < points; ++i) {
    if (chosen[i]) left.set(i);
    if (chosen[i] || (i < either_way.size() && either_way[i])) allowed.set(i);
  }
  const Mask wanted = left;
  std::vector<Axis> axes;
  for (const std::string& setting : results.info.swept) axes.push_back(axis_of(results, setting));
  // Resolution and extent act through the texel size that they make together. So one rule may replace rules on both.
  if (Axis sizes = axis_of(results, std::string(texel_size)); !sizes.values.empty() && number_of(sizes.values.front()))
    axes.push_back(std::move(sizes));
  std::vector<Single> singles;
  for (size_t i = 0; i < axes.size(); ++i) add_conditions(axes[i], i, chosen, allowed, singles);

  size_t longest = 0;
  double candidates = 0;
  for (const std::vector<double> by_length = candidates_by_length(singles, axes.size()); longest < 3; ++longest) {
    candidates += by_length[longest + 1];
    if (longest > 0 && candidates > static_cast<double>(max_rule_candidates)) break;
  }

  RuleSearch plain;
  RuleSearch& state = search ? *search : plain;
  std::vector<Rule> out;
  while (out.size() < state.most_rules) {
    BestRule best(singles, allowed, left);
    const std::vector<size_t>& found = best.find(longest);
    state.tried += best.tried();
    if (found.empty()) break;  // nothing is left, or it needs a longer rule; the caller sees that from the counts
    Rule rule;
    std::vector<const Axis*> of_condition;
    for (size_t i : found) {
      rule.all.push_back(singles[i].condition);
      of_condition.push_back(&axes[singles[i].axis]);
    }
    move_limits(rule.all, of_condition, allowed, left, points);
    Mask matches(points);
    for (size_t i = 0; i < points; ++i) {
      bool all = true;
      for (size_t c = 0; c < rule.all.size(); ++c)
        all = all && holds(*of_condition[c], rule.all[c], of_condition[c]->value_at[i]);
      if (all) matches.set(i);
    }
    rule.points = Mask::count_of(matches, wanted, wanted);
    left.remove(matches);
    out.push_back(std::move(rule));
  }
  return out;
}

}  // namespace noonmark
