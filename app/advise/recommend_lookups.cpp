#include "app/advise/recommend_lookups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "app/advise/recommend_filtered.h"

namespace noonmark {
namespace {

std::vector<std::string> asked_lookups(const AdviceRequest& request) {
  std::vector<std::string> names;
  for (const BiasLevel& level : request.levels)
    if (std::find(names.begin(), names.end(), level.lookup) == names.end()) names.push_back(level.lookup);
  return names;
}

std::string million_of(double work) { return fmt::format("{:.3g} million", work / 1e6); }

std::string kinds_of(const Answer& answer) {
  std::vector<std::string> names;
  for (const AnswerKind kind : answer.kinds) names.push_back(answer_name(kind));
  return fmt::format("{}", fmt::join(names, ", "));
}

// Of what holds: by the error, or for the answer `least` by the cost. Of what breaks a bound: by how far.
std::pair<double, double> order_of(const Tried& tried, const AdviceRequest& request) {
  if (tried.held || tried.usable()) {
    if (request.answer == AnswerKind::least) return {tried.cost, tried.screened_error};
    return {tried.screened_error, tried.cost};
  }
  const CurveOptions searched = searched_bounds(request.curve);
  if (tried.nearest) return {excess(*tried.nearest, searched), tried.cost};
  if (tried.filtered() && tried.worst) return {excess(filtered_shares(*tried.worst), searched), tried.cost};
  return {std::numeric_limits<double>::infinity(), tried.cost};
}

// What holds comes first, then what fails for the eye, an error or a budget, then what breaks a bound on causes.
int rank_of(const Tried& tried) { return tried.held ? 0 : tried.usable() ? 1 : 2; }

const Tried* best_of(const Advice& advice, const std::string& lookup) {
  const Tried* best = nullptr;
  for (const Tried& tried : advice.tried)
    if (tried.settings.lookup.kind == lookup && (!best || is_nearer(tried, *best, advice.request))) best = &tried;
  return best;
}

std::string why_not_measured(const Advice& advice, const std::string& lookup) {
  if (std::any_of(advice.answers.begin(), advice.answers.end(),
                  [](const Answer& one) { return one.tried.screened_error == 0; }))
    return "something simpler that asks for no more makes no error";
  const auto least = advice.least_costs.find(lookup);
  const std::string cost =
      least == advice.least_costs.end() ? "" : fmt::format("its cheapest map costs {}, ", million_of(least->second));
  return advice.request.budget ? fmt::format("{}more than the budget of {}", cost, million_of(*advice.request.budget))
                               : fmt::format("{}more than {}, {} times the cheapest answer", cost,
                                             million_of(advice.budget), budget_of_least);
}

}  // namespace

bool is_nearer(const Tried& tried, const Tried& than, const AdviceRequest& request) {
  return std::pair(rank_of(tried), order_of(tried, request)) < std::pair(rank_of(than), order_of(than, request));
}

std::string outcome_name(LookupFate::Outcome outcome) {
  switch (outcome) {
    case LookupFate::Outcome::answer:
      return "answer";
    case LookupFate::Outcome::lost:
      return "lost";
    case LookupFate::Outcome::broke:
      return "broke a bound";
    case LookupFate::Outcome::not_measured:
      break;
  }
  return "not measured";
}

std::vector<LookupFate> lookup_fates(const Advice& advice) {
  std::vector<LookupFate> fates;
  const std::vector<std::string> names = asked_lookups(advice.request);
  if (names.size() < 2) return fates;
  for (const std::string& lookup : names) {
    LookupFate fate;
    fate.lookup = lookup;
    std::vector<std::string> kinds;
    for (const Answer& answer : advice.answers)
      if (answer.tried.settings.lookup.kind == lookup) {
        if (!fate.best || &answer == advice.answer()) fate.best = &answer.tried;
        kinds.push_back(kinds_of(answer));
      }
    if (!kinds.empty()) {
      fate.outcome = LookupFate::Outcome::answer;
      fate.why = fmt::format("it is the answer \"{}\"", fmt::join(kinds, ", "));
    } else if ((fate.best = best_of(advice, lookup))) {
      fate.outcome = fate.best->held ? LookupFate::Outcome::lost : LookupFate::Outcome::broke;
      fate.why = fate.best->why_not;
    } else {
      fate.why = why_not_measured(advice, lookup);
    }
    fates.push_back(std::move(fate));
  }
  return fates;
}

double excess(const FilteredShares& shares, const CurveOptions& bounds) {
  const auto multiple = [](double found, double bound) {
    if (bound > 0) return found / bound;
    return found > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  };
  return std::max({multiple(shares.leak, bounds.peter_panning_bound),
                   multiple(shares.peter_panning, bounds.peter_panning_bound),
                   multiple(shares.over_darkening, bounds.acne_bound), multiple(shares.reduction, bounds.acne_bound)});
}

}  // namespace noonmark
