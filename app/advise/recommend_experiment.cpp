// The experiment that judges an answer (recommend_text.h).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "app/advise/recommend_text.h"
#include "app/definition/toml_text.h"

namespace noonmark {
namespace {

constexpr std::string_view relied_groups[] = {"scene.", "view.", "light.", "map.", "truth."};

// Whether an answer depends on a setting also where it has its default: so that another default of a later version changes no
// answer that was written. Parts of a bias that are not there, motion and frames of others are no part of it.
bool relies_on(std::string_view setting, bool filtered) {
  if (filtered && setting.starts_with("lookup.")) return true;
  if (setting == "bias.unit" || setting == "bias.offset_unit" || setting == "bias.reference") return true;
  return setting == "filter.kind" || std::any_of(std::begin(relied_groups), std::end(relied_groups),
                                                 [&](std::string_view group) { return setting.starts_with(group); });
}

// The line of a bound that holds at the first condition alone; empty if there is one condition.
std::string where_of_first(const AdviceRequest& request) {
  std::vector<std::string> parts;
  for (const Setting* row : differing_settings(request.conditions))
    parts.push_back(fmt::format("\"{}\" = {}", row->name, toml_value(*row, row->get(request.conditions.front()))));
  return parts.empty() ? "" : fmt::format("where = {{{}}}\n", fmt::join(parts, ", "));
}

}  // namespace

std::vector<const Setting*> differing_settings(std::span<const Settings> conditions) {
  std::vector<const Setting*> found;
  for (const Setting& row : settings_table())
    if (std::any_of(conditions.begin(), conditions.end(),
                    [&](const Settings& other) { return row.get(other) != row.get(conditions.front()); }))
      found.push_back(&row);
  return found;
}

std::string advice_experiment(const Answer& chosen, const Advice& advice, const std::string& folder) {
  const Tried& answer = chosen.tried;
  const std::vector<const Setting*> varied = differing_settings(advice.request.conditions);
  Settings settings = answer.settings;
  const auto acts = [&](const Setting& row) {
    return !row.why_idle || row.why_idle(settings, advice.request.light).empty();
  };
  settings.map.placements = static_cast<int>(std::lround(std::sqrt(chosen.placements)));
  std::string scene = settings.scene.name;
  if (std::error_code none; std::filesystem::is_regular_file(scene, none))
    scene = std::filesystem::proximate(scene, folder);
  std::string text = "# Written by noonmark recommend. noonmark check judges it.\n";
  for (const std::string& line : lookups_text(advice)) text += fmt::format("# {}\n", line);
  text += fmt::format("\n[scene]\nname = {}\n", toml_string(scene));
  std::string over, group = "scene";
  for (const Setting& row : settings_table()) {
    const std::string name(row.name), value = row.get(settings);
    const size_t dot = name.find('.');
    if (std::find(varied.begin(), varied.end(), &row) != varied.end()) {
      std::vector<std::string> values;
      for (const Settings& condition : advice.request.conditions)
        if (const std::string one = toml_value(row, row.get(condition));
            std::find(values.begin(), values.end(), one) == values.end())
          values.push_back(one);
      over += fmt::format("{} = [{}]\n", name, fmt::join(values, ", "));
    } else if (name != "scene.name" && acts(row) &&
               (value != row.get(Settings()) || relies_on(name, answer.filtered()))) {
      if (name.substr(0, dot) != group) text += fmt::format("\n[{}]\n", group = name.substr(0, dot));
      text += fmt::format("{} = {}\n", name.substr(dot + 1), toml_value(row, value));
    }
  }
  if (!over.empty()) text += "\n[over]\n" + over;
  text += fmt::format("\n[curve]\nacne_bound = {}\npeter_panning_bound = {}\n", advice.request.curve.acne_bound,
                      advice.request.curve.peter_panning_bound);
  const double dark = advice.request.curve.acne_bound, light = advice.request.curve.peter_panning_bound;
  using Kept = std::vector<std::pair<const char*, double>>;
  for (const auto& [metric, max] :
       answer.filtered()
           ? Kept{{"over_darkening", dark}, {"reduction", dark}, {"leak", light}, {"peter_panning", light}}
           : Kept{{"acne", dark}, {"peter_panning", light}})
    text += fmt::format("\n[[bound]]\nmetric = \"{}\"\nmax = {}\n", metric, max);
  if (advice.request.error)
    text += fmt::format("\n[[bound]]\nmetric = \"{}\"\nmax = {}\n", advice.request.accuracy, *advice.request.error);
  for (const Bound& bound : advice.request.eye)
    text += fmt::format("\n[[bound]]  # for the eye, at the given view\nmetric = \"{}\"\nmax = {}\n{}", bound.metric,
                        *bound.max, where_of_first(advice.request));
  return text;
}

}  // namespace noonmark
