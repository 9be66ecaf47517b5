#include "compare/report/rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "compare/store/quantities.h"

namespace noonmark {
namespace {

using Mask = std::vector<bool>;  // one flag per point

struct Candidate {
  Rule rule;
  Mask matches;
};

Mask both(const Mask& a, const Mask& b) {
  Mask out(a.size());
  for (size_t i = 0; i < a.size(); ++i) out[i] = a[i] && b[i];
  return out;
}

bool within(const Mask& inner, const Mask& outer) {
  for (size_t i = 0; i < inner.size(); ++i)
    if (inner[i] && !outer[i]) return false;
  return true;
}

size_t count(const Mask& mask) { return static_cast<size_t>(std::count(mask.begin(), mask.end(), true)); }

// Every single condition on one setting that is true of some points but not of all.
std::vector<Candidate> conditions_on(const Results& results, const std::string& setting) {
  std::vector<Candidate> out;
  std::vector<std::string> values = values_of(results, setting);
  const bool numeric =
      std::all_of(values.begin(), values.end(), [](const auto& v) { return number_of(v).has_value(); });
  const auto add = [&](Condition::Is is, const std::string& value, auto&& holds) {
    Candidate candidate{{{{is, setting, value}}, 0}, Mask(results.points.size())};
    for (size_t i = 0; i < results.points.size(); ++i)
      candidate.matches[i] = holds(rule_value(results.points[i], setting));
    out.push_back(std::move(candidate));
  };
  if (values.size() < 2) return out;
  for (const std::string& value : setting == texel_size ? std::vector<std::string>{} : values)
    add(Condition::Is::equal, value, [&](const std::string& v) { return v == value; });
  for (size_t i = 0; numeric && i < values.size(); ++i) {
    const double limit = *number_of(values[i]);
    // At an end of the values the condition would be "equal" or always true. The texel's size never gets the condition
    // "equal".
    const bool first = i == 0, last = i + 1 == values.size(), derived = setting == texel_size;
    if (!last && (!first || derived))
      add(Condition::Is::at_most, values[i], [&](const std::string& v) { return *number_of(v) <= limit; });
    if (!first && (!last || derived))
      add(Condition::Is::at_least, values[i], [&](const std::string& v) { return *number_of(v) >= limit; });
  }
  return out;
}

}  // namespace

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string rule_value(const PointRecord& point, const std::string& setting) {
  if (setting != texel_size) return setting_of(point, setting);
  // Nine digits, so that two ways of rounding extent / resolution give one size.
  return point.curve ? fmt::format("{:.9g}", point.curve->m_per_depth / point.curve->texels_per_depth) : "";
}

std::vector<std::string> values_of(const Results& results, const std::string& setting) {
  std::vector<std::string> values;
  for (const PointRecord& point : results.points) {
    const std::string value = rule_value(point, setting);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  if (std::all_of(values.begin(), values.end(), [](const auto& v) { return number_of(v).has_value(); }))
    std::stable_sort(values.begin(), values.end(),
                     [](const auto& a, const auto& b) { return *number_of(a) < *number_of(b); });
  return values;
}

std::vector<Rule> describe_points(const Results& results, const std::vector<bool>& chosen,
                                  const std::vector<bool>& either_way) {
  Mask left = chosen, allowed = chosen;
  for (size_t i = 0; i < either_way.size(); ++i)
    if (either_way[i]) allowed[i] = true;
  std::vector<std::string> axes = results.info.swept;
  // Resolution and extent act through the texel size that they make together. So one rule may replace rules on both.
  const std::vector<std::string> sizes = values_of(results, std::string(texel_size));
  if (!sizes.empty() && number_of(sizes.front())) axes.emplace_back(texel_size);
  std::vector<Candidate> singles;
  for (const std::string& setting : axes)
    for (Candidate& candidate : conditions_on(results, setting)) singles.push_back(std::move(candidate));

  // Rules grow condition by condition. A rule that is true of chosen points only needs no further condition.
  std::vector<Candidate> rules, open = singles;
  for (int conditions = 1; conditions <= 3; ++conditions) {
    std::vector<Candidate> next;
    for (Candidate& candidate : open) {
      if (count(both(candidate.matches, chosen)) == 0) continue;
      if (within(candidate.matches, allowed)) {
        rules.push_back(std::move(candidate));
        continue;
      }
      if (conditions == 3) continue;
      const std::string last = candidate.rule.all.back().setting;
      const auto position = std::find(axes.begin(), axes.end(), last);
      for (const Candidate& single : singles) {
        // Only in the order of the axes, so that no pair is tried twice.
        if (std::find(axes.begin(), position + 1, single.rule.all[0].setting) != position + 1) continue;
        Candidate grown = candidate;
        grown.rule.all.push_back(single.rule.all[0]);
        grown.matches = both(candidate.matches, single.matches);
        next.push_back(std::move(grown));
      }
    }
    open = std::move(next);
  }

  std::vector<Rule> out;
  while (count(left) > 0) {
    const Candidate* best = nullptr;
    size_t best_count = 0;
    for (const Candidate& candidate : rules) {  // sorted by length, so the first of equal rules is the shortest
      const size_t covered = count(both(candidate.matches, left));
      if (covered > best_count) best = &candidate, best_count = covered;
    }
    if (!best) break;  // more than three settings are needed; the caller sees from the counts that points are left
    out.push_back(best->rule);
    out.back().points = count(both(best->matches, chosen));
    for (size_t i = 0; i < left.size(); ++i)
      if (best->matches[i]) left[i] = false;
  }
  return out;
}

}  // namespace noonmark
