#include "compare/judge/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/text.h"
#include "compare/judge/baseline.h"
#include "compare/judge/bounds.h"
#include "compare/judge/deliveries.h"
#include "compare/judge/soundness.h"

namespace noonmark {
namespace {

bool is_broken(const BoundResult& bound) { return breaks(bound); }
bool is_broken(const LawResult& law) { return !law.held; }

// "1 of 2 bounds"; empty if none is.
std::string broken_words(const auto& list, std::string_view noun) {
  const auto broken = std::count_if(list.begin(), list.end(), [](const auto& one) { return is_broken(one); });
  return broken == 0 ? "" : fmt::format("{} of {}", broken, counted(list.size(), noun));
}

// "all 3 bounds", "2 of 3 bounds" where the others warn.
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

Verdict verdict_without_promises(const Results& results) {
  if (!find_unsound(results.points).empty()) return Verdict::unsound;
  if (results.stopped || static_cast<int64_t>(results.points.size()) < results.planned_points)
    return Verdict::incomplete;
  if (!refused_frames(results.points).empty()) return Verdict::refused;
  return Verdict::measured;
}

Verdict verdict_of(const Results& results) {
  if (const Verdict verdict = verdict_without_promises(results); verdict != Verdict::measured) return verdict;
  if (results.baseline && !results.baseline->held()) return Verdict::worse;
  const auto broken = [](const auto& one) { return is_broken(one); };
  if (std::any_of(results.bounds.begin(), results.bounds.end(), broken) ||
      std::any_of(results.laws.begin(), results.laws.end(), broken))
    return Verdict::broken;
  return results.bounds.empty() && results.laws.empty() && !results.baseline ? Verdict::measured : Verdict::held;
}

std::string_view word_of(Verdict verdict) { return verdict_rows[static_cast<size_t>(verdict)].word; }
int exit_code_of(Verdict verdict) { return verdict_rows[static_cast<size_t>(verdict)].exit_code; }

std::string verdict_sentence(const Results& results) {
  const std::string broken = with_both(broken_words(results.bounds, "bound"), ", ", broken_words(results.laws, "law"));
  const std::string points = counted(results.points.size(), "point");
  switch (verdict_of(results)) {
    case Verdict::unsound:
      return fmt::format("Not sound: {}.", text_of(find_unsound(results.points).front()));
    case Verdict::incomplete:
      return fmt::format("Incomplete: {} of {} points are finished{}.", results.points.size(), results.planned_points,
                         broken.empty() ? "" : "; broken so far: " + broken);
    case Verdict::refused:
      return refused_words(results.points) + (broken.empty() ? "." : "; broken: " + broken + ".");
    case Verdict::worse: {
      std::string worse = baseline_verdict(*results.baseline);
      worse.front() = 'W';
      return worse + (broken.empty() ? "." : "; broken: " + broken + ".");
    }
    case Verdict::broken:
      return fmt::format("Broken: {}.", broken);
    case Verdict::held: {
      const std::string held = with_both(held_words(results.bounds, "bound"), " and ", held_words(results.laws, "law"));
      const std::string since = results.baseline ? baseline_verdict(*results.baseline) : "";
      return fmt::format("Held: {}.",
                         with_both(held.empty() ? "" : fmt::format("{} over {}", held, points), "; ", since));
    }
    case Verdict::measured:
      return fmt::format("Measured {}.", points);
  }
  return "";
}

}  // namespace noonmark
