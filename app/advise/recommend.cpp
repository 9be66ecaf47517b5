#include "app/advise/recommend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "app/advise/recommend_cost.h"
#include "app/advise/recommend_judge.h"
#include "app/advise/recommend_verify.h"
#include "app/definition/experiment.h"
#include "base/error.h"
#include "base/text.h"
#include "compare/judge/curve_reading.h"
#include "compare/results/quantities.h"
#include "technique/cost.h"

namespace noonmark {
namespace {

// A bias of more parts, or a dearer technique, must be this factor better than a lesser one, or it does not pay.
constexpr double factor_that_pays = 1.25;

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
    screen_all();
    for (std::optional<size_t> best = best_open(); best && !advice.answer; best = best_open()) {
      candidates_[*best].confirmed = true;
      confirm(candidates_[*best], advice);
      if (candidates_[*best].tried.why_not.empty()) {
        advice.answer = candidates_[*best].tried;
      } else {
        screen_finer(candidates_[*best]);
        screen_all();  // what could not win against the one that failed
      }
    }
    if (!advice.answer) take_narrow(advice);
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
    if (!advice.answer) advice.nearest = look_at_nearest(advice.tried);
    advice.shadowed = shadowed_;
    return advice;
  }

 private:
  struct Candidate {
    Tried tried;
    size_t level = 0;
    bool confirmed = false;  // or refuted
    size_t narrow = 0;       // its window is too narrow for the margin, but it holds under so many conditions
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

  // Of those with a window the one of least error, otherwise the one that leaves least, of several the cheapest.
  std::optional<Tried> look_at_nearest(const std::vector<Tried>& all) {
    const auto distance = [&](const Tried& tried) {
      if (tried.bias) return std::pair(0, tried.error);
      if (!tried.nearest) return std::pair(2, 0.0);
      return std::pair(1, excess(*tried.nearest, searched_));
    };
    const auto found = std::min_element(all.begin(), all.end(),
                                        [&](const Tried& a, const Tried& b) { return distance(a) < distance(b); });
    if (found == all.end()) return std::nullopt;
    Tried tried = *found;
    if (!tried.nearest) return tried;
    Settings there = settings_of(*tried.worst);
    there.map.placements = 1;
    find_setting(tried.worst->curve->parameter).set(there, fmt::format("{}", tried.nearest->bias));
    const Measurement m = bench_.measure(there, std::nullopt);
    tried.worst = m.record;
    tried.worst->worst = worst_of_bias(m);
    return tried;
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

  std::optional<int> least_resolution() {
    say_("which resolution would be enough for one constant bias");
    return constant_bias_resolution(
        bench_, small_picture(of_choice(request_.conditions.front(), 0, {"none", {}}, 1024), request_.width_px),
        request_.curve);
  }

  Settings of_choice(Settings settings, size_t level, const FilterSettings& filter, int resolution) const {
    settings.filter = filter;
    if (!request_.levels.empty()) request_.levels[level].apply(settings);
    settings.map.resolution = resolution;
    return settings;
  }

  // Whether the cost alone rules the settings out.
  bool too_dear(double cost, double cost_before) const {
    if (request_.budget && cost > *request_.budget) return true;
    // Law 5: half the texel, half the error on average. So the product of cost and error does not fall any more.
    return !request_.error && !request_.budget && cost_before > 0 && cost >= 2 * cost_before;
  }

  // What is known already is not measured again.
  void screen_all() {
    for (size_t level = 0; level < std::max<size_t>(1, request_.levels.size()); ++level) screen_level(level);
  }

  // Whether settings that make no error at all ask for no more of anything: then these cannot win.
  bool cannot_win(size_t level, const Settings& settings) const {
    const int fetches = lookup_cost(settings).fetches;
    return std::any_of(candidates_.begin(), candidates_.end(), [&](const Candidate& one) {
      const Tried& tried = one.tried;
      return tried.why_not.empty() && tried.bias && tried.error == 0 && one.level <= level &&
             tried.settings.map.resolution <= settings.map.resolution && lookup_cost(tried.settings).fetches <= fetches;
    });
  }

  std::optional<size_t> known(size_t level, const FilterSettings& filter, int resolution) const {
    for (size_t i = 0; i < candidates_.size(); ++i)
      if (const Candidate& one = candidates_[i]; one.level == level &&
                                                 one.tried.settings.map.resolution == resolution &&
                                                 same(one.tried.settings.filter, filter))
        return i;
    return std::nullopt;
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
      screen_filter(level, filter);
      double best = std::numeric_limits<double>::infinity();
      for (const Candidate& one : candidates_)
        if (one.level == level && same(one.tried.settings.filter, filter) && one.tried.why_not.empty())
          best = std::min(best, rank(one));
      // The filters come in the order of their reach. Once more blur is worse, still more is worse too.
      if (best > best_before || !std::isfinite(best)) break;
      best_before = best;
    }
  }

  // Whether by law 5 this resolution or a finer one can be worth more than the best that is known. coarser: holds.
  bool may_pay(const Candidate& coarser, int resolution) const {
    if (request_.error || request_.budget) return true;
    double best = std::numeric_limits<double>::infinity();
    for (const Candidate& one : candidates_)
      if (one.tried.why_not.empty()) best = std::min(best, rank(one));
    return std::any_of(request_.resolutions.begin(), request_.resolutions.end(), [&](int finer) {
      Candidate one = coarser;
      one.tried.settings.map.resolution = finer;
      one.tried.cost = full_texel_work(one.tried.settings, *seen_);
      one.tried.error *= static_cast<double>(coarser.tried.settings.map.resolution) / finer;
      return finer >= resolution && rank(one) < best;
    });
  }

  // A kernel that reaches further needs more bias, so where a lesser one has no window, this one has none.
  bool lesser_filter_fails(size_t level, const FilterSettings& filter, int resolution) const {
    for (const FilterSettings& lesser : request_.filters) {
      if (same(lesser, filter)) return false;
      if (const auto place = known(level, lesser, resolution); place && candidates_[*place].tried.nearest) return true;
    }
    return false;
  }

  void screen_filter(size_t level, const FilterSettings& filter) {
    double before = 0;           // cost of the last resolution that had a window
    std::optional<size_t> last;  // that candidate
    for (int resolution : request_.resolutions) {
      if (lesser_filter_fails(level, filter, resolution)) continue;
      if (const Tried* lesser = level > 0 ? no_other_bias_pays(filter, resolution) : nullptr) {
        before = lesser->cost;
        continue;
      }
      std::optional<size_t> place = known(level, filter, resolution);
      if (!place) {
        Candidate made;
        made.level = level;
        made.tried.settings = of_choice(request_.conditions.front(), level, filter, resolution);
        made.tried.level = request_.levels.empty() ? "the bias as given" : request_.levels[level].name;
        if (cannot_win(level, made.tried.settings) || (last && !may_pay(candidates_[*last], resolution)) ||
            !screen(made.tried, before))
          break;
        place = candidates_.size();
        candidates_.push_back(std::move(made));
      }
      const Tried& tried = candidates_[*place].tried;
      // Law 9: acne and Peter Panning halve with each doubling, so not even the finest texels would do.
      if (tried.nearest && excess(*tried.nearest, searched_) * resolution > request_.resolutions.back()) break;
      if (!tried.why_not.empty()) continue;
      if (request_.error && tried.error <= *request_.error) break;  // finer texels are dearer and no more needed
      before = tried.cost;
      last = place;
    }
  }

  static std::string name_of(const Tried& tried) {
    const FilterSettings& filter = tried.settings.filter;
    return fmt::format("{}, {} texels, filter {}{}", tried.level, tried.settings.map.resolution, filter.kind,
                       filter.kind == "castano" ? fmt::format(" {}", filter.whole("size")) : "");
  }

  // False if neither these settings nor dearer ones can win.
  bool screen(Tried& tried, double cost_before) {
    Settings settings = small_picture(tried.settings, request_.width_px);
    if (seen_ && too_dear(full_texel_work(tried.settings, *seen_), cost_before)) return false;
    try {
      require_memory(bench_.memory(settings, true, false), bench_.memory_of_program(false), "the search");
      PointRecord record = bench_.measure(settings, searched_).record;
      if (nothing_judged(record))
        throw Error(ErrorKind::usage, "nothing of the scene that faces the light is in view; choose another view");
      if (!seen_) seen_ = seen_share(record);
      shadowed_ = std::max(shadowed_, 1 - metric_of(record, "lit"));
      tried.cost = full_texel_work(tried.settings, *seen_);
      if (too_dear(tried.cost, cost_before)) return false;
      judge_bias(bench_, tried, {record}, searched_, request_.accuracy);
      say_(fmt::format("{}: {}", name_of(tried),
                       tried.bias ? fmt::format("usable, error {:.3g}%", 100 * tried.error) : tried.why_not));
    } catch (const Error& error) {
      if (!seen_) throw;  // not even the first settings can be measured
      if (error.kind() != ErrorKind::usage) throw;
      return false;  // a combination that does not exist, or a map that does not fit into memory
    }
    return true;
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
    say_(fmt::format("confirming {}, under {} at {} placements", name_of(tried),
                     counted(request_.conditions.size(), "condition"), searched_placements * searched_placements));
    // The condition that refuted the one before comes first, because it probably refutes this one too.
    std::map<size_t, PointRecord> of_condition;
    for (size_t i = 0; i < request_.conditions.size(); ++i) {
      const size_t which = i == 0 ? hardest_ : i <= hardest_ ? i - 1 : i;
      Settings there = small_picture(
          of_choice(request_.conditions[which], candidate.level, tried.settings.filter, tried.settings.map.resolution),
          request_.width_px);
      there.map.placements = searched_placements;
      PointRecord record = bench_.measure(there, searched_).record;
      if (nothing_judged(record)) {
        say_("a view in which nothing can be judged is left out");
        continue;
      }
      shadowed_ = std::max(shadowed_, 1 - metric_of(record, "lit"));
      const bool fails = record.curve && !usable_window(*record.curve);
      of_condition.emplace(which, std::move(record));
      if (!fails) continue;
      hardest_ = which;
      break;  // that is enough to know
    }
    std::vector<PointRecord> points;
    for (auto& [which, record] : of_condition) points.push_back(std::move(record));
    const size_t seen = points.size();
    judge_bias(bench_, tried, std::move(points), searched_, request_.accuracy);
    if (!tried.why_not.empty()) return;
    advice.conditions = seen;
    if (too_wrong(tried)) {
      tried.why_not = why_worse(tried, tried);
      return;
    }
    if (tried.bias->narrow) {
      candidate.narrow = seen;
      tried.why_not =
          fmt::format("its window, {:.3g} to {:.3g} {}, is too narrow for a margin of {:.0f}% on both sides",
                      tried.bias->window.low, tried.bias->window.high, tried.bias->unit, 100 * (bias_margin - 1));
      return;
    }
    verify(tried, advice);
  }

  // If nothing holds with the margin: the best that holds without it.
  void take_narrow(Advice& advice) {
    std::multimap<double, Candidate*> narrow;
    for (Candidate& one : candidates_)
      if (one.narrow > 0) narrow.emplace(rank(one), &one);
    for (const auto& [order, one] : narrow) {
      one->tried.why_not.clear();
      advice.conditions = one->narrow;
      verify(one->tried, advice);
      if (!one->tried.why_not.empty()) continue;
      advice.answer = one->tried;
      return;
    }
  }

  void verify(Tried& tried, Advice& advice) {
    say_("verifying at 64 other placements");
    const Verified verified = verify_at_fresh_placements(bench_, settings_of(*tried.worst), request_.curve,
                                                         request_.accuracy, request_.error, [&](int done, int of) {
                                                           if (done % 16 == 0 && done < of)
                                                             say_(fmt::format("verified at {} of {}", done, of));
                                                         });
    advice.placements = searched_placements * searched_placements;
    advice.verified = verified.placements;
    advice.worst_acne = verified.worst_acne, advice.worst_peter_panning = verified.worst_peter_panning;
    advice.worst_error = verified.worst_error;
    if (!verified.broken) return;
    tried.why_not = fmt::format(
        "rendered at another placement of the grid it has {:.3g}% acne, {:.3g}% Peter Panning and {:.3g}% "
        "error",
        100 * metric_of(*verified.broken, "acne"), 100 * metric_of(*verified.broken, "peter_panning"),
        100 * metric_of(*verified.broken, request_.accuracy));
    tried.worst = verified.broken;
  }

  Workbench& bench_;
  const AdviceRequest& request_;
  const std::function<void(const std::string&)>& say_;
  CurveOptions searched_;  // the bounds while searching
  std::vector<Candidate> candidates_;
  std::optional<SeenShare> seen_;  // empty until some settings are measured
  double shadowed_ = 0;
  size_t hardest_ = 0;  // the condition that refuted the last candidate
};

}  // namespace

std::vector<Settings> answer_under_conditions(const Advice& advice) {
  const Settings& answer = advice.answer->settings;
  std::vector<Settings> all;
  for (const Settings& condition : advice.request.conditions) {
    Settings there = small_picture(condition, advice.request.width_px);
    there.bias = answer.bias, there.filter = answer.filter;
    there.map.resolution = answer.map.resolution, there.map.cull = answer.map.cull;
    there.map.placements = searched_placements;
    all.push_back(std::move(there));
  }
  return all;
}

Advice search(Workbench& bench, const AdviceRequest& request, const std::function<void(const std::string&)>& say) {
  return Search(bench, request, say).run();
}

}  // namespace noonmark
