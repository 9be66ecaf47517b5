// describe_points: which combinations of swept settings a set of points is, in as few conditions as a greedy cover finds.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "compare/report_findings.h"

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

// Every single condition on one setting that some but not all points satisfy.
std::vector<Candidate> conditions_on(const Results& results, const std::string& setting) {
  std::vector<Candidate> out;
  const std::vector<std::string> values = values_of(results, setting);
  const bool numeric = std::all_of(values.begin(), values.end(), [](const auto& v) { return number_of(v).has_value(); });
  const auto add = [&](Condition::Is is, const std::string& value, auto&& holds) {
    Candidate candidate{{{{is, setting, value}}, 0}, Mask(results.points.size())};
    for (size_t i = 0; i < results.points.size(); ++i) candidate.matches[i] = holds(setting_of(results.points[i], setting));
    out.push_back(std::move(candidate));
  };
  if (values.size() < 2) return out;
  for (const std::string& value : values) add(Condition::Is::equal, value, [&](const std::string& v) { return v == value; });
  for (size_t i = 1; numeric && i + 1 < values.size(); ++i) {
    const double limit = *number_of(values[i]);
    add(Condition::Is::at_most, values[i], [&](const std::string& v) { return *number_of(v) <= limit; });
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

std::vector<std::string> values_of(const Results& results, const std::string& setting) {
  std::vector<std::string> values;
  for (const PointRecord& point : results.points) {
    const std::string value = setting_of(point, setting);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  if (std::all_of(values.begin(), values.end(), [](const auto& v) { return number_of(v).has_value(); }))
    std::stable_sort(values.begin(), values.end(), [](const auto& a, const auto& b) { return *number_of(a) < *number_of(b); });
  return values;
}

std::vector<Rule> describe_points(const Results& results, const std::vector<bool>& chosen) {
  Mask left = chosen;
  std::vector<Candidate> singles;
  for (const std::string& setting : results.info.swept)
    for (Candidate& candidate : conditions_on(results, setting)) singles.push_back(std::move(candidate));

  // Grown condition by condition; a rule that is already true of chosen points only needs no further one.
  std::vector<Candidate> rules, open = singles;
  for (int conditions = 1; conditions <= 3; ++conditions) {
    std::vector<Candidate> next;
    for (Candidate& candidate : open) {
      if (count(both(candidate.matches, chosen)) == 0) continue;
      if (within(candidate.matches, chosen)) {
        rules.push_back(std::move(candidate));
        continue;
      }
      if (conditions == 3) continue;
      const std::string last = candidate.rule.all.back().setting;
      const auto position = std::find(results.info.swept.begin(), results.info.swept.end(), last);
      for (const Candidate& single : singles) {
        // Settings in their swept order only, so that no pair is tried twice.
        if (std::find(results.info.swept.begin(), position + 1, single.rule.all[0].setting) != position + 1) continue;
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
    for (const Candidate& candidate : rules) {  // ordered by length: the first of equals is the shortest
      const size_t covered = count(both(candidate.matches, left));
      if (covered > best_count) best = &candidate, best_count = covered;
    }
    if (!best) break;  // told apart by more than three settings; the caller sees from the counts that some are left
    out.push_back(best->rule);
    out.back().points = count(best->matches);
    for (size_t i = 0; i < left.size(); ++i)
      if (best->matches[i]) left[i] = false;
  }
  return out;
}

}  // namespace noonmark
