#include "app/advise/recommend_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/advise/engine_forms.h"
#include "app/advise/recommend_filtered.h"
#include "app/advise/recommend_filtered_text.h"
#include "app/advise/recommend_lookups.h"
#include "base/text.h"
#include "compare/report/cause_shares.h"
#include "compare/results/number_text.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

std::string million(double work) { return fmt::format("{:.3g} million", work / 1e6); }

std::string filter_text(const FilterSettings& filter) {
  if (filter.kind == "none") return "no filter";
  if (filter.kind == "castano") return fmt::format("the filter castano {0} x {0}", filter.whole("size"));
  return fmt::format("the filter {}", filter.kind);
}

// "19.5 mm", "1.2 m"
std::string length_text(double metres) {
  return metres < 1 ? fmt::format("{:.3g} mm", 1000 * metres) : fmt::format("{:.3g} m", metres);
}

std::string_view unit_of_bias(const Settings& settings) {
  switch (settings.bias.unit) {
    case BiasUnit::texel:
      return "texels";
    case BiasUnit::depth:
      return "of the depth from near to far";
    case BiasUnit::m:
      break;
  }
  return "m";
}

// extent_m: of a directional light's map, to say how wide it and its texels are; 0: that is not said.
std::string settings_text(const Tried& tried, const AdviceRequest& request, double extent_m = 0) {
  const MapPlace& place = request.places[tried.place];
  const MapSettings& map = tried.settings.map;
  std::string text = map.aspect ? fmt::format("a map of {} x {} texels", map.resolution, map.rows())
                                : fmt::format("a map of {} texels' width and as many rows as it needs", map.resolution);
  const CascadeSettings& cascades = tried.settings.cascades;
  if (cascades.count > 1) {
    text = fmt::format("{} cascades with {}", cascades.count, text);
    if (!place.laid_by.empty()) text += fmt::format(" each, laid as {} lays them", place.laid_by);
    if (!cascades.bounds_m.empty())
      text += fmt::format("{}, which end at {:.4g} m and at {:.4g} m", place.laid_by.empty() ? " each" : "",
                          fmt::join(cascades.bounds_m, ", "), tried.settings.map.reach_m.value_or(0));
  } else if (!place.covers.empty()) {
    text += fmt::format(" over {}, {:.4g} m wide", place.covers, place.extent_m);
  }
  if (extent_m > 0)
    text += fmt::format("{} ({} a texel)", place.covers.empty() ? fmt::format(", {:.4g} m wide", extent_m) : "",
                        length_text(extent_m / tried.settings.map.resolution));
  text += fmt::format(", {}", tried.filtered() ? lookup_text(tried.settings) : filter_text(tried.settings.filter));
  if (tried.settings.bias.reference != "own_depth")
    text += fmt::format(", bias.reference = {}", tried.settings.bias.reference);
  if (const double offset = tried.settings.bias["normal_offset_axes"]; offset > 0)
    text += fmt::format(", bias.normal_offset_axes = {:g} texels", offset);
  if (tried.settings.map.cull != MapSettings().cull)
    text += fmt::format(", map.cull = {}", find_setting("map.cull").get(tried.settings));
  if (tried.filtered())
    for (const char* part : {"tan", "normal_offset", "constant"})
      if (const double amount = tried.settings.bias[part]; amount > 0)
        text += fmt::format(", bias.{} = {:g} {}", part, amount, unit_of_bias(tried.settings));
  if (tried.reduction) text += fmt::format(", and lookup.reduction = {:g}", tried.reduction->value);
  if (tried.bias) text += fmt::format(", and {} = {:g} {}", tried.bias->parameter, tried.bias->value, tried.bias->unit);
  if (tried.bias && !cascades.bias_scales.empty()) {
    std::vector<std::string> scales;
    for (const double scale : cascades.bias_scales) scales.push_back(fmt::format("{:.3g}", scale));
    text += fmt::format(" times {} in the cascades", fmt::join(scales, ", "));
  }
  return text;
}

std::string causes_text(const PointRecord& point) {
  const PointRecord* only[] = {&point};
  const std::vector<CauseShare> shares = cause_shares(only);
  std::string text;
  for (size_t i = 0; i < std::min<size_t>(shares.size(), 2); ++i) {
    std::string name = shares[i].name;
    std::replace(name.begin(), name.end(), '_', ' ');
    text += fmt::format("{}{} ({:.0f}%)", i ? ", then " : "", name, 100 * shares[i].share);
  }
  return text;
}

std::string bounds_text(const CurveOptions& bounds) {
  return fmt::format("acne within {} and Peter Panning within {}", share_text(bounds.acne_bound),
                     share_text(bounds.peter_panning_bound));
}

bool asks_for_filtered(const AdviceRequest& request) {
  return std::any_of(request.levels.begin(), request.levels.end(), [](const BiasLevel& one) { return one.filtered(); });
}
bool asks_for_compared(const AdviceRequest& request) {
  return request.levels.empty() || std::any_of(request.levels.begin(), request.levels.end(),
                                               [](const BiasLevel& one) { return !one.filtered(); });
}

// With a gloss for readers who meet the words here first.
std::string glossed_bounds_text(const Advice& advice) {
  const CurveOptions& bounds = advice.request.curve;
  if (std::all_of(advice.answers.begin(), advice.answers.end(), [](const Answer& one) { return one.tried.filtered(); }))
    return glossed_filtered_bounds_text(bounds);
  return fmt::format(
      "acne (a surface shadows itself) within {} and Peter Panning (a shadow leaves its object) within {}",
      share_text(bounds.acne_bound), share_text(bounds.peter_panning_bound));
}

std::string eye_bounds_text(const AdviceRequest& request) {
  std::string text;
  for (const Bound& bound : request.eye) text += ", " + eye_bound_text(bound);
  return text.empty() ? text : text + " at the given view";
}

// Of the settings that cost less than the answer and break a bound: the dearest. Filtered maps with the same blur cost the same;
// of equal costs it is the one that exceeds its bounds least.
const Tried* next_cheaper(const Advice& advice) {
  const Tried* found = nullptr;
  for (const Tried& tried : advice.tried)
    if (tried.cost < advice.answer()->tried.cost &&
        (!found || tried.cost > found->cost || (tried.cost == found->cost && is_nearer(tried, *found, advice.request))))
      found = &tried;
  return found;
}

// Whether the scene needs a shadow map at all.
std::string needed_text(const Advice& advice) {
  if (advice.shadowed == 0)
    return "No shadow map is needed here: in no view that was searched is anything in shadow that faces the light, so "
           "the picture is right without one. If the scene moves, or if other views show shadows, the settings below "
           "make none where there are none.";
  const std::string without =
      fmt::format("Without shadows {} of the picture that faces the light would be wrong, in the worst view",
                  share_text(advice.shadowed));
  const double with = advice.answer()->tried.error;
  if (with >= advice.shadowed)
    return fmt::format("{}; this map leaves {}, so it does not pay.", without, share_text(with));
  if (advice.request.error && advice.shadowed <= *advice.request.error)
    return fmt::format("{}. That is within the error of {} that is allowed, so the scene needs no shadow map.", without,
                       share_text(*advice.request.error));
  return fmt::format("{}; this map leaves {}, so it removes {:.3g}% of that error.", without, share_text(with),
                     100 * (1 - with / advice.shadowed));
}

std::string constant_text(int least_resolution) {
  return least_resolution > 0 ? fmt::format(
                                    "One constant bias and no filter would keep both bounds from some {} texels on, "
                                    "under the first condition alone.",
                                    least_resolution)
                              : fmt::format(
                                    "One constant bias and no filter keep both bounds at no resolution up to {}, under "
                                    "the first condition.",
                                    -least_resolution);
}

// The conditions that this one differs in from the others: "view.eye_m = 1,2,3". Empty if there is one condition.
std::string condition_text(const PointRecord& point, const AdviceRequest& request) {
  std::vector<std::string> words;
  for (const Setting* row : differing_settings(request.conditions))
    words.push_back(fmt::format("{} = {}", row->name, setting_text(setting_of(point, std::string(row->name)))));
  return fmt::format("{}", fmt::join(words, ", "));
}

// What is to be kept by all that was asked for.
std::string kept_text(const AdviceRequest& request) {
  std::string text = asks_for_compared(request) ? bounds_text(request.curve) : "";
  if (asks_for_filtered(request))
    text += fmt::format("{}{}", text.empty() ? "" : ", or of a filtered map ", filtered_bounds_text(request.curve));
  return text;
}

// What would have to change, from what was tried: one sentence for each way.
std::vector<std::string> ways_out(const Advice& advice, const Tried& nearest) {
  const AdviceRequest& request = advice.request;
  std::vector<std::string> lines;
  if (nearest.fails_elsewhere) {
    lines.push_back(
        "Another engine, or none: without --for and --engine these settings hold. Or other choices of what was given, "
        "and "
        "finer texels: what a bias in texels does wrong falls with their width.");
  } else if (nearest.usable() && request.error) {
    const int times = *request.error > 0 ? static_cast<int>(std::ceil(nearest.error / *request.error)) : 0;
    if (times == 0)
      lines.push_back("A map of texels cannot have an error of 0%: allow a larger --error.");
    else
      lines.push_back(fmt::format(
          "A larger --error: {} holds with these settings. Or finer texels: errors fall as their width on average (law "
          "5), so some {} texels, or an extent {} times smaller.",
          share_text(nearest.error), times * nearest.settings.map.resolution, times));
  } else if (nearest.usable() && nearest.eye) {
    lines.push_back(fmt::format(
        "Larger bounds for the eye: --edges {:.3g} --patch {} on these settings. Or finer texels: edges come "
        "nearer to the true ones as texels do (law 5).",
        std::max(nearest.eye->edge_p95_pixels, most_edge_pixels),
        share_text(std::max(nearest.eye->wrong_patch, most_wrong_patch))));
  } else if (nearest.nearest) {
    // Of the bounds only a share is used up while searching.
    const auto enough = [](double bound, double left, double share) { return std::max(bound, left / share); };
    lines.push_back(fmt::format(
        "Larger bounds: from about --acne {} --peter-panning {} on these settings do.",
        share_text(enough(request.curve.acne_bound, nearest.nearest->acne, searched_acne)),
        share_text(enough(request.curve.peter_panning_bound, nearest.nearest->peter_panning, searched_peter_panning))));
  }
  if (nearest.filtered() && !nearest.usable() && nearest.worst)
    lines.push_back(enough_bounds_text(*nearest.worst, request.curve));
  if (advice.least_resolution)
    lines.push_back(constant_text(*advice.least_resolution));
  else if (!nearest.usable())
    lines.push_back(
        fmt::format("Finer texels: a resolution above {}, or a smaller extent.", advice.request.resolutions.back()));
  if (request.levels.empty())
    lines.push_back("Another kind of bias: the experiment gives one; without it all kinds are tried.");
  if (!nearest.usable() && !nearest.filtered())
    lines.push_back(
        "Or the mesh: parts that are closed, and that stand further apart than the bias that its slopes need.");
  return lines;
}

std::vector<std::string> nothing_works(const Advice& advice) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format(
      "Nothing that was tried keeps {}{}{} under all conditions{}.", kept_text(advice.request),
      eye_bounds_text(advice.request),
      advice.request.error ? fmt::format(" and the error within {}", share_text(*advice.request.error)) : "",
      advice.nearest && advice.nearest->fails_elsewhere ? ", here and in the engine that it is for" : ""));
  const std::optional<Tried>& nearest = advice.nearest;
  if (!nearest) return lines;
  lines.push_back(fmt::format("Nearest came {}: {}.", settings_text(*nearest, advice.request), nearest->why_not));
  if (nearest->worst && nearest->worst->worst.x >= 0 && !nearest->fails_elsewhere) {
    const std::string where = condition_text(*nearest->worst, advice.request);
    lines.push_back(fmt::format(
        "Its worst pixel is x = {}, y = {} (row 0 on top, of {} x {}{}), by {}.", nearest->worst->worst.x,
        nearest->worst->worst.y, setting_of(*nearest->worst, "view.width_px"),
        setting_of(*nearest->worst, "view.height_px"), where.empty() ? "" : "; " + where, nearest->worst->worst.cause));
  }
  lines.push_back("What would have to change:");
  for (const std::string& way : ways_out(advice, *nearest)) lines.push_back("- " + way);
  for (std::string& line : lookups_text(advice)) lines.push_back(std::move(line));
  return lines;
}

// For each level of the bias below the answer's: why it does not do.
std::vector<std::string> lesser_levels(const Advice& advice) {
  std::vector<std::string> lines;
  for (const BiasLevel& level : advice.request.levels) {
    if (level.name == advice.answer()->tried.level) break;
    int finest = 0;
    bool any_window = false;
    for (const Tried& tried : advice.tried) {
      if (tried.level != level.name) continue;
      finest = std::max(finest, tried.settings.map.resolution);
      any_window = any_window || tried.usable();
    }
    if (finest && !any_window && level.filtered())
      lines.push_back(fmt::format("With {} nothing up to {} texels keeps {} under all conditions.", level.name, finest,
                                  searched_filtered_text()));
    else if (finest && !any_window)
      lines.push_back(fmt::format("With {} nothing up to {} texels keeps {} under all conditions{}.", level.name,
                                  finest, searched_text(),
                                  finest < advice.request.resolutions.back() ? ", and finer ones could not win" : ""));
    else if (finest)
      for (const Tried& tried : advice.tried)
        if (tried.level == level.name && tried.usable()) {
          lines.push_back(fmt::format("With {} the first that keeps the bounds is {}; {}.", level.name,
                                      settings_text(tried, advice.request), tried.why_not));
          break;
        }
  }
  return lines;
}

// "-65% to +187%", and from 0 on "-100%".
std::string may_vary(const BiasChoice& bias) {
  const auto change = [&](double end) { return fmt::format("{:+.0f}%", 100 * (end / bias.value - 1)); };
  if (bias.value == 0) return fmt::format("0 to {:.3g} {}", bias.window.high, bias.unit);
  return fmt::format("{} to {}{}", change(bias.window.low), change(bias.window.high),
                     is_fragile(bias) ? ", fragile" : "");
}

std::string kinds_text(const Answer& answer) {
  std::vector<std::string> names;
  for (AnswerKind kind : answer.kinds) names.push_back(answer_name(kind));
  return fmt::format("{}", fmt::join(names, ", "));
}

// The answers as a table, one line each, under a line of heads.
std::vector<std::string> answers_table(const Advice& advice) {
  const bool any_reduction = std::any_of(advice.answers.begin(), advice.answers.end(),
                                         [](const Answer& one) { return one.tried.reduction.has_value(); });
  std::vector<std::vector<std::string>> rows = {
      {"answer", "work", "error", "edges in pixels, mean and 95%", "largest patch",
       any_reduction ? "bias or reduction may vary" : "bias may vary", "settings"}};
  for (const Answer& answer : advice.answers) {
    const Tried& tried = answer.tried;
    rows.push_back(
        {kinds_text(answer), million(tried.cost), share_text(tried.error),
         tried.eye ? fmt::format("{:.2f} and {:.3g}", tried.eye->edge_mean_pixels, tried.eye->edge_p95_pixels) : "-",
         tried.eye ? share_text(tried.eye->wrong_patch) : "-",
         tried.bias        ? may_vary(*tried.bias)
         : tried.reduction ? "reduction " + window_text(*tried.reduction)
         : tried.as_is     ? "fixed"
                           : "-",
         settings_text(tried, advice.request)});
  }
  std::vector<size_t> widths(rows.front().size());
  for (const auto& row : rows)
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::vector<std::string> lines;
  for (const auto& row : rows) {
    std::string line = " ";
    for (size_t i = 0; i + 1 < row.size(); ++i) line += fmt::format(" {:<{}} ", row[i], widths[i]);
    lines.push_back(line + " " + row.back());
  }
  return lines;
}

// Of which pictures the numbers of the table are. Others measure others: that is why their numbers differ.
std::string pictures_text(const Advice& advice, const Answer& answer) {
  const Settings& settings = answer.tried.settings;
  std::string other;
  for (const Answer& one : advice.answers)
    if (one.placements != answer.placements)
      other = fmt::format(" ({} for {})", one.placements,
                          one.tried.filtered() ? "filtered maps" : "maps that are compared with");
  const bool filtered =
      std::any_of(advice.answers.begin(), advice.answers.end(), [](const Answer& one) { return one.tried.filtered(); });
  std::string text = fmt::format(
      "Work is that of a picture of {} x {} pixels{}. Error is the largest under {}, with the map's grid where the "
      "settings put it{}; {} are held at {} placements of the grid{}. Both are measured "
      "in pictures {} pixels wide; recommended.toml measures full pictures, so its report has other numbers.",
      settings.view.width_px, settings.view.height_px,
      advice.request.held_in.empty() ? ""
                                     : fmt::format(", with the maps that {} {} if those have more texels",
                                                   fmt::join(advice.request.held_in, " and "),
                                                   advice.request.held_in.size() > 1 ? "draw" : "draws"),
      counted(answer.conditions, "condition"),
      filtered ? " (of filtered maps, where the light has no size, at their worst placement on the exact map)" : "",
      answer.tried.filtered() ? "leak, over-darkening and their like" : "acne, Peter Panning and their like",
      answer.placements, other, std::min(advice.request.width_px, settings.view.width_px));
  if (answer.tried.eye)
    text +=
        " Edges and patch are measured at the given view, in full size: a camera that comes closer shows the texels.";
  return text;
}

// What it is asked for.
std::vector<std::string> about_lines(const AdviceRequest& request) {
  std::vector<std::string> lines = request.about;
  if (!request.given.empty())
    lines.push_back(
        fmt::format("The answer is for what was given: {}. For the scene alone it can be another one.", request.given));
  return lines;
}

// What each answer buys beside the one before it, and what more texels would buy.
std::string steps_text(const Advice& advice) {
  std::string text;
  for (size_t i = 1; i < advice.answers.size(); ++i) {
    const Answer &from = advice.answers[i - 1], &to = advice.answers[i];
    text += fmt::format("From {} to {}: {:.2g} times the work, for an error of {} in place of {}. ",
                        answer_name(from.kinds.back()), answer_name(to.kinds.front()), to.tried.cost / from.tried.cost,
                        share_text(to.tried.error), share_text(from.tried.error));
  }
  const Answer& last = advice.answers.back();
  if (last.tried.error > 0)
    text += fmt::format(
        "Twice the texels of {} on a side would be {:.2g} times its work, and halve what texels do to "
        "its error, on average (law 5). ",
        answer_name(last.kinds.back()), last.doubled_cost / last.tried.cost);
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace

std::vector<std::string> lookups_text(const Advice& advice) {
  std::vector<std::string> lines;
  for (const LookupFate& fate : lookup_fates(advice))
    lines.push_back(fmt::format("  {}: {}.", fate.lookup,
                                !fate.best ? fmt::format("not measured, because {}", fate.why)
                                : fate.outcome == LookupFate::Outcome::answer
                                    ? fate.why
                                    : fmt::format("its best is {} ({}); {}", settings_text(*fate.best, advice.request),
                                                  million(fate.best->cost), fate.why)));
  if (!lines.empty())
    lines.insert(lines.begin(),
                 fmt::format("What became of each lookup (a search allows {}):", searched_filtered_text()));
  return lines;
}

namespace {

// How wide the window of the answer's bias is.
std::string bias_line(const Answer& answer, const AdviceRequest& request) {
  const BiasChoice& bias = *answer.tried.bias;
  return fmt::format(
      "{} keeps {} from {:.3g} to {:.3g} {} under {} and at all {} placements of the map's grid that were searched{}. "
      "That is {}, because conditions that were not searched may be a little worse, and other rasterisers add acne.",
      bias.parameter, bounds_text(searched_bounds(request.curve)), bias.window.low, bias.window.high, bias.unit,
      counted(answer.conditions, "condition"), answer.placements,
      bias.narrow ? "; that is narrow, so a small change of the scene can break it" : "; " + margin_text(bias),
      searched_text());
}

std::string verified_line(const Answer& answer, int width_px) {
  return fmt::format(
      "Verified under the worst condition at {} other placements{}, {} pixels wide: the worst of them has "
      "{} and {} error.",
      answer.verified.placements,
      answer.verified.rendered == answer.verified.placements
          ? ", rendered by OpenGL"
          : fmt::format(", {} of them rendered by OpenGL", answer.verified.rendered),
      std::min(width_px, answer.tried.settings.view.width_px),
      answer.tried.filtered() ? shares_text(answer.verified.filtered)
                              : fmt::format("{} acne, {} Peter Panning", share_text(answer.verified.worst_acne),
                                            share_text(answer.verified.worst_peter_panning)),
      share_text(answer.verified.worst_error));
}

// What must be known of the answer before it is used.
std::vector<std::string> cautions(const Advice& advice) {
  const Tried& tried = advice.answer()->tried;
  const MapPlace& place = advice.request.places[tried.place];
  std::vector<std::string> lines;
  if (tried.error >= advice.shadowed || (advice.request.error && advice.shadowed <= *advice.request.error))
    lines.push_back(needed_text(advice));
  if (tried.bias && is_fragile(*tried.bias))
    lines.push_back(
        fmt::format("It is fragile: a bias that is {:.0f}% less or more breaks a bound, and nothing wider was found "
                    "that costs little more.",
                    100 * fragile_below));
  if (tried.bias && tried.bias->window.low <= 0)
    lines.push_back(
        "Even without a bias the acne in these views is within its bound, so they do not say how small the bias may be "
        "where more is lit.");
  if (place.of_casters)
    lines.push_back(
        "The map holds what casts shadows, and not the ground around it. Outside of the map everything is lit: an "
        "object that leaves it casts no shadow (--set map.fit=tight: a map of everything).");
  if (place.moves_with)
    lines.push_back(fmt::format(
        "The map lies over {}: a camera that leaves them needs another place, or the map of the whole scene "
        "(--set map.fit=tight).",
        place.covers));
  return lines;
}

void append(std::vector<std::string>& lines, std::vector<std::string> more) {
  std::move(more.begin(), more.end(), std::back_inserter(lines));
}

}  // namespace

std::vector<std::string> answer_text(const Advice& advice) {
  if (!advice.answer()) {
    std::vector<std::string> lines = about_lines(advice.request);
    append(lines, nothing_works(advice));
    return lines;
  }
  const Answer& answer = *advice.answer();
  const Tried& tried = answer.tried;
  std::vector<std::string> lines = {fmt::format("Set {}.", settings_text(tried, advice.request, answer.extent_m))};
  lines.push_back(fmt::format(
      "That is the answer \"{}\"{}. All answers keep {}{}{}{}{}:", kinds_text(answer),
      advice.passed_over ? fmt::format(", because \"{}\" is fragile", answer_name(*advice.passed_over)) : "",
      glossed_bounds_text(advice), eye_bounds_text(advice.request),
      advice.request.error ? fmt::format(", {} within {}", advice.request.accuracy, share_text(*advice.request.error))
                           : "",
      advice.request.source_of_bounds.empty() ? "" : fmt::format(" (bounds: {})", advice.request.source_of_bounds),
      advice.request.held_in.empty()
          ? ""
          : fmt::format("; those on acne, Peter Panning and the error with the lines of {} too",
                        fmt::join(advice.request.held_in, " and "))));
  append(lines, answers_table(advice));
  const auto is_filtered = [](const Answer& one) { return one.tried.filtered(); };
  if (std::any_of(advice.answers.begin(), advice.answers.end(), is_filtered) &&
      !std::all_of(advice.answers.begin(), advice.answers.end(), is_filtered))
    lines.push_back(filtered_beside_compared(advice.request.curve));
  lines.push_back(fmt::format(
      "Errors are the largest under {}. The report measures larger pictures, so its numbers differ a little.",
      counted(answer.conditions, "condition")));
  append(lines, cautions(advice));
  append(lines, about_lines(advice.request));
  append(lines, lookups_text(advice));
  return lines;
}

std::vector<std::string> reasons_text(const Advice& advice) {
  if (!advice.answer()) return {};
  const Answer& answer = *advice.answer();
  const Tried& tried = answer.tried;
  std::vector<std::string> lines = {pictures_text(advice, answer), steps_text(advice)};
  if (tried.bias) lines.push_back(bias_line(answer, advice.request));
  lines.push_back(kept_filtered_text(answer, advice.request.curve));
  lines.push_back(verified_line(answer, advice.request.width_px));
  lines.push_back(promise_of_both(answer));
  if (tried.worst) {
    const std::string causes = causes_text(*tried.worst);
    lines.push_back(fmt::format("The error that is left ({}) is {}{}.", advice.request.accuracy,
                                share_text(tried.error), causes.empty() ? "" : ", most of it " + causes));
  }
  if (advice.shadowed > 0) lines.push_back(needed_text(advice));
  lines.push_back(fmt::format("Its work is {} texels written and texture instructions a frame.", million(tried.cost)));
  if (const Tried* cheaper = next_cheaper(advice))
    lines.push_back(fmt::format("The next cheaper is {} ({}): {}.{}", settings_text(*cheaper, advice.request),
                                million(cheaper->cost), cheaper->why_not, allowed_text(*cheaper)));
  else
    lines.push_back(fmt::format("Nothing cheaper was tried: the smallest map among the choices has {} texels a side.",
                                advice.request.resolutions.front()));
  std::erase(lines, "");
  return lines;
}

std::vector<std::string> rejected_text(const Advice& advice) {
  if (!advice.answer()) return {};
  std::vector<std::string> lines;
  if (advice.least_resolution)
    lines.push_back(constant_text(*advice.least_resolution) +
                    (advice.answer()->tried.filtered()
                         ? ""
                         : fmt::format(" The bias of this answer keeps them at {} texels, under all conditions.",
                                       advice.answer()->tried.settings.map.resolution)));
  for (std::string& line : lesser_levels(advice)) lines.push_back(std::move(line));
  return lines;
}

std::vector<std::string> engine_lines(const EngineAdvice& engine) {
  std::vector<std::string> lines = engine.lines;
  if (lines.empty()) {
    lines.push_back(fmt::format("{} {}", engine.comment, engine.cannot.front()));
    return lines;
  }
  if (!engine.broken.empty()) lines.insert(lines.begin(), fmt::format("{} {}", engine.comment, engine.broken));
  if (!engine.promised.empty()) lines.push_back(fmt::format("{} {}", engine.comment, engine.promised));
  return lines;
}

std::string advice_engines(const std::vector<EngineAdvice>& engines) {
  std::string text = "These settings in other engines, and what each cannot express. Made by Noonmark.\n";
  for (const EngineAdvice& engine : engines) {
    text += fmt::format("\n{} ({})\n", engine.engine, engine.version);
    const std::vector<std::string> lines = engine_lines(engine);
    for (const std::string& line : lines) text += fmt::format("    {}\n", line);
    // A sentence that stands in place of the lines is not said twice.
    for (const std::string& sentence : engine.cannot)
      if (std::none_of(lines.begin(), lines.end(), [&](const std::string& line) { return line.ends_with(sentence); }))
        text += fmt::format("  - {}\n", sentence);
    text += fmt::format("  Source: {}\n", engine.source);
  }
  return text;
}

}  // namespace noonmark
