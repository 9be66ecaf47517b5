#include "compare/judge/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "compare/judge/baseline.h"
#include "compare/judge/bounds.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/deliveries.h"
#include "compare/judge/poor_view.h"
#include "compare/judge/soundness.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

bool is_broken(const BoundResult& bound) { return breaks(bound); }
bool is_broken(const LawResult& law) { return !law.held; }

// "1 of 2 bounds"; empty if none is.
std::string broken_words(const auto& list, std::string_view noun) {
  const auto broken = std::count_if(list.begin(), list.end(), [](const auto& one) { return is_broken(one); });
  return broken == 0 ? "" : fmt::format("{} of {}", broken, counted(list.size(), noun));
}

// "all 3 bounds", "2 of 3 bounds" where the others warn or are broken.
std::string held_words(const auto& list, std::string_view noun) {
  const auto kept =
      static_cast<size_t>(std::count_if(list.begin(), list.end(), [](const auto& one) { return one.held; }));
  if (list.empty()) return "";
  if (kept < list.size()) return fmt::format("{} of {}", kept, counted(list.size(), noun));
  return list.size() == 1 ? fmt::format("the {}", noun) : fmt::format("all {}", counted(list.size(), noun));
}

std::string with_both(const std::string& a, std::string_view between, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + std::string(between) + b;
}

struct VerdictRow {
  Verdict verdict;
  std::string_view word;
  int exit_code;
};
constexpr int exit_code(ErrorKind kind) { return static_cast<int>(kind); }
constexpr std::array<VerdictRow, 7> verdict_rows{{{Verdict::unsound, "unsound", exit_code(ErrorKind::defect)},
                                                  {Verdict::incomplete, "incomplete", exit_code(ErrorKind::incomplete)},
                                                  {Verdict::refused, "refused", exit_code(ErrorKind::file)},
                                                  {Verdict::worse, "worse", 1},
                                                  {Verdict::broken, "broken", 1},
                                                  {Verdict::held, "held", 0},
                                                  {Verdict::measured, "measured", 0}}};

}  // namespace

Verdict verdict_of(const Results& results) {
  if (!find_unsound(results.points).empty()) return Verdict::unsound;
  if (results.stopped || static_cast<int64_t>(results.points.size()) < results.planned_points)
    return Verdict::incomplete;
  if (!refused_frames(results.points).empty()) return Verdict::refused;
  if (results.baseline && !results.baseline->held()) return Verdict::worse;
  const auto broken = [](const auto& one) { return is_broken(one); };
  if (std::any_of(results.bounds.begin(), results.bounds.end(), broken) ||
      std::any_of(results.laws.begin(), results.laws.end(), broken))
    return Verdict::broken;
  return results.bounds.empty() && results.laws.empty() && !results.baseline ? Verdict::measured : Verdict::held;
}

std::string_view word_of(Verdict verdict) { return verdict_rows[static_cast<size_t>(verdict)].word; }
int exit_code_of(Verdict verdict) { return verdict_rows[static_cast<size_t>(verdict)].exit_code; }
int exit_code_of_run(Verdict verdict) {
  return verdict == Verdict::worse || verdict == Verdict::broken ? 0 : exit_code_of(verdict);
}

std::string your_bias(std::span<const PointRecord> points) {
  const auto bias = [](const PointRecord& point) {
    const std::string parameter = has_curve(point) ? curve_parameter(point) : "";
    return std::tuple(parameter, parameter.empty() ? "" : setting_of(point, parameter), curve_unit(point));
  };
  std::vector<const PointRecord*> all;
  for (const PointRecord& point : points)
    if (bias(point) == bias(points.front())) all.push_back(&point);
  const std::optional<double> value = points.empty() ? std::nullopt : number_of(std::get<1>(bias(points.front())));
  return value && all.size() == points.size() ? "your " + named_bias(all, *value) : "";
}

std::string these_points(std::span<const PointRecord> points) {
  const std::string_view noun = judges_frames(points) ? "frame" : "point";
  return points.size() == 1 ? fmt::format("this {}", noun) : "these " + counted(points.size(), noun);
}

std::string verdict_sentence(const Results& results) {
  const Verdict verdict = verdict_of(results);
  if (verdict == Verdict::unsound) return fmt::format("Unsound: {}", text_of(find_unsound(results.points).front()));
  const std::string_view noun = judges_frames(results.points) ? "frame" : "point";
  std::string text;
  const auto add = [&](std::string_view head, const std::string& words) {
    if (!words.empty()) text += fmt::format("{}{}{}", text.empty() ? "" : "; ", head, words);
  };
  const std::string baseline = results.baseline ? baseline_verdict(*results.baseline) : "";
  if (verdict == Verdict::incomplete)
    add("Incomplete: ", fmt::format("{} of {} are finished", results.points.size(),
                                    counted(static_cast<size_t>(results.planned_points), noun)));
  if (verdict == Verdict::refused)
    add("Refused: ",
        fmt::format("{} of {}", refused_frames(results.points).size(), counted(results.points.size(), noun)));
  if (verdict == Verdict::worse) add("W", baseline.substr(1));
  if (verdict == Verdict::measured)
    add("Measured: ", counted(results.points.size(), noun) + ", and nothing is promised");
  const bool first = text.empty();
  const std::string broken = with_both(broken_words(results.bounds, "bound"), ", ", broken_words(results.laws, "law")),
                    held = with_both(held_words(results.bounds, "bound"), " and ", held_words(results.laws, "law"));
  const bool any_bound =
      std::any_of(results.bounds.begin(), results.bounds.end(), [](const BoundResult& one) { return one.held; });
  add(first ? "Broken: " : verdict == Verdict::incomplete ? "broken so far: " : "broken: ", broken);
  if (broken.empty() && verdict != Verdict::incomplete && !held.empty())
    add(first ? "Held: " : "held: ",
        fmt::format("{} at {}", with_both(any_bound ? your_bias(results.points) : "", " holds ", held),
                    these_points(results.points)));
  if (verdict != Verdict::worse) add(text.empty() ? "Held: " : "", baseline);
  const auto warnings = static_cast<size_t>(std::count_if(
      results.bounds.begin(), results.bounds.end(), [](const BoundResult& one) { return !one.held && one.warns; }));
  if (warnings > 0) add("", counted(warnings, "warning"));
  // What is promised holds in a picture that says little.
  if (!held.empty() && !poor_view_note(results.points).empty()) text += ", in a poor picture (see its note)";
  return text;
}

}  // namespace noonmark
