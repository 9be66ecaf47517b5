#include "app/advise/texel_budget.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/advise/recommend_text.h"
#include "app/definition/toml_text.h"
#include "base/error.h"
#include "base/text.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/recommendation.h"
#include "compare/judge/undecided.h"
#include "compare/results/number_text.h"
#include "measure/lights_frame.h"
#include "scenes/library.h"
#include "technique/light_frame.h"
#include "technique/placements.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

constexpr int largest_map = 16384;  // that of map.resolution

// A light's part of the error differs from one placement of the grid to another by a fifth and more, which would decide the
// search. So it is the mean over these placements, and the two answers are judged at others.
constexpr int searched_side = 2, judged_side = 4;
constexpr std::array<int, 4> searched_placements = {0, 1, 2, 3}, judged_placements = {5, 7, 13, 15};

// The settings whose map lies at this placement of S x S.
Settings at_placement(const Scene& scene, Settings settings, int side, int placement) {
  const LightFrame frame = make_light_frame(scene, settings);
  const Placements placements(side);
  const std::vector<PlacementFact> facts =
      frame.light().placement_facts(placements.frame(frame, placement), placements, placement);
  if (frame.light().map_shape() == MapShape::cube) {
    settings.map.turn_deg = glm::dvec3(facts.at(0).value, facts.at(1).value, facts.at(2).value);
  } else {
    settings.map.shift_u_texels += facts.at(0).value;
    settings.map.shift_v_texels += facts.at(1).value;
  }
  return settings;
}

struct Candidate {
  int resolution = 0;
  int64_t texels = 0;
  double error = 0;
  Settings settings;
};

class Divider {
 public:
  using Lights = std::vector<std::pair<std::string, Settings>>;
  Divider(Workbench& bench, const Lights& lights, int64_t budget, const std::function<void(const std::string&)>& say)
      : bench_(bench), lights_(lights), budget_(budget), say_(say) {
    for (size_t l = 0; l < lights.size(); ++l) frame_.push_back(part_of(measured(l, least_map)));
  }

  TexelBudget divide() {
    for (size_t l = 0; l < lights_.size(); ++l) candidates_.push_back(candidates(l));
    std::vector<Candidate> equal, found = best();
    for (size_t l = 0; l < lights_.size(); ++l) equal.push_back(candidate(l, equal_resolution(l)));
    // What is between the measured resolutions is only estimated, so the equal split can be better.
    if (sum_of(equal) < sum_of(found)) found = equal;
    give_rest(found);
    TexelBudget made{budget_, division(found), division(equal)};
    // The search sees other placements than the judge. What is not better there is no answer.
    if (!(made.best.error < made.equal.error)) made.best = made.equal;
    return made;
  }

 private:
  int64_t tiles(size_t light) const { return tiles_[light]; }
  int64_t texels(size_t light, int resolution) const {
    MapSettings map = lights_[light].second.map;
    map.resolution = resolution;
    return tiles(light) * resolution * map.rows();
  }
  int resolution_of(size_t light, int64_t texels) const {
    const double aspect = lights_[light].second.map.aspect.value_or(1);
    auto side =
        static_cast<int64_t>(std::sqrt(static_cast<double>(texels) * aspect / static_cast<double>(tiles(light))));
    side = std::min<int64_t>(side, largest_map);
    while (side > 1 && this->texels(light, static_cast<int>(side)) > texels) --side;  // rows are rounded
    return static_cast<int>(side);
  }

  // The settings with this resolution and the bias of least error there.
  Settings measured(size_t light, int resolution) {
    Settings settings = lights_[light].second;
    require_one_map(settings, "a budget of texels");
    require_compared(settings, "a budget of texels");
    settings.map.resolution = resolution;
    settings.map.placements = 1;
    say_(fmt::format("{}: a map of {} texels", lights_[light].first, resolution));
    const Measurement m = bench_.measure(settings, CurveOptions(), MetricSet::searched, Checks::none);
    if (tiles_.size() == light) tiles_.push_back(m.technique.frame.tiles);
    if (const std::optional<BiasCurve>& curve = m.record.curve) {
      const double best = curve->best_bias_depth * parameter_per_depth(m.record);
      find_setting(curve->parameter).set(settings, fmt::format("{}", short_decimal(best, 0.98 * best, 1.02 * best)));
    }
    return settings;
  }
  LightPart part_of(const Settings& settings) {
    return light_part(bench_.measure(settings, std::nullopt, MetricSet::searched, Checks::none));
  }
  Candidate candidate(size_t light, int resolution) {
    Candidate made{resolution, texels(light, resolution), 0, measured(light, resolution)};
    const Scene& scene = bench_.scene(made.settings.scene);
    for (const int placement : searched_placements)
      made.error += light_error(frame_, part_of(at_placement(scene, made.settings, searched_side, placement))) /
                    static_cast<double>(searched_placements.size());
    return made;
  }
  Candidate without_map(size_t light) {
    return {0, 0, light_error(frame_, without_shadow(frame_[light])), lights_[light].second};
  }

  // Of one light, by texels: without a map, and then those that are measured.
  std::vector<Candidate> candidates(size_t light) {
    std::vector<Candidate> all = {without_map(light)};
    for (double side = least_map; side <= largest_map; side *= std::sqrt(2.0)) {
      const int resolution = static_cast<int>(std::lround(side));
      if (texels(light, resolution) > budget_) break;
      all.push_back(candidate(light, resolution));
    }
    return all;
  }
  // An edge that happens to lie well on the grid of one resolution would draw the search there. So each error is half its own
  // and a quarter of each neighbour's, as logarithms; the ends and what is 0 stay.
  static std::vector<Candidate> smoothed(const std::vector<Candidate>& measured) {
    std::vector<Candidate> all = measured;
    for (size_t i = 2; i + 1 < measured.size(); ++i) {
      const double before = measured[i - 1].error, own = measured[i].error, after = measured[i + 1].error;
      if (before > 0 && own > 0 && after > 0) all[i].error = std::sqrt(own * std::sqrt(before * after));
    }
    return all;
  }
  // The same with resolutions between those that are measured. There the error is that of the power of the texels that meets both
  // neighbours: far from saturation an error is proportional to the width of a texel (law 5).
  std::vector<Candidate> with_steps_between(size_t light) const {
    constexpr int steps = 8;  // of an octave of texels
    const std::vector<Candidate> measured = smoothed(candidates_[light]);
    std::vector<Candidate> all = {measured[0], measured[1]};
    for (size_t i = 2; i < measured.size(); ++i) {
      const Candidate &a = measured[i - 1], &b = measured[i];
      for (int step = 1; step < steps && a.error > 0 && b.error > 0; ++step) {
        const double t = static_cast<double>(step) / steps;
        Candidate between = a;
        between.resolution =
            static_cast<int>(std::lround(a.resolution * std::pow(b.resolution / static_cast<double>(a.resolution), t)));
        between.texels = texels(light, between.resolution);
        between.error = a.error * std::pow(b.error / a.error, t);
        all.push_back(between);
      }
      all.push_back(b);
    }
    return all;
  }
  int equal_resolution(size_t light) const {
    return resolution_of(light, budget_ / static_cast<int64_t>(lights_.size()));
  }

  struct State {
    int64_t texels = 0;
    double error = 0;
    std::vector<size_t> chosen;
  };
  // Of the states with at most as many texels, the one with the least error; the others cannot be part of the best.
  static std::vector<State> front(std::vector<State> states) {
    std::stable_sort(states.begin(), states.end(), [](const State& a, const State& b) {
      return a.texels != b.texels ? a.texels < b.texels : a.error < b.error;
    });
    std::vector<State> kept;
    for (State& state : states)
      if (kept.empty() || state.error < kept.back().error) kept.push_back(std::move(state));
    return kept;
  }

  static double sum_of(const std::vector<Candidate>& chosen) {
    double sum = 0;
    for (const Candidate& one : chosen) sum += one.error;
    return sum;
  }

  // Measured.
  std::vector<Candidate> best() {
    std::vector<State> states = {{}};
    std::vector<std::vector<Candidate>> steps;
    for (size_t l = 0; l < lights_.size(); ++l) {
      const std::vector<Candidate>& all = steps.emplace_back(with_steps_between(l));
      std::vector<State> next;
      for (const State& state : states)
        for (size_t c = 0; c < all.size(); ++c) {
          if (state.texels + all[c].texels > budget_) continue;
          State longer{state.texels + all[c].texels, state.error + all[c].error, state.chosen};
          longer.chosen.push_back(c);
          next.push_back(std::move(longer));
        }
      states = front(std::move(next));
    }
    std::vector<Candidate> chosen;
    for (size_t l = 0; l < lights_.size(); ++l) {
      const Candidate& one = steps[l][states.back().chosen[l]];
      chosen.push_back(one.resolution == 0 ? one : candidate(l, one.resolution));
    }
    return chosen;
  }

  // Until no light gains from what is left, or a map would grow by less than a sixteenth of its side.
  void give_rest(std::vector<Candidate>& chosen) {
    for (;;) {
      int64_t left = budget_;
      for (const Candidate& one : chosen) left -= one.texels;
      std::optional<std::pair<size_t, Candidate>> most;
      double gain = 0;
      for (size_t l = 0; l < chosen.size(); ++l) {
        const int resolution = resolution_of(l, chosen[l].texels + left);
        if (resolution < least_map || 16 * resolution < 17 * chosen[l].resolution) continue;
        Candidate larger = candidate(l, resolution);
        if (chosen[l].error - larger.error <= gain) continue;
        gain = chosen[l].error - larger.error;
        most = {l, std::move(larger)};
      }
      if (!most) return;
      chosen[most->first] = std::move(most->second);
    }
  }

  // Measures the frame at the judged placements.
  TexelDivision division(const std::vector<Candidate>& chosen) {
    TexelDivision made;
    for (size_t l = 0; l < chosen.size(); ++l) {
      const Candidate& one = chosen[l];
      made.texels += one.texels;
      made.lights.push_back(
          {lights_[l].first, one.settings, one.resolution, one.texels, 0, 0, candidates_[l][0].error});
    }
    for (const int placement : judged_placements) {
      std::vector<LightPart> parts;
      for (size_t l = 0; l < chosen.size(); ++l)
        parts.push_back(chosen[l].resolution == 0 ? without_shadow(frame_[l])
                                                  : part_of(at_placement(bench_.scene(chosen[l].settings.scene),
                                                                         chosen[l].settings, judged_side, placement)));
      const LightsFrame frame = measure_lights(parts);
      const double share = 1.0 / static_cast<double>(judged_placements.size());
      PointRecord record;
      record.metrics = frame.metrics;
      if (ambiguous_room(record, "lights_error") > 0)
        throw Error(ErrorKind::usage,
                    fmt::format("it is not known which division has the least error: {}", ambiguous_note(record)));
      made.error += share * frame.metrics.at("lights_error");
      for (size_t l = 0; l < chosen.size(); ++l) {
        made.lights[l].error += share * frame.of_light[l].at("light_error");
        made.lights[l].weight = frame.of_light[l].at("light_weight");
      }
    }
    return made;
  }

  Workbench& bench_;
  const Lights& lights_;
  int64_t budget_;
  const std::function<void(const std::string&)>& say_;
  std::vector<int> tiles_;                          // of each light's map
  std::vector<std::vector<Candidate>> candidates_;  // of each light: without a map, by resolution
  std::vector<LightPart> frame_;  // each light with the smallest map: its lux and truth are those of every map
};

std::string with_spaces(int64_t number) {
  std::string digits = fmt::format("{}", number), text;
  for (size_t i = 0; i < digits.size(); ++i)
    text += (i > 0 && (digits.size() - i) % 3 == 0 ? " " : "") + digits.substr(i, 1);
  return text;
}

nlohmann::ordered_json json_of(const TexelDivision& division) {
  nlohmann::ordered_json json = {{"lights_error", division.error}, {"texels", division.texels}};
  for (const LightShare& light : division.lights)
    json["lights"].push_back({{"name", light.name},
                              {"resolution", light.resolution},
                              {"texels", light.texels},
                              {"light_weight", light.weight},
                              {"light_error", light.error},
                              {"light_error_without_map", light.without}});
  return json;
}

}  // namespace

TexelBudget divide_texels(Workbench& bench, const std::vector<std::pair<std::string, Settings>>& lights, int64_t texels,
                          const std::function<void(const std::string&)>& say) {
  int64_t least = 0;
  for (const auto& [name, settings] : lights) {
    const int tiles = make_light_frame(bench.scene(settings.scene), settings).tiles;
    least += int64_t{tiles} * least_map * least_map;
  }
  if (texels < least)
    throw Error(ErrorKind::usage,
                fmt::format("--texels {}: a map of {} texels on a side for each of {} takes {}; give at least that",
                            texels, least_map, counted(lights.size(), "light"), least));
  return Divider(bench, lights, texels, say).divide();
}

std::vector<std::string> budget_text(const TexelBudget& budget) {
  const Settings& first = budget.best.lights.front().settings;
  size_t width = 5;  // of "light"
  for (const LightShare& light : budget.best.lights) width = std::max(width, light.name.size());
  std::vector<std::string> lines = {
      fmt::format("{}: {} texels for {}, in a picture of {} x {} pixels", first.scene.name, with_spaces(budget.texels),
                  counted(budget.best.lights.size(), "light"), first.view.width_px, first.view.height_px),
      "",
      fmt::format("  {:<{}} {:>8} {:>12} {:>14} {:>14}", "light", width, "map", "of the light", "part of error",
                  "without a map")};
  for (const LightShare& light : budget.best.lights)
    lines.push_back(fmt::format("  {:<{}} {:>8} {:>12} {:>14} {:>14}", light.name, width,
                                light.resolution == 0 ? "none" : fmt::format("{}", light.resolution),
                                share_text(light.weight), share_text(light.error), share_text(light.without)));
  std::vector<std::string> equal;
  for (const LightShare& light : budget.equal.lights)
    equal.push_back(fmt::format("{} {}", light.name, light.resolution));
  lines.push_back("");
  lines.push_back(
      fmt::format("The frame's error is {} (lights_error, the mean of {} placements of the grids that the search did "
                  "not see), with {} texels.",
                  share_text(budget.best.error), judged_placements.size(), with_spaces(budget.best.texels)));
  lines.push_back(budget.best.error < budget.equal.error
                      ? fmt::format("An equal split ({}) has {}: {} more than this.", fmt::join(equal, ", "),
                                    share_text(budget.equal.error),
                                    share_text(budget.equal.error / budget.best.error - 1))
                      : std::string("It is an equal split: no other division that was tried has less error."));
  lines.push_back("noonmark run measures one placement of each grid, so its lights_error differs.");
  for (const LightShare& light : budget.best.lights)
    if (light.resolution == 0)
      lines.push_back(fmt::format("{} needs no map: without its shadow the frame is wrong by {}.", light.name,
                                  share_text(light.without)));
  return lines;
}

std::string budget_json(const TexelBudget& budget) {
  const nlohmann::ordered_json json = {{"scene", subject_of(budget.best.lights.front().settings)},
                                       {"texels", budget.texels},
                                       {"best", json_of(budget.best)},
                                       {"equal_split", json_of(budget.equal)}};
  return json.dump(2) + "\n";
}

std::string budget_experiment(const TexelBudget& budget, const std::string& folder) {
  const Settings& first = budget.best.lights.front().settings;
  std::string scene = first.scene.name;
  if (std::error_code none; names_file(scene)) scene = std::filesystem::proximate(scene, folder, none);
  std::string text = fmt::format(
      "# Written by noonmark recommend --texels {}. noonmark run measures the frame, at one placement of each grid.\n\n"
      "lights = \"parts\"\nscene = {}\n",
      budget.texels, toml_string(scene));
  const Settings defaults;
  const auto lines = [&](const Settings& settings, bool of_frame) {
    for (const Setting& row : settings_table())
      if (row.name != "scene.name" && is_of_frame(row.name) == of_frame && row.get(settings) != row.get(defaults))
        text += fmt::format("{} = {}\n", row.name, toml_value(row, row.get(settings)));
  };
  lines(first, true);
  for (const LightShare& light : budget.best.lights) {
    if (light.resolution == 0) {
      text +=
          fmt::format("\n# {} has no map: without its shadow the frame is wrong by {}. It is left out of this frame.\n",
                      printable(light.name), share_text(light.without));
      continue;
    }
    text += fmt::format("\n[[part]]\nname = {}\n", toml_string(light.name));
    lines(light.settings, false);
  }
  return text;
}

}  // namespace noonmark
