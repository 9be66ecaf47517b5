#include "compare/judge/techniques.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "compare/judge/curve_reading.h"
#include "compare/results/number_text.h"
#include "compare/results/point_settings.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

// The part and the texts of the settings, without the named ones.
std::string key_of(const Choice& choice, const std::vector<std::string>& settings,
                   const std::vector<std::string>& without) {
  std::string key = choice.first().part;
  for (const std::string& name : settings)
    if (std::find(without.begin(), without.end(), name) == without.end())
      key += '\n' + setting_of(choice.first(), name);
  return key;
}

std::string cost_of_scale(const ComparedGroup& group, const Results& results) {
  const bool measured = std::all_of(group.choices.begin(), group.choices.end(), [](const ComparedChoice& one) {
    return std::isfinite(value_of(one, "texel_work").worst);
  });
  return measured ? "texel_work" : results.info.cost;
}

// Whether choices that differ in the setting alone cost more with a larger value, and there are such choices.
bool makes_dearer(const std::string& name, const ComparedGroup& group, const std::vector<std::string>& settings,
                  const std::string& cost) {
  std::map<std::string, std::map<double, double>> costs;  // by all else: of each value its cost
  for (const ComparedChoice& one : group.choices) {
    const std::optional<double> value = number_of(setting_of(one.choice.first(), name));
    const double at = value_of(one, cost).worst;
    if (!value || !std::isfinite(at)) return false;
    costs[key_of(one.choice, settings, {name})][*value] = at;
  }
  bool several = false;
  for (const auto& [key, by_value] : costs) {
    several |= by_value.size() > 1;
    for (auto at = by_value.begin(), next = at; next != by_value.end(); at = next)
      if (++next != by_value.end() && !(at->second < next->second)) return false;
  }
  return several;
}

std::string scale_of(const ComparedGroup& group, const std::vector<std::string>& settings, const std::string& cost) {
  std::vector<std::string> order{"map.resolution"};
  for (const Setting& row : settings_table()) order.emplace_back(row.name);
  for (const std::string& name : order)
    if (std::find(settings.begin(), settings.end(), name) != settings.end() &&
        makes_dearer(name, group, settings, cost))
      return name;
  return "";
}

}  // namespace

Techniques techniques_of(const ComparedGroup& group, const Results& results) {
  const std::vector<std::string> settings = choice_settings(results.info);
  Techniques found;
  found.scale = scale_of(group, settings, cost_of_scale(group, results));
  std::map<std::string, size_t> known;
  for (size_t i = 0; i < group.choices.size(); ++i) {
    const Choice& choice = group.choices[i].choice;
    std::vector<std::string> without = tuned_settings(choice);
    without.push_back(found.scale);
    const auto [at, is_new] = known.emplace(key_of(choice, settings, without), found.first.size());
    if (is_new) found.first.push_back(i);
    found.of.push_back(at->second);
  }
  return found;
}

std::vector<std::string> tuned_settings(const Choice& choice) {
  if (filtered_lookup_of(choice.first())) {
    std::vector<std::string> tuned = {"bias.constant"};
    for (const KindParameter* one : LookupTable::parameters())
      if (one->type == ValueType::real && !one->of_blur) tuned.emplace_back(one->setting);
    return tuned;
  }
  if (has_curves(choice)) return {curve_parameter(choice.first())};
  return {};
}

std::optional<MoreOf> more_of(const ComparedChoice& one, const ComparedChoice& other, AtBias at) {
  std::optional<MoreOf> most;
  for (const std::string& cause : joined_causes({&one, &other})) {
    const MoreOf here{cause, value_of(one, cause, at).mean, value_of(other, cause, at).mean};
    const double more = here.one - here.other;  // a NaN is not above the least
    if (more > (most ? most->one - most->other : 0)) most = here;
  }
  return most;
}

}  // namespace noonmark
