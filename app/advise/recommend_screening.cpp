#include "app/advise/recommend_screening.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/advise/recommend_filtered.h"
#include "app/advise/recommend_judge.h"
#include "base/error.h"
#include "compare/judge/undecided.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"
#include "measure/memory_estimate.h"
#include "technique/cost.h"

namespace noonmark {
namespace {

SeenShare seen_share(const PointRecord& measured) {
  const auto setting = [&](const char* name) { return number_of(setting_of(measured, name)).value(); };
  const double side = setting("map.resolution");
  return {metric_of(measured, "facing") / (setting("view.width_px") * setting("view.height_px")),
          metric_of(measured, "map_texels") / side / side / setting("cascades.count")};
}

// texel_work (technique/cost.h).
double full_texel_work(const Settings& full, const SeenShare& seen) {
  const auto receivers = std::llround(seen.facing * full.view.width_px * full.view.height_px);
  const auto texels = std::llround(seen.map_squares * full.map.resolution * full.map.resolution * full.cascades.count);
  return static_cast<double>(frame_cost(full, 1, texels, receivers, 0).texel_work);
}

}  // namespace

std::string name_of(const Tried& tried, const AdviceRequest& request) {
  const FilterSettings& filter = tried.settings.filter;
  const MapPlace& place = request.places[tried.place];
  return fmt::format(
      "{}, {} texels{}, filter {}{}", tried.level, tried.settings.map.resolution,
      tried.settings.cascades.count > 1 ? fmt::format(" in {} cascades{}{}", tried.settings.cascades.count,
                                                      place.laid_by.empty() ? "" : " of ", place.laid_by)
      : place.moves_with                ? " over " + place.covers
                                        : "",
      filter.kind,
      filter.kind == "castano" || (tried.filtered() && filter.kind != "none") ? fmt::format(" {}", filter.whole("size"))
                                                                              : "");
}

const std::vector<FilterSettings>& filters_of(const AdviceRequest& request, size_t level) {
  return level < request.levels.size() && request.levels[level].filtered() ? request.levels[level].blurs
                                                                           : request.filters;
}

Settings Screening::of_choice(Settings settings, size_t level, size_t place, const FilterSettings& filter,
                              int resolution) const {
  settings.filter = filter;
  if (!request_.levels.empty()) request_.levels[level].apply(settings);
  request_.places[place].apply(settings);
  settings.map.resolution = resolution;
  return settings;
}

void Screening::see(const PointRecord& record) {
  if (hides_bounds(record))
    throw Error(ErrorKind::usage,
                fmt::format("no bound on acne or Peter Panning can be said to hold: {}", ambiguous_note(record)));
  const double lit = metric_of(record, "lit");
  shadowed_ = std::max(shadowed_, 1 - lit);
  lit_ = std::max(lit_, lit);
}

void Screening::run() {
  for (int resolution : request_.resolutions) {
    for (size_t level = 0; level < std::max<size_t>(1, request_.levels.size()); ++level)
      for (size_t place = 0; place < request_.places.size(); ++place)
        for (const FilterSettings& filter : filters_of(request_, level)) {
          const Choice choice{level, place, filter, resolution};
          if (!known(choice) && worth_measuring(choice)) measure(choice);
        }
  }
}

bool Screening::try_at(const Candidate& like, int resolution) {
  const FilterSettings filter = like.tried.settings.filter;  // the candidates move in memory
  const Choice choice{like.level, like.tried.place, filter, resolution};
  if (known(choice)) return false;
  measure(choice);
  return true;
}

std::string why_too_wrong(const Tried& tried, const AdviceRequest& request) {
  if (!request.error || tried.error <= *request.error) return "";
  return fmt::format("its error of {} is above {}", share_text(tried.error), share_text(*request.error));
}

double Screening::error_of(const Tried& tried) const {
  const Settings settings = small_picture(tried.settings, request_.width_px);
  return metric_of(bench_.measure(settings, std::nullopt, metric_set_for(request_.accuracy), Checks::none).record,
                   placed_accuracy(bench_, settings, request_.accuracy));
}

template <typename Is>
const Candidate* Screening::find(const Is& is) const {
  const auto found = std::find_if(candidates_.begin(), candidates_.end(), is);
  return found == candidates_.end() ? nullptr : &*found;
}

const Candidate* Screening::known(const Choice& choice) const {
  return find([&](const Candidate& one) {
    return one.level == choice.level && one.tried.place == choice.place &&
           one.tried.settings.map.resolution == choice.resolution && one.tried.settings.filter == choice.filter;
  });
}

bool Screening::is_filtered(const Choice& choice) const {
  return !request_.levels.empty() && request_.levels[choice.level].filtered();
}

double Screening::cost_of(const Choice& choice) const {
  return full_texel_work(
      of_choice(request_.conditions.front(), choice.level, choice.place, choice.filter, choice.resolution), *seen_);
}

double Screening::cost(const Settings& settings) const { return full_texel_work(settings, *seen_); }

double Screening::cost_at(const Candidate& like, int resolution) const {
  return cost_of({like.level, like.tried.place, like.tried.settings.filter, resolution});
}

std::map<std::string, double> Screening::least_costs() const {
  std::map<std::string, double> least;
  if (!seen_) return least;
  for (size_t level = 0; level < request_.levels.size(); ++level)
    for (size_t place = 0; place < request_.places.size(); ++place)
      for (const FilterSettings& filter : filters_of(request_, level)) {
        const double cost = cost_of({level, place, filter, request_.resolutions.front()});
        const auto [known, is_new] = least.emplace(request_.levels[level].lookup, cost);
        if (!is_new) known->second = std::min(known->second, cost);
      }
  return least;
}

// What costs more can be none of the three answers.
double Screening::most_cost() const {
  if (request_.budget) return *request_.budget;
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& one : candidates_)
    if (one.holds()) least = std::min(least, one.tried.cost);
  return budget_of_least * least;
}

bool Screening::worth_measuring(const Choice& choice) const {
  if (!seen_) return true;
  if (cost_of(choice) > most_cost() || fails_for_good(choice) || lesser_filter_has_no_window(choice)) return false;
  if (choice.level > 0 && !is_filtered(choice) && !another_bias_can_pay(choice)) return false;
  return !cannot_win(choice);
}

// Whether something that was measured tells that these settings are no answer, whatever their bias.
bool Screening::cannot_win(const Choice& choice) const {
  return more_blur_is_worse(choice) || finer_is_not_better(choice) || nothing_is_wrong_for_less(choice);
}

// Law 9: acne and Peter Panning halve with each doubling. So a coarser map says whether not even the finest would do.
bool Screening::fails_for_good(const Choice& choice) const {
  return find([&](const Candidate& coarser) {
           const Tried& tried = coarser.tried;
           const int resolution = tried.settings.map.resolution;
           return coarser.level == choice.level && tried.place == choice.place && tried.nearest &&
                  resolution < choice.resolution && tried.settings.filter == choice.filter &&
                  excess(*tried.nearest, searched_) * resolution > request_.resolutions.back();
         }) != nullptr;
}

// A bias cannot mend what is not its fault: aliasing, the filter's blur and the light's size. With the least kind of bias it is
// known how much of the error, and how far edges lie off, is due to these. In an engine one kind of bias can keep the bounds
// where another one does not: what fails there says nothing of the others.
bool Screening::another_bias_can_pay(const Choice& choice) const {
  const Choice least{0, choice.place, choice.filter, choice.resolution};
  const Candidate* lesser = known(least);
  if (!lesser) return !cannot_win(least);
  if (!lesser->tried.bias || lesser->tried.fails_elsewhere) return true;
  return !lesser->edges_too_far &&
         metric_of(*lesser->tried.worst, "acne") + metric_of(*lesser->tried.worst, "peter_panning") >=
             (1 - 1 / factor_that_pays) * lesser->tried.screened_error;
}

// A kernel that reaches further needs more bias, so where a lesser one has no window, this one has none. The filters come in
// the order of their reach.
bool Screening::lesser_filter_has_no_window(const Choice& choice) const {
  for (const FilterSettings& lesser : filters_of(request_, choice.level)) {
    if (lesser == choice.filter) return false;
    const Candidate* one = known({choice.level, choice.place, lesser, choice.resolution});
    if (one && one->tried.nearest) return true;
  }
  return false;
}

// Once more blur is worse, still more is worse too. And a filter brings edges at most half as near again.
bool Screening::more_blur_is_worse(const Choice& choice) const {
  double before = std::numeric_limits<double>::infinity();
  for (const FilterSettings& lesser : filters_of(request_, choice.level)) {
    if (lesser == choice.filter) return false;
    const Candidate* one = known({choice.level, choice.place, lesser, choice.resolution});
    if (!one || !one->tried.usable()) continue;
    if (one->tried.screened_error > before || one->edges_mean_pixels > 2 * most_edges(request_)) return true;
    before = one->tried.screened_error;
  }
  return false;
}

// Whether something that holds costs no more, and errs no more than these settings will by law 5: half the texel, half the error
// on average. A single map can be better than that by chance; error_that_pays allows for it.
bool Screening::finer_is_not_better(const Choice& choice) const {
  const Candidate* coarser = nullptr;
  for (const Candidate& one : candidates_)
    if (one.level == choice.level && one.tried.place == choice.place && one.tried.usable() &&
        one.tried.settings.map.resolution < choice.resolution && one.tried.settings.filter == choice.filter &&
        (!coarser || one.tried.settings.map.resolution > coarser->tried.settings.map.resolution))
      coarser = &one;
  if (!coarser) return false;
  const double expected =
      coarser->tried.screened_error * coarser->tried.settings.map.resolution / choice.resolution / error_that_pays;
  const double cost = cost_of(choice);
  return find([&](const Candidate& one) {
           return one.holds() && one.tried.cost <= cost && one.tried.screened_error <= expected;
         }) != nullptr;
}

// Whether settings that make no error at all ask for no more of anything.
bool Screening::nothing_is_wrong_for_less(const Choice& choice) const {
  const Settings settings =
      of_choice(request_.conditions.front(), choice.level, choice.place, choice.filter, choice.resolution);
  const int fetches = lookup_cost(settings).fetches;
  return find([&](const Candidate& one) {
           const Tried& tried = one.tried;
           return one.holds() && tried.screened_error == 0 && one.level <= choice.level &&
                  tried.settings.map.resolution <= choice.resolution && lookup_cost(tried.settings).fetches <= fetches;
         }) != nullptr;
}

// The small picture shows the same edges as the one of full size, smaller. Where they lie too far off on average, 95% of them do.
void Screening::judge_edges(Candidate& candidate) const {
  Tried& tried = candidate.tried;
  const Settings small = small_picture(tried.settings, request_.width_px);
  const double larger = tried.settings.view.width_px / static_cast<double>(small.view.width_px);
  candidate.edges_mean_pixels = larger * eye_errors(*tried.worst).edge_mean_pixels;
  candidate.edges_too_far = candidate.edges_mean_pixels > most_edges(request_);
  if (candidate.edges_too_far && tried.why_not.empty())
    tried.why_not = fmt::format("its shadow edges lie some {:.2g} pixels off on average, more than {:g}",
                                candidate.edges_mean_pixels, most_edges(request_));
}

double most_edges(const AdviceRequest& request) {
  for (const Bound& bound : request.eye)
    if (bound.metric == edge_metric && bound.where.empty()) return *bound.max;
  return std::numeric_limits<double>::infinity();
}

// A combination that does not exist, or a map that does not fit into memory, is a candidate that says so.
void Screening::measure(const Choice& choice) {
  Candidate made;
  made.level = choice.level;
  Tried& tried = made.tried;
  tried.place = choice.place;
  tried.settings = of_choice(request_.conditions.front(), choice.level, choice.place, choice.filter, choice.resolution);
  tried.level = request_.levels.empty() ? "the bias as given" : request_.levels[choice.level].name;
  try {
    const Settings settings = small_picture(tried.settings, request_.width_px);
    require_memory(bench_.memory(settings, true, false), bench_.memory_of_program(false), "the search");
    PointRecord record = bench_.measure(settings, searched_, metric_set_for(request_.accuracy), Checks::none).record;
    if (nothing_judged(record))
      throw Error(ErrorKind::usage, "nothing of the scene that faces the light is in view; choose another view");
    see(record);
    if (!seen_) seen_ = seen_share(record);
    if (tried.filtered())
      judge_filtered(bench_, tried, {record}, searched_, request_.accuracy);
    else
      judge_bias(bench_, tried, {record}, searched_, request_.accuracy);
    tried.screened_error = tried.error;
    if (tried.usable()) {
      tried.why_not = why_too_wrong(tried, request_);
      judge_edges(made);
    }
  } catch (const Error& error) {
    if (!seen_) throw;  // not even the first settings can be measured
    if (error.kind() != ErrorKind::usage) throw;
    tried.why_not = error.what();
    made.possible = false;
  }
  tried.cost = full_texel_work(tried.settings, *seen_);
  if (tried.why_not.empty() && request_.budget && tried.cost > *request_.budget)
    tried.why_not = "it costs more than the budget";
  if (made.possible)
    say_(fmt::format("{}: {}", name_of(tried, request_),
                     made.holds() ? fmt::format("usable, error {}", share_text(tried.error)) : tried.why_not));
  candidates_.push_back(std::move(made));
}

}  // namespace noonmark
