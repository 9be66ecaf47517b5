#include "app/advise/recommend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "app/advise/recommend_filtered.h"
#include "app/advise/recommend_judge.h"
#include "app/advise/recommend_lookups.h"
#include "app/advise/recommend_screening.h"
#include "app/advise/recommend_verify.h"
#include "base/error.h"
#include "base/text.h"
#include "compare/judge/curve_reading.h"
#include "compare/results/number_text.h"
#include "compare/results/point_settings.h"
#include "compare/results/quantities.h"
#include "technique/light_frame.h"
#include "technique/lookups.h"

namespace noonmark {

std::string answer_name(AnswerKind kind) {
  switch (kind) {
    case AnswerKind::least:
      return "least";
    case AnswerKind::balanced:
      return "balanced";
    case AnswerKind::best:
      break;
  }
  return "best";
}

bool Tried::filtered() const { return !compares(settings); }

int placements_along(const Tried& tried) { return tried.filtered() ? filtered_placements : searched_placements; }

bool is_fragile(const BiasChoice& bias) {
  return bias.window.low > (1 - fragile_below) * bias.value || bias.window.high < (1 + fragile_below) * bias.value;
}

AnswerKind printed_answer(AnswerKind usual, const std::function<bool(AnswerKind)>& is_fragile) {
  const int at = static_cast<int>(usual), kinds = static_cast<int>(std::size(answer_kinds));
  for (int step = 0; step < kinds; ++step)
    for (const int kind : {at + step, at - step})
      if (kind >= 0 && kind < kinds && !is_fragile(answer_kinds[kind])) return answer_kinds[kind];
  return usual;
}

const Answer* Advice::of(AnswerKind kind) const {
  for (const Answer& answer : answers)
    if (std::find(answer.kinds.begin(), answer.kinds.end(), kind) != answer.kinds.end()) return &answer;
  return nullptr;
}

namespace {

bool is_fragile(const Candidate& of) { return of.tried.bias && noonmark::is_fragile(*of.tried.bias); }

// A wider answer is preferred to a fragile one up to this factor of its cost.
constexpr double factor_for_width = 1.3;

class Search {
 public:
  Search(Workbench& bench, const AdviceRequest& request, const std::function<void(const std::string&)>& say)
      : bench_(bench),
        request_(request),
        say_(say),
        searched_(searched_bounds(request.curve)),
        screening_(bench, request, searched_, say) {}

  Advice run() {
    Advice advice;
    advice.request = request_;
    const std::optional<Chosen> chosen = settle();
    if (chosen) {
      take(*chosen, advice);
      advice.request.answer = printed(*chosen);
      if (advice.answer() != advice.of(request_.answer)) advice.passed_over = request_.answer;
    } else {
      take_narrow(advice);
    }
    take_the_others(advice);
    if (const Answer* answer = advice.answer(); !request_.levels.empty() && !request_.levels.front().filtered() &&
                                                (!answer || answer->tried.level != request_.levels.front().name))
      advice.least_resolution = least_resolution();
    if (!advice.answer() && nothing_is_lit()) refuse_dark_views();
    if (!advice.answer()) advice.nearest = look_at_nearest(advice.tried);
    advice.shadowed = screening_.shadowed();
    advice.least_costs = screening_.least_costs();
    return advice;
  }

 private:
  struct Chosen {
    std::array<size_t, std::size(answer_kinds)> at;  // in candidates(), as answer_kinds
    double budget = 0;
  };

  std::vector<Candidate>& candidates() { return screening_.candidates(); }

  // The three answers, each confirmed and verified. Empty if nothing holds.
  std::optional<Chosen> settle() {
    for (;;) {
      screening_.run();
      const std::optional<Chosen> chosen = choose();
      if (!chosen) return std::nullopt;
      if (try_between(chosen->at.front())) continue;
      const auto open =
          std::find_if(chosen->at.begin(), chosen->at.end(), [&](size_t i) { return !candidates()[i].confirmed; });
      if (open != chosen->at.end()) {
        confirm(candidates()[*open]);
        continue;
      }
      const size_t asked = chosen->at[static_cast<size_t>(printed(*chosen))];
      bool verified_all = true;
      for (const size_t i : chosen->at) {
        Candidate& one = candidates()[i];
        if (one.verified && (one.verified->rendered > 0 || i != asked)) continue;
        verified_all = false;
        verify(one, i == asked);
        break;
      }
      if (verified_all) return chosen;
    }
  }

  AnswerKind printed(const Chosen& chosen) {
    return request_.answer_given ? request_.answer : printed_answer(request_.answer, [&](AnswerKind kind) {
      return is_fragile(candidates()[chosen.at[static_cast<size_t>(kind)]]);
    });
  }

  // The three answers among what holds, as far as is known.
  std::optional<Chosen> choose() {
    std::vector<size_t> place;
    std::vector<CostAndError> of;
    for (size_t i = 0; i < candidates().size(); ++i) {
      const Candidate& one = candidates()[i];
      if (!one.holds() || simpler(one)) continue;
      place.push_back(i);
      of.push_back({one.tried.cost, one.tried.screened_error});
    }
    const std::optional<ThreeAnswers> found = three_answers(of, request_.budget);
    if (!found) return std::nullopt;
    return Chosen{{place[found->least], place[found->balanced], place[found->best]}, found->budget};
  }

  // Something that holds and is simpler: a kind of bias with less parts, a map that holds for every view, fewer maps, or a bias
  // that may vary more; and that costs and errs hardly more. Null if there is nothing.
  const Candidate* simpler(const Candidate& than) {
    const auto found = std::find_if(candidates().begin(), candidates().end(),
                                    [&](const Candidate& one) { return is_simpler(one, than); });
    return found == candidates().end() ? nullptr : &*found;
  }

  bool is_simpler(const Candidate& one, const Candidate& than) const {
    const auto moves = [&](const Candidate& of) { return request_.places[of.tried.place].moves_with; };
    const auto maps = [](const Candidate& of) { return of.tried.settings.maps(); };
    if (!one.holds() || one.level > than.level || moves(one) > moves(than) || maps(one) > maps(than) ||
        is_fragile(one) > is_fragile(than))
      return false;
    const bool wider = is_fragile(one) < is_fragile(than);
    if (one.level == than.level && moves(one) == moves(than) && maps(one) == maps(than) && !wider) return false;
    const double factor = wider ? factor_for_width : factor_that_pays;
    return one.tried.cost <= factor * than.tried.cost && one.tried.screened_error <= factor * than.tried.screened_error;
  }

  // A resolution between the least that holds and its half, which does not. False if there is nothing to try.
  bool try_between(size_t least) {
    const Candidate& one = candidates()[least];
    const std::vector<int>& all = request_.resolutions;
    const int resolution = one.tried.settings.map.resolution;
    // Several maps of an engine keep to powers of two, which most of them need.
    if (!request_.places[one.tried.place].laid_by.empty()) return false;
    if (!request_.between || resolution == all.front() || std::find(all.begin(), all.end(), resolution) == all.end())
      return false;
    return screening_.try_at(one, 2 * static_cast<int>(std::lround(resolution / std::numbers::sqrt2 / 2)));
  }

  // Whether the bounds for the eye hold in full size at the given view.
  void look(Candidate& candidate) {
    Tried& tried = candidate.tried;
    if (request_.eye.empty() || tried.eye) return;
    // Edges move by the texel and by what the filter blurs, whatever the bias.
    for (const Candidate& other : candidates())
      if (other.tried.eye && !other.holds() && other.tried.place == tried.place &&
          other.tried.settings.filter == tried.settings.filter &&
          other.tried.settings.lookup == tried.settings.lookup &&
          other.tried.settings.map.resolution >= tried.settings.map.resolution &&
          other.tried.eye->edge_p95_pixels > most_edges(request_)) {
        tried.why_not = fmt::format("its shadow edges are no nearer to the true ones than those of {}",
                                    name_of(other.tried, request_));
        return;
      }
    say_(fmt::format("looking at {} in full size", name_of(tried, request_)));
    const PointRecord shown = bench_.measure(tried.settings, std::nullopt, MetricSet::shaded, Checks::none).record;
    tried.eye = eye_errors(shown);
    tried.why_not = why_not_for_eye(shown, request_.eye);
  }

  // All conditions at many placements.
  void confirm(Candidate& candidate) {
    candidate.confirmed = true;
    Tried& tried = candidate.tried;
    look(candidate);
    if (!candidate.holds()) {
      say_(fmt::format("{}: {}", name_of(tried, request_), tried.why_not));
      return;
    }
    say_(fmt::format("confirming {}, under {} at {} placements", name_of(tried, request_),
                     counted(request_.conditions.size(), "condition"),
                     placements_along(tried) * placements_along(tried)));
    // The condition that refuted the one before comes first, because it probably refutes this one too.
    std::map<size_t, PointRecord> of_condition;
    for (size_t i = 0; i < request_.conditions.size(); ++i) {
      const size_t which = i == 0 ? hardest_ : i <= hardest_ ? i - 1 : i;
      Settings there = small_picture(screening_.of_choice(request_.conditions[which], candidate.level, tried.place,
                                                          tried.settings.filter, tried.settings.map.resolution),
                                     request_.width_px);
      there.map.placements = placements_along(tried);
      PointRecord record = bench_.measure(there, searched_, metric_set_for(request_.accuracy), Checks::none).record;
      if (nothing_judged(record)) {
        say_("a view in which nothing can be judged is left out");
        continue;
      }
      screening_.see(record);
      tried.why_not = why_not_covered(record, tried);
      const bool fails = !candidate.holds() || (record.curve && !usable_window(*record.curve)) ||
                         (tried.filtered() && !why_no_reduction(record, searched_).empty());
      of_condition.emplace(which, std::move(record));
      if (!fails) continue;
      hardest_ = which;
      break;  // that is enough to know
    }
    if (!candidate.holds()) return;
    if (screening_.lit() == 0) refuse_dark_views();
    std::vector<PointRecord> points;
    for (auto& [which, record] : of_condition) points.push_back(std::move(record));
    candidate.conditions = points.size();
    if (tried.filtered())
      judge_filtered(bench_, tried, points, searched_, request_.accuracy);
    else
      judge_bias(bench_, tried, std::move(points), searched_, request_.accuracy);
    if (!candidate.holds()) return;
    if (tried.filtered()) tried.screened_error = screening_.error_of(tried);  // its reduction can be another one now
    tried.why_not = why_too_wrong(tried, request_);
    if (!candidate.holds()) return;
    ask_elsewhere(tried);
    candidate.narrow = candidate.holds() && tried.bias && tried.bias->narrow;
    if (candidate.narrow)
      tried.why_not =
          fmt::format("its window, {:.3g} to {:.3g} {}, is too narrow for a margin of {:.0f}% on both sides",
                      tried.bias->window.low, tried.bias->window.high, tried.bias->unit, 100 * (bias_margin - 1));
    if (!candidate.holds()) say_(fmt::format("{}: {}", name_of(tried, request_), tried.why_not));
  }

  // Under no condition. Where some bound fails first, as by a leak along a hull's outline, not all of them were measured.
  bool nothing_is_lit() {
    for (const Settings& condition : request_.conditions) {
      if (screening_.lit() > 0) return false;
      const PointRecord record =
          bench_.measure(small_picture(condition, request_.width_px), std::nullopt, MetricSet::searched, Checks::none)
              .record;
      if (!nothing_judged(record)) screening_.see(record);
    }
    return screening_.lit() == 0;
  }

  // Where all is in shadow the least bias holds every bound, whatever the map, and that says nothing of any lit surface.
  [[noreturn]] void refuse_dark_views() {
    const std::optional<Workbench::Hider> hider =
        bench_.hider(small_picture(request_.conditions.front(), request_.width_px));
    throw Error(
        ErrorKind::usage,
        fmt::format("in no view is anything lit that faces the light{}, so no bias can be too small here, and an "
                    "answer would say nothing of what is lit elsewhere; leave that mesh out of the scene if it "
                    "casts no shadow, or move the light or the camera (light.position_m, view.eye_m)",
                    hider ? fmt::format(": the light meets the mesh '{}' first on its way to {} of it",
                                        printable(hider->part), share_text(hider->share))
                          : ""));
  }

  void ask_elsewhere(Tried& tried) {
    if (!request_.elsewhere) return;
    Elsewhere found = request_.elsewhere(tried);
    tried.why_not = std::move(found.why_not);
    tried.fails_elsewhere = !tried.why_not.empty();
    // An engine that fits its map to the camera may need more texels.
    for (const Settings& settings : found.does) tried.cost = std::max(tried.cost, screening_.cost(settings));
    if (tried.why_not.empty() && request_.budget && tried.cost > *request_.budget)
      tried.why_not = "it costs more than the budget";
  }

  // A map over what some views show must not leave out what another one shows.
  std::string why_not_covered(const PointRecord& record, const Tried& tried) const {
    const double coverage = metric_of(record, "coverage");
    if (!request_.places[tried.place].moves_with || coverage <= searched_.acne_bound) return "";
    return fmt::format("its map leaves out {} of what a view shows", share_text(coverage));
  }

  void verify(Candidate& candidate, bool by_rendering) {
    Tried& tried = candidate.tried;
    say_(fmt::format("verifying {} at {} other placements", name_of(tried, request_),
                     placements_along(tried) * placements_along(tried)));
    const Settings settings = settings_of(*tried.worst);
    candidate.verified = verify_at_fresh_placements(bench_, settings, request_.curve, request_.accuracy, request_.error,
                                                    by_rendering ? rendered_placements : 0, [&](int done, int of) {
                                                      if (done % 8 == 0 && done < of)
                                                        say_(fmt::format("rendered at {} of {}", done, of));
                                                    });
    const std::optional<PointRecord>& broken = candidate.verified->broken;
    if (!broken) return;
    if (tried.filtered()) {
      const std::string cause = why_not_filtered(filtered_shares(*broken), request_.curve);
      tried.why_not = fmt::format(
          "at another placement of the grid {}",
          cause.empty() ? fmt::format("its error is {}", share_text(worst_placed(*broken, request_.accuracy))) : cause);
      tried.worst = broken;
      return;
    }
    tried.why_not =
        fmt::format("at another placement of the grid it has {} acne, {} Peter Panning and {} error",
                    share_text(worst_placed(*broken, "acne")), share_text(worst_placed(*broken, "peter_panning")),
                    share_text(worst_placed(*broken, request_.accuracy)));
    tried.worst = broken;
  }

  void take(const Chosen& chosen, Advice& advice) {
    advice.budget = chosen.budget;
    for (size_t k = 0; k < chosen.at.size(); ++k) {
      const auto same = std::find(chosen.at.begin(), chosen.at.begin() + static_cast<std::ptrdiff_t>(k), chosen.at[k]);
      if (same != chosen.at.begin() + static_cast<std::ptrdiff_t>(k)) {
        for (Answer& answer : advice.answers)
          if (answer.kinds.front() == answer_kinds[static_cast<size_t>(same - chosen.at.begin())])
            answer.kinds.push_back(answer_kinds[k]);
        continue;
      }
      advice.answers.push_back(answer_of(candidates()[chosen.at[k]], {answer_kinds[k]}));
    }
  }

  Answer answer_of(const Candidate& one, std::vector<AnswerKind> kinds) {
    Answer answer;
    answer.kinds = std::move(kinds);
    answer.tried = one.tried;
    const int resolution = one.tried.settings.map.resolution;
    const double here = screening_.cost_at(one, resolution);
    answer.doubled_cost = screening_.cost_at(one, 2 * resolution) * one.tried.cost / here;
    answer.conditions = one.conditions;
    answer.placements = placements_along(one.tried) * placements_along(one.tried);
    if (const LightFrame frame = make_light_frame(bench_.scene(one.tried.settings.scene), one.tried.settings);
        frame.kind == LightKind::directional && one.tried.settings.maps() == 1)
      answer.extent_m = frame.extent_m;
    answer.verified = *one.verified;
    return answer;
  }

  // If nothing holds with the margin: the cheapest that holds without it.
  void take_narrow(Advice& advice) {
    std::multimap<double, Candidate*> narrow;
    for (Candidate& one : candidates())
      if (one.narrow) narrow.emplace(one.tried.cost, &one);
    for (const auto& [order, one] : narrow) {
      one->tried.why_not.clear();
      verify(*one, true);
      if (!one->holds()) continue;
      advice.budget = request_.budget.value_or(budget_of_least * one->tried.cost);
      advice.answers.push_back(answer_of(*one, {answer_kinds, answer_kinds + std::size(answer_kinds)}));
      return;
    }
  }

  static bool is_answer(const Tried& tried, const Advice& advice) {
    return std::any_of(advice.answers.begin(), advice.answers.end(), [&](const Answer& answer) {
      return settings_map(answer.tried.settings) == settings_map(tried.settings);
    });
  }

  // By what a candidate that holds lost: an answer that is simpler; something else that is, and by what that one lost; or the
  // numbers of the answer. It ends, because what is simpler has less of something and more of nothing.
  std::string why_lost(const Candidate& lost, const Advice& advice) {
    const auto said = [&](const Candidate& better) {
      return fmt::format("{} costs and errs hardly more, and is simpler or less fragile",
                         name_of(better.tried, request_));
    };
    for (const Candidate& one : candidates())
      if (is_simpler(one, lost) && is_answer(one.tried, advice)) return said(one);
    if (const Candidate* const better = simpler(lost))
      return fmt::format("{}; that is no answer, because {}", said(*better), why_lost(*better, advice));
    return why_worse(lost.tried, advice.answer()->tried);
  }

  void take_the_others(Advice& advice) {
    for (const Candidate& one : candidates()) {
      if (is_answer(one.tried, advice) || !one.possible) continue;
      Tried tried = one.tried;
      if (one.holds()) {
        tried.held = true;
        tried.why_not = why_lost(one, advice);
      }
      advice.tried.push_back(std::move(tried));
    }
    std::stable_sort(advice.tried.begin(), advice.tried.end(),
                     [](const Tried& a, const Tried& b) { return a.cost < b.cost; });
  }

  static std::string why_worse(const Tried& tried, const Tried& answer) {
    const double work = tried.cost / answer.cost;
    const auto errors = fmt::format("an error of {} in place of {}, under the first condition",
                                    share_text(tried.screened_error), share_text(answer.screened_error));
    if (work == 1) return fmt::format("it has the same work and {}", errors);
    if (work < 1) return fmt::format("it has {:.2g} times less work, but {}", 1 / work, errors);
    return tried.screened_error < answer.screened_error
               ? fmt::format("it has {}, but {:.2g} times the work", errors, work)
               : "it is dearer and no more accurate";
  }

  // Of those with a window the one of least error, otherwise the one that leaves least, of several the cheapest.
  std::optional<Tried> look_at_nearest(const std::vector<Tried>& all) {
    const auto distance = [&](const Tried& tried) {
      if (tried.usable()) return std::pair(0, tried.error);
      if (tried.nearest) return std::pair(1, excess(*tried.nearest, searched_));
      if (tried.filtered() && tried.worst) return std::pair(1, excess(filtered_shares(*tried.worst), searched_));
      return std::pair(2, 0.0);
    };
    const auto found = std::min_element(all.begin(), all.end(),
                                        [&](const Tried& a, const Tried& b) { return distance(a) < distance(b); });
    if (found == all.end()) return std::nullopt;
    Tried tried = *found;
    if (!tried.nearest) return tried;
    Settings there = settings_of(*tried.worst);
    there.map.placements = 1;
    find_setting(tried.worst->curve->parameter).set(there, fmt::format("{}", tried.nearest->bias));
    const Measurement m = bench_.measure(there, std::nullopt, MetricSet::searched, Checks::none);
    tried.worst = m.record;
    tried.worst->worst = worst_of_bias(m);
    return tried;
  }

  std::optional<int> least_resolution() {
    say_("which resolution would be enough for one constant bias");
    return constant_bias_resolution(
        bench_,
        small_picture(screening_.of_choice(request_.conditions.front(), 0, 0, {"none", {}}, 1024), request_.width_px),
        request_.curve);
  }

  Workbench& bench_;
  const AdviceRequest& request_;
  const std::function<void(const std::string&)>& say_;
  CurveOptions searched_;  // the bounds while searching
  Screening screening_;
  size_t hardest_ = 0;  // the condition that refuted the last candidate
};

}  // namespace

std::vector<Settings> under_conditions(const Tried& tried, const AdviceRequest& request) {
  const Settings& chosen = tried.settings;
  std::vector<Settings> all;
  for (const Settings& condition : request.conditions) {
    Settings there = small_picture(condition, request.width_px);
    request.places[tried.place].apply(there);
    there.bias = chosen.bias, there.filter = chosen.filter, there.lookup = chosen.lookup;
    there.map.resolution = chosen.map.resolution, there.map.cull = chosen.map.cull;
    there.map.placements = placements_along(tried);
    all.push_back(std::move(there));
  }
  return all;
}

Advice search(Workbench& bench, const AdviceRequest& request, const std::function<void(const std::string&)>& say) {
  return Search(bench, request, say).run();
}

}  // namespace noonmark
