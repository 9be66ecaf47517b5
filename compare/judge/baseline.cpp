#include "compare/judge/baseline.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "compare/judge/conditions.h"
#include "compare/judge/undecided.h"
#include "compare/ladder/numbers.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

using nlohmann::json;

constexpr int file_format = 1;  // counted up when the file changes its form

double rounded(double value) { return std::stod(fmt::format("{:.{}e}", value, baseline_digits - 1)); }

// One unit of the last digit that the file holds of this value.
double last_digit(double value) {
  return value == 0 ? 0 : std::pow(10.0, std::floor(std::log10(std::abs(value))) - (baseline_digits - 1));
}

Better better_by(const Bound& bound) {
  if (bound.max && bound.min) return Better::unknown;
  return bound.max ? Better::smaller : Better::larger;
}

void add_value(BaselinePoint& to, const PointRecord& point, const std::string& name, std::optional<Better> better,
               bool times) {
  const bool time = find_quantity(name, {&point, 1}).unit == "ms";
  if (time && !times) return;
  const double value = quantity(point, name).value_or(not_a_number);
  const auto [at, is_new] =
      to.values.try_emplace(name, BaselineValue{std::isfinite(value) ? value : not_a_number,
                                                better.value_or(Better::unknown), time, ambiguous_room(point, name)});
  if (!is_new && better && at->second.better != *better) at->second.better = Better::unknown;
}

// JSON has no number for a value that was not measured.
json number(const BaselineValue& value) {
  return std::isfinite(value.at_worst()) ? json(rounded(value.at_worst())) : json(nullptr);
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::usage,
              fmt::format("{}: is not a baseline: {}; write it anew with --update-baseline", path, why));
}

std::map<std::string, std::string> texts(const json& table) {
  std::map<std::string, std::string> found;
  for (const auto& [name, text] : table.items()) found[name] = text.get<std::string>();
  return found;
}

// A point is named by its part and its swept values. So it stays the same point when a fixed setting or the model changes.
using Key = std::pair<std::string, std::map<std::string, std::string>>;
using SweptNames = std::map<std::string, std::set<std::string>>;  // of each part

// A setting that the file does not name is newer than the file and had its default.
std::string value_there(const BaselinePoint& point, const std::string& name) {
  if (const auto at = point.settings.find(name); at != point.settings.end()) return at->second;
  for (const Setting& row : settings_table())
    if (row.name == name) return row.get(Settings());
  return "no such setting";
}

// The settings that differ among the points of a part, which are those that it sweeps.
void add_swept(const std::vector<BaselinePoint>& points, SweptNames& names) {
  std::map<std::string, const BaselinePoint*> first;
  for (const BaselinePoint& point : points) {
    const BaselinePoint& other = *first.emplace(point.part, &point).first->second;
    for (const auto* settings : {&point.settings, &other.settings})
      for (const auto& [name, text] : *settings)
        if (value_there(point, name) != value_there(other, name)) names[point.part].insert(name);
  }
}

Key key_of(const BaselinePoint& point, const SweptNames& swept) {
  Key key{point.part, {}};
  if (const auto names = swept.find(point.part); names != swept.end())
    for (const std::string& name : names->second) key.second[name] = value_there(point, name);
  return key;
}

// "map.resolution is 512, in the baseline 1024" for each setting that differs.
std::vector<std::string> differences(const BaselinePoint& before, const BaselinePoint& now) {
  std::set<std::string> names;
  for (const auto* settings : {&before.settings, &now.settings})
    for (const auto& [name, text] : *settings) names.insert(name);
  std::vector<std::string> found;
  for (const std::string& name : names)
    if (const std::string was = value_there(before, name), is = value_there(now, name); was != is)
      found.push_back(fmt::format("{} is {}, in the baseline {}", name, is, was));
  return found;
}

// The settings by which points of the file differ, to name a point in few words.
std::set<std::string> naming_settings(const Baseline& baseline) {
  std::set<std::string> names;
  for (const BaselinePoint& point : baseline.points)
    for (const auto& [name, text] : point.settings) {
      const auto there = baseline.points.front().settings.find(name);
      if (there == baseline.points.front().settings.end() || there->second != text) names.insert(name);
    }
  return names;
}

std::string name_of(const BaselinePoint& point, const std::set<std::string>& names) {
  std::vector<std::string> words;
  if (!point.part.empty()) words.push_back(fmt::format("part '{}'", point.part));
  for (const std::string& name : names)
    if (const auto at = point.settings.find(name); at != point.settings.end())
      words.push_back(fmt::format("{} = {}", name, setting_text(at->second)));
  return words.empty() ? "the only point" : fmt::format("{}", fmt::join(words, ", "));
}

// other: what the value is compared with, from which it must be told.
std::string value_text(double value, double room, double other, std::string_view unit) {
  return std::isfinite(value) ? text_with_room(value, room, unit, digits_to_tell(value, other))
                              : std::string(not_measured);
}

class Comparison {
 public:
  explicit Comparison(std::optional<double> time_share) : time_share_(time_share) {}

  void compare(const BaselinePoint& before, const BaselinePoint& now, const std::string& point) {
    ++points_;
    for (const std::string& difference : differences(before, now)) ++changed_[difference];
    if (before.scene != now.scene)
      ++changed_[fmt::format("the scene {} has other contents than in the baseline", value_there(now, "scene.name"))];
    for (const auto& [name, value] : now.values) {
      if (value.time && !time_share_) continue;
      const auto there = before.values.find(name);
      if (there == before.values.end())
        found_.notes.push_back(fmt::format("new: {} at {} is not in the baseline", name, point));
      else
        compare(name, there->second.value, value, point);
    }
    for (const auto& [name, value] : before.values)
      if (!now.values.contains(name) && !is_time(name))
        found_.notes.push_back(
            fmt::format("gone: {} at {} is in the baseline, but no bound and no plot names it any more", name, point));
  }
  BaselineComparison& found() { return found_; }
  // How many points of the baseline were measured.
  size_t points() const { return points_; }
  // A line for each setting and each scene that changed.
  void list_changes() {
    for (const auto& [what, where] : changed_)
      found_.changed.push_back(
          fmt::format("changed: {}{}", what, where == points_ ? "" : fmt::format(" (at {})", counted(where, "point"))));
  }

 private:
  // A name that this version does not know is not a time.
  static bool is_time(const std::string& name) { return quantity_unit(name) == "ms"; }

  void compare(const std::string& name, double before, const BaselineValue& now, const std::string& point) {
    ++found_.compared;
    const double worst = now.at_worst();
    const bool was = std::isfinite(before), is = std::isfinite(worst);
    if (!was && !is) return;
    const double change = was && is ? worst - before : 0;
    // The change of two rounded numbers is itself rounded in double: a share of 2^-52 of them.
    const double allowed = now.time ? *time_share_ * std::abs(before)
                                    : std::max(last_digit(before), last_digit(worst)) +
                                          std::numeric_limits<double>::epsilon() * std::abs(before);
    if (was && is && std::abs(change) <= allowed) return;
    const bool larger = change > 0;
    bool worse = now.better == Better::unknown || larger == (now.better == Better::smaller);
    if (was != is) worse = was;
    const std::string_view unit = quantity_unit(name);
    std::string text = fmt::format("{}: {} at {}; {} before, {} now", worse ? "worse" : "better", name, point,
                                   value_text(before, 0, worst, unit), value_text(now.value, now.room, before, unit));
    if (now.room > 0) text += "; so much of it is not known, because the receivers' truth is ambiguous";
    // Of a share the difference is in percent too, so the relative change would read as another difference.
    else if (was && is)
      text += fmt::format(" ({}{}{})", change > 0 ? "+" : "", quantity_text(change, unit),
                          before == 0 ? "" : fmt::format(", {:.4g} times as large", now.value / before));
    if (worse && was && is && now.better == Better::unknown) text += "; no bound says which side is better";
    (worse ? found_.worse : found_.better).push_back(std::move(text));
  }

  std::optional<double> time_share_;
  size_t points_ = 0;
  std::map<std::string, size_t> changed_;  // what changed, and at how many points
  BaselineComparison found_;
};

// The fewest differences to a point of the same part, or to any point if the part has none.
std::vector<std::string> least_differences(const BaselinePoint& before, const Baseline& now) {
  std::vector<std::string> least;
  bool same_part = false, any = false;
  for (const BaselinePoint& point : now.points) {
    const bool same = point.part == before.part;
    if (same_part && !same) continue;
    std::vector<std::string> here = differences(before, point);
    if (!any || (same && !same_part) || here.size() < least.size()) least = std::move(here);
    any = true;
    same_part = same_part || same;
  }
  return least;
}

}  // namespace

double BaselineValue::at_worst() const {
  const double worst = better == Better::larger ? value - room : value + room;
  return std::isfinite(worst) ? worst : not_a_number;
}

BaselinePoint baseline_point(const PointRecord& point, std::span<const Bound> bounds, std::span<const std::string> plot,
                             bool times, const std::string& scene) {
  BaselinePoint to{point.part, point.settings, scene, {}};
  // The settings of a technique and a view of ours say nothing of a frame that is handed over.
  if (judges_frames({&point, 1}))
    std::erase_if(to.settings, [](const auto& setting) {
      const std::string& name = setting.first;
      return !name.starts_with("given.") && name != "scene.name" && name != "view.width_px" && name != "view.height_px";
    });
  if (const auto name = to.settings.find("scene.name"); name != to.settings.end() && !scene.empty())
    name->second = name->second.substr(name->second.rfind('/') + 1);
  for (const Bound& bound : bounds) {
    if (!matches(point, bound.where)) continue;
    add_value(to, point, bound.metric, better_by(bound), times);
    if (!has_placements(point) || bound.placement != "worst") continue;
    const PlacedNames placed = placed_names(bound.metric);
    if (bound.max)
      for (const std::string& name : placed.largest) add_value(to, point, name, better_by(bound), times);
    if (bound.min)
      for (const std::string& name : placed.least) add_value(to, point, name, better_by(bound), times);
  }
  for (const std::string& name : plot) add_value(to, point, name, {}, times);
  return to;
}

std::string baseline_text(const Baseline& baseline) {
  const std::set<std::string> own = naming_settings(baseline);
  json file{
      {"format", file_format}, {"opengl", baseline.opengl}, {"settings", json::object()}, {"points", json::array()}};
  if (!baseline.points.empty())
    for (const auto& [name, text] : baseline.points.front().settings)
      if (!own.contains(name)) file["settings"][name] = text;
  for (const BaselinePoint& point : baseline.points) {
    json one{{"settings", json::object()}, {"values", json::object()}};
    if (!point.part.empty()) one["part"] = point.part;
    if (!point.scene.empty()) one["scene"] = point.scene;
    for (const std::string& name : own)
      if (const auto at = point.settings.find(name); at != point.settings.end()) one["settings"][name] = at->second;
    for (const auto& [name, value] : point.values) one["values"][name] = number(value);
    file["points"].push_back(std::move(one));
  }
  return file.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

Baseline parse_baseline(std::string_view text, const std::string& path) {
  try {
    const json file = json::parse(text);
    if (const int format = file.at("format").get<int>(); format != file_format)
      refuse(path, fmt::format("its format is {}, and this version reads {}", format, file_format));
    Baseline baseline;
    baseline.opengl = file.at("opengl").get<std::string>();
    const std::map<std::string, std::string> common = texts(file.at("settings"));
    for (const json& one : file.at("points")) {
      BaselinePoint point{one.value("part", ""), texts(one.at("settings")), one.value("scene", ""), {}};
      point.settings.insert(common.begin(), common.end());
      for (const auto& [name, value] : one.at("values").items())
        point.values[name].value = value.is_null() ? not_a_number : value.get<double>();
      baseline.points.push_back(std::move(point));
    }
    return baseline;
  } catch (const json::exception& error) {
    refuse(path, error.what());
  }
}

BaselineComparison compare_with_baseline(const Baseline& before, const Baseline& now, const std::string& path,
                                         std::optional<double> time_share, std::span<const std::string> parts) {
  SweptNames swept;
  add_swept(before.points, swept);
  add_swept(now.points, swept);
  std::map<Key, const BaselinePoint*> there;
  for (const BaselinePoint& point : now.points) there[key_of(point, swept)] = &point;
  const std::set<std::string> names_before = naming_settings(before), names_now = naming_settings(now);
  Comparison comparison(time_share);
  std::vector<std::string>& worse = comparison.found().worse;
  std::string why;
  std::set<Key> known;
  for (const BaselinePoint& point : before.points) {
    if (!parts.empty() && std::find(parts.begin(), parts.end(), point.part) == parts.end()) continue;
    const Key key = key_of(point, swept);
    known.insert(key);
    if (const auto at = there.find(key); at != there.end()) {
      comparison.compare(point, *at->second, name_of(point, names_before));
      continue;
    }
    const std::vector<std::string> other = least_differences(point, now);
    std::string text =
        fmt::format("missing: {} is in the baseline, but was not measured", name_of(point, names_before));
    if (!other.empty()) text += fmt::format("; at the nearest point {}", fmt::join(other, ", "));
    if (why.empty()) why = text;
    worse.push_back(std::move(text));
  }
  if (comparison.points() == 0)
    throw Error(
        ErrorKind::usage,
        fmt::format("{}: no point of the baseline was measured{}; use the experiment and the swept values that it was "
                    "written with, or accept these with --update-baseline",
                    path, why.empty() ? "" : fmt::format(" ({})", why)));
  comparison.list_changes();
  for (const auto& [key, point] : there)
    if (!known.contains(key))
      comparison.found().notes.push_back(
          fmt::format("new: {} is not in the baseline; --update-baseline adds it", name_of(*point, names_now)));
  if (before.opengl != now.opengl)
    comparison.found().notes.push_back(fmt::format(
        "the baseline was drawn by {}, these maps by {}; their values can differ", before.opengl, now.opengl));
  return std::move(comparison.found());
}

std::string baseline_verdict(const BaselineComparison& comparison) {
  std::string better = comparison.better.empty() ? "" : fmt::format(", {} better", comparison.better.size());
  if (!comparison.changed.empty()) better += fmt::format("; {}", counted(comparison.changed.size(), "change"));
  if (comparison.held())
    return fmt::format("no worse than the baseline ({} compared{})", counted(comparison.compared, "value"), better);
  return fmt::format("worse than the baseline in {} of {}{}", comparison.worse.size(),
                     counted(comparison.compared, "value"), better);
}

}  // namespace noonmark
