#include "app/recommend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "app/experiment.h"
#include "compare/judge/curve_reading.h"
#include "compare/store/quantities.h"
#include "scenes/error.h"
#include "technique/cost.h"
#include "technique/light_frame.h"
#include "technique/setting_rules.h"

namespace noonmark {
namespace {

constexpr int searched_placements = 8, fresh_placements = 8;  // along each axis
// A bias of more parts, or a dearer technique, must be this factor better than a lesser one, or it does not pay.
constexpr double factor_that_pays = 1.25;

// The same settings with a smaller picture of the same shape.
Settings small(Settings settings, int width_px) {
  const double scale = std::min(1.0, static_cast<double>(width_px) / settings.view.width_px);
  settings.view.width_px = std::max(1, static_cast<int>(std::lround(scale * settings.view.width_px)));
  settings.view.height_px = std::max(1, static_cast<int>(std::lround(scale * settings.view.height_px)));
  return settings;
}

// The settings whose values differ among the points.
std::vector<std::string> differing(const std::vector<PointRecord>& points) {
  std::vector<std::string> names;
  for (const auto& [name, text] : points.front().settings)
    for (const PointRecord& point : points)
      if (setting_of(point, name) != text) {
        names.push_back(name);
        break;
      }
  return names;
}

// Why no bias of the curve is usable, in numbers.
std::string why_no_window(const PointRecord& point, const CurveOptions& bounds) {
  const BiasCurve& curve = *point.curve;
  const bool placed = curve.placements > 1;
  const std::vector<double>& acne = placed ? curve.acne_worst : curve.acne;
  const std::vector<double>& panning = placed ? curve.peter_panning_worst : curve.peter_panning;
  size_t best = 0;
  const auto excess = [&](size_t i) {
    return std::max(acne[i] / bounds.acne_bound, panning[i] / bounds.peter_panning_bound);
  };
  for (size_t i = 1; i < acne.size(); ++i)
    if (excess(i) < excess(best)) best = i;
  return fmt::format(
      "no bias keeps both within {:.0f}% of their bounds: the best leaves {:.3g}% acne and {:.3g}% Peter Panning",
      100 * searched_share, 100 * acne[best], 100 * panning[best]);
}

class Search {
 public:
  Search(Workbench& bench, const AdviceRequest& request, const std::function<void(const std::string&)>& say)
      : bench_(bench), request_(request), say_(say), searched_(request.curve) {
    searched_.acne_bound *= searched_share;
    searched_.peter_panning_bound *= searched_share;
  }

  Advice run() {
    Advice advice;
    advice.request = request_;
    for (size_t level = 0; level < std::max<size_t>(1, request_.levels.size()); ++level) screen_level(level);
    for (std::optional<size_t> best = best_open(); best && !advice.answer; best = best_open()) {
      candidates_[*best].confirmed = true;
      confirm(candidates_[*best], advice);
      if (candidates_[*best].tried.why_not.empty())
        advice.answer = candidates_[*best].tried;
      else
        screen_finer(candidates_[*best]);
    }
    for (Candidate& candidate : candidates_) {
      Tried& tried = candidate.tried;
      if (tried.why_not.empty() && !candidate.confirmed)
        tried.why_not = why_worse(tried, advice.answer ? *advice.answer : tried);
      if (!tried.why_not.empty()) advice.tried.push_back(tried);
    }
    std::stable_sort(advice.tried.begin(), advice.tried.end(),
                     [](const Tried& a, const Tried& b) { return a.cost < b.cost; });
    if (!request_.levels.empty() && (!advice.answer || advice.answer->level != request_.levels.front().name))
      advice.least_resolution = least_resolution();
    advice.shadowed = shadowed_;
    return advice;
  }

 private:
  struct Candidate {
    Tried tried;
    size_t level = 0;
    bool confirmed = false;  // or refuted
  };

  // The best candidate that holds as far as is known and is not confirmed yet.
  std::optional<size_t> best_open() const {
    std::optional<size_t> best;
    for (size_t i = 0; i < candidates_.size(); ++i) {
      const Candidate& one = candidates_[i];
      if (one.confirmed || !one.tried.why_not.empty() || too_wrong(one.tried)) continue;
      if (!best || rank(one) < rank(candidates_[*best])) best = i;
    }
    return best;
  }

  // A resolution that does not hold everywhere was perhaps the last that was screened.
  void screen_finer(const Candidate& failed) {
    const Tried tried = failed.tried;
    const size_t level = failed.level;
    const bool known = std::any_of(candidates_.begin(), candidates_.end(), [&](const Candidate& other) {
      return other.level == level && same(other.tried.settings.filter, tried.settings.filter) &&
             other.tried.settings.map.resolution > tried.settings.map.resolution;
    });
    const auto finer =
        std::upper_bound(request_.resolutions.begin(), request_.resolutions.end(), tried.settings.map.resolution);
    if (known || finer == request_.resolutions.end()) return;
    Candidate made;
    made.level = level;
    made.tried.level = tried.level;
    made.tried.settings = of_choice(request_.conditions.front(), level, tried.settings.filter, *finer);
    if (screen(made.tried, 0)) candidates_.push_back(std::move(made));
  }

  // The least resolution from which on one constant bias keeps the bounds at every placement, under the first condition,
  // without a filter; the finest that the diagram has, negative, if none does. Empty where a diagram has no meaning.
  std::optional<int> least_resolution() {
    try {
      const Settings settings = small(of_choice(request_.conditions.front(), 0, {"none", {}}, 1024), request_.width_px);
      PhaseOptions options;
      options.rows = 17, options.coarsest = 1024, options.finest = 16384;
      options.acne_bound = request_.curve.acne_bound;
      options.peter_panning_bound = request_.curve.peter_panning_bound;
      say_("which resolution would be enough for one constant bias");
      const PhaseDiagram diagram = bench_.phase(phase_settings(settings, bench_.scene(settings.scene)), options);
      int least = -diagram.rows.back().resolution;
      for (auto row = diagram.rows.rbegin(); row != diagram.rows.rend() && !diagram.usable(*row).empty(); ++row)
        least = row->resolution;
      return least;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::usage) throw;
      return std::nullopt;
    }
  }

  Settings of_choice(Settings settings, size_t level, const FilterSettings& filter, int resolution) const {
    settings.filter = filter;
    if (!request_.levels.empty()) request_.levels[level].apply(settings);
    settings.map.resolution = resolution;
    return settings;
  }

  // The texel work of a picture of full size. The share of its pixels that look up is measured on the small picture.
  double full_cost(const Settings& full, const PointRecord& measured) const {
    const double pixels = number_of(setting_of(measured, "view.width_px")).value() *
                          number_of(setting_of(measured, "view.height_px")).value();
    const double share = metric_of(measured, "facing") / pixels;
    const int tiles =
        static_cast<int>(std::lround(metric_of(measured, "map_texels") / full.map.resolution / full.map.resolution));
    const auto receivers = std::llround(share * full.view.width_px * full.view.height_px);
    return static_cast<double>(frame_cost(full, tiles, receivers, 0).texel_work);
  }

  // A bias cannot mend what is not its fault: aliasing, the filter's blur and the light's size. The settings with the
  // least bias, and the same filter and resolution, if these alone are so much of their error that no other bias can
  // pay; otherwise null.
  const Tried* no_other_bias_pays(const FilterSettings& filter, int resolution) const {
    for (const Candidate& lesser : candidates_) {
      const Tried& tried = lesser.tried;
      if (lesser.level == 0 && tried.bias && tried.settings.map.resolution == resolution &&
          same(tried.settings.filter, filter) &&
          metric_of(*tried.worst, "acne") + metric_of(*tried.worst, "peter_panning") <
              (1 - 1 / factor_that_pays) * tried.error)
        return &tried;
    }
    return nullptr;
  }
  static bool same(const FilterSettings& a, const FilterSettings& b) {
    Settings first, second;
    first.filter = a, second.filter = b;
    return settings_map(first) == settings_map(second);
  }

  void screen_level(size_t level) {
    double best_before = std::numeric_limits<double>::infinity();  // of the filter before
    for (const FilterSettings& filter : request_.filters) {
      const size_t first = candidates_.size();
      screen_filter(level, filter);
      double best = std::numeric_limits<double>::infinity();
      for (size_t i = first; i < candidates_.size(); ++i)
        if (candidates_[i].tried.why_not.empty()) best = std::min(best, rank(candidates_[i]));
      // The filters come in the order of their reach. Once more blur is worse, still more is worse too; and a kernel that
      // reaches further needs more bias, so where one has no window, the next has none.
      if (best > best_before || !std::isfinite(best)) break;
      best_before = best;
    }
  }

  void screen_filter(size_t level, const FilterSettings& filter) {
    double before = 0;  // cost of the last resolution that had a window
    for (int resolution : request_.resolutions) {
      Candidate made;
      made.level = level;
      if (const Tried* lesser = level > 0 ? no_other_bias_pays(filter, resolution) : nullptr) {
        before = lesser->cost;
        continue;
      }
      made.tried.settings = of_choice(request_.conditions.front(), level, filter, resolution);
      made.tried.level = request_.levels.empty() ? "the bias as given" : request_.levels[level].name;
      if (!screen(made.tried, before)) break;
      const bool holds = made.tried.why_not.empty();
      if (holds && request_.error && made.tried.error <= *request_.error) {
        candidates_.push_back(std::move(made));
        break;  // finer texels are dearer and no more needed
      }
      if (holds) before = made.tried.cost;
      candidates_.push_back(std::move(made));
    }
  }

  static std::string name_of(const Tried& tried) {
    const FilterSettings& filter = tried.settings.filter;
    return fmt::format("{}, {} texels, filter {}{}", tried.level, tried.settings.map.resolution, filter.kind,
                       filter.kind == "castano" ? fmt::format(" {}", filter.whole("size")) : "");
  }

  // False if neither these settings nor dearer ones can win.
  bool screen(Tried& tried, double cost_before) {
    Settings settings = small(tried.settings, request_.width_px);
    try {
      require_memory(bench_.memory(settings, true, false), bench_.memory_of_program(false), "the search");
      PointRecord record = bench_.measure(settings, searched_).record;
      if (nothing_judged(record))
        throw Error(ErrorKind::usage, "nothing of the scene that faces the light is in view; choose another view");
      measured_ = true;
      shadowed_ = std::max(shadowed_, 1 - metric_of(record, "lit"));
      tried.cost = full_cost(tried.settings, record);
      if (request_.budget && tried.cost > *request_.budget) return false;
      // Law 5: half the texel, half the error on average. So the product of cost and error does not fall any more.
      if (!request_.error && !request_.budget && cost_before > 0 && tried.cost >= 2 * cost_before) return false;
      judge(tried, {record});
      say_(fmt::format("{}: {}", name_of(tried),
                       tried.bias ? fmt::format("usable, error {:.3g}%", 100 * tried.error) : tried.why_not));
    } catch (const Error& error) {
      if (!measured_) throw;  // not even the first settings can be measured
      if (error.kind() != ErrorKind::usage) throw;
      return false;  // a combination that does not exist, or a map that does not fit into memory
    }
    return true;
  }

  // Chooses the bias for the points, one for each condition, and measures the error there.
  void judge(Tried& tried, std::vector<PointRecord> points) {
    tried.bias.reset();
    tried.worst.reset();
    tried.why_not.clear();
    Results results;
    results.info.accuracy = request_.accuracy;
    results.info.over = differing(points);
    results.planned_points = static_cast<int64_t>(points.size());
    results.points = std::move(points);
    const auto failing = std::find_if(results.points.begin(), results.points.end(),
                                      [](const PointRecord& p) { return p.curve && !usable_window(*p.curve); });
    if (failing != results.points.end()) {
      tried.why_not = why_no_window(*failing, searched_);
      tried.worst = *failing;
      return;
    }
    const std::vector<Recommendation> good = good_choices(results);
    if (good.empty()) {
      tried.why_not = results.points.front().curve ? "no bias is usable under every condition"
                                                   : why_no_curve(results.points.front());
      tried.worst = results.points.front();
      return;
    }
    tried.bias = good.front().bias;
    set_bias(tried.settings, *tried.bias);
    tried.error = 0;
    for (const PointRecord& point : results.points) {
      Settings there = of_record(point);
      there.map.placements = 1;
      set_bias(there, *tried.bias);
      const PointRecord shown = bench_.measure(there, std::nullopt).record;
      const double error = metric_of(shown, request_.accuracy);
      if (!tried.worst || !(error <= tried.error)) tried.error = error, tried.worst = shown;
    }
  }

  static void set_bias(Settings& settings, const BiasChoice& bias) {
    find_setting(bias.parameter).set(settings, fmt::format("{}", bias.value));
  }

  double rank(const Candidate& candidate) const {
    const Tried& tried = candidate.tried;
    const double handicap = std::pow(factor_that_pays, static_cast<double>(candidate.level));
    if (too_wrong(tried)) return std::numeric_limits<double>::infinity();
    if (request_.error) return handicap * tried.cost;
    if (request_.budget) return handicap * tried.error;
    return handicap * tried.cost * tried.error;
  }

  bool too_wrong(const Tried& tried) const { return request_.error && !(tried.error <= *request_.error); }

  std::string why_worse(const Tried& tried, const Tried& answer) const {
    if (too_wrong(tried))
      return fmt::format("its error of {:.3g}% is above {:.3g}%", 100 * tried.error, 100 * *request_.error);
    if (request_.error) return "it is dearer";
    if (request_.budget) return fmt::format("its error is {:.3g}%", 100 * tried.error);
    if (tried.cost < answer.cost)
      return fmt::format("its error is {:.2g} times as large, for {:.2g} times less work", tried.error / answer.error,
                         answer.cost / tried.cost);
    return tried.error < answer.error ? fmt::format("its error is {:.2g} times less, but for {:.2g} times the work",
                                                    answer.error / tried.error, tried.cost / answer.cost)
                                      : "it is dearer and no more accurate";
  }

  // All conditions at many placements, and then others, rendered.
  void confirm(Candidate& candidate, Advice& advice) {
    Tried& tried = candidate.tried;
    say_(fmt::format("confirming {}, under {} conditions at {} placements", name_of(tried), request_.conditions.size(),
                     searched_placements * searched_placements));
    std::vector<PointRecord> points;
    for (const Settings& condition : request_.conditions) {
      Settings there =
          small(of_choice(condition, candidate.level, tried.settings.filter, tried.settings.map.resolution),
                request_.width_px);
      there.map.placements = searched_placements;
      PointRecord record = bench_.measure(there, searched_).record;
      if (nothing_judged(record)) {
        say_("a view in which nothing can be judged is left out");
        continue;
      }
      points.push_back(std::move(record));
      if (points.back().curve && !usable_window(*points.back().curve)) break;  // that is enough to know
    }
    const size_t seen = points.size();
    judge(tried, std::move(points));
    if (!tried.why_not.empty()) return;
    advice.conditions = seen;
    if (too_wrong(tried)) {
      tried.why_not = why_worse(tried, tried);
      return;
    }
    verify(tried, advice);
  }

  void verify(Tried& tried, Advice& advice) {
    say_("verifying at 64 other placements");
    const Settings at_worst = of_record(*tried.worst);
    advice.placements = searched_placements * searched_placements;
    advice.verified = 0;
    advice.worst_acne = advice.worst_peter_panning = advice.worst_error = 0;
    std::mt19937_64 random(64);
    for (int i = 0; i < fresh_placements * fresh_placements; ++i) {
      const PointRecord shown = bench_.measure(fresh(at_worst, i, random), std::nullopt).record;
      advice.worst_acne = std::max(advice.worst_acne, metric_of(shown, "acne"));
      advice.worst_peter_panning = std::max(advice.worst_peter_panning, metric_of(shown, "peter_panning"));
      advice.worst_error = std::max(advice.worst_error, metric_of(shown, request_.accuracy));
      ++advice.verified;
      if (metric_of(shown, "acne") <= request_.curve.acne_bound &&
          metric_of(shown, "peter_panning") <= request_.curve.peter_panning_bound)
        continue;
      tried.why_not =
          fmt::format("rendered at another placement of the grid it has {:.3g}% acne and {:.3g}% Peter Panning",
                      100 * metric_of(shown, "acne"), 100 * metric_of(shown, "peter_panning"));
      tried.worst = shown;
      return;
    }
  }

  static Settings of_record(const PointRecord& point) {
    Settings settings;
    for (const Setting& row : settings_table()) row.set(settings, setting_of(point, std::string(row.name)));
    return settings;
  }

  // A placement that is none of the searched ones: half a step between them for a flat map, a random turn for a cube.
  Settings fresh(Settings settings, int i, std::mt19937_64& random) {
    if (make_light_frame(bench_.scene(settings.scene), settings).map_shape() == MapShape::flat) {
      settings.map.shift_u_texels += (i % fresh_placements + 0.5) / fresh_placements - 0.5;
      settings.map.shift_v_texels += (i / fresh_placements + 0.5) / fresh_placements - 0.5;
      return settings;
    }
    // Shoemake, "Uniform random rotations" (Graphics Gems III, 1992).
    std::uniform_real_distribution<> unit(0, 1);
    const double a = unit(random), b = 2 * std::numbers::pi * unit(random), c = 2 * std::numbers::pi * unit(random);
    const glm::dquat turn(std::sqrt(a) * std::cos(c), std::sqrt(1 - a) * std::sin(b), std::sqrt(1 - a) * std::cos(b),
                          std::sqrt(a) * std::sin(c));
    settings.map.turn_deg = glm::axis(turn) * (glm::angle(turn) * 180 / std::numbers::pi);
    return settings;
  }

  Workbench& bench_;
  const AdviceRequest& request_;
  const std::function<void(const std::string&)>& say_;
  CurveOptions searched_;  // the bounds while searching
  std::vector<Candidate> candidates_;
  bool measured_ = false;  // whether any settings were
  double shadowed_ = 0;
};

}  // namespace

Advice search(Workbench& bench, const AdviceRequest& request, const std::function<void(const std::string&)>& say) {
  return Search(bench, request, say).run();
}

}  // namespace noonmark
