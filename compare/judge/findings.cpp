#include "compare/judge/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/text.h"
#include "compare/judge/baseline.h"
#include "compare/judge/bounds.h"
#include "compare/judge/deliveries.h"
#include "compare/judge/law_table.h"
#include "compare/judge/laws.h"
#include "compare/judge/machines.h"
#include "compare/judge/poor_view.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

using Of = Promise::Of;
using State = Promise::State;

Promise promise_of(const PointRecord& frame) {
  const bool refused = !frame.delivery.refused.empty();
  return {Of::delivery,
          refused ? State::refused : State::held,
          "the delivery of " + frame_name(frame),
          refused ? frame.delivery.refused : delivery_text(frame),
          refused ? why_refused(frame) : delivery_text(frame),
          "",
          &frame,
          {}};
}

Promise promise_of(const BoundResult& bound, const Results& results) {
  const PointRecord* const point = find_point(results.points, bound.point);
  return {Of::bound,
          bound.held    ? State::held
          : bound.warns ? State::warning
                        : State::broken,
          bound_text(bound),
          bound.points == 0 ? "no finished point matches the bound"
                            : fmt::format("found {}", found_text(bound, results.points)),
          describe(bound, point, results.info.swept),
          bound.location,
          point,
          point ? failing_pixel(bound, *point) : std::nullopt};
}

Promise promise_of(const LawResult& law, const Results& results) {
  const PointRecord* const point =
      law.worst < 0 ? nullptr : find_point(results.points, law.samples[static_cast<size_t>(law.worst)].point);
  return {Of::law,
          law.held ? State::held : State::broken,
          law.name,
          law_text(law),
          law_table({&law, 1}),
          "",
          point,
          point && !law.held ? worst_pixel_of(*point, "error") : std::nullopt};
}

Promise promise_of(const BaselineComparison& baseline) {
  std::string lines;
  for (const std::string& line : baseline.worse) lines += printable(line) + "\n";
  return {Of::baseline,
          baseline.held() ? State::held : State::broken,
          "no value is worse than in the baseline",
          baseline_verdict(baseline),
          lines,
          "",
          nullptr,
          {}};
}

std::vector<Note> notes_of(const Results& results) {
  std::vector<Note> notes;
  const auto add = [&](Note::Of of, const std::vector<std::string>& texts) {
    for (const std::string& text : texts) notes.push_back({of, text});
  };
  const MachineNotes machines = machine_notes(results);
  add(Note::Of::picture, doubts_of(results.points));
  add(Note::Of::sweep, results.info.sweep_notes);
  add(Note::Of::sweep, machines.warnings);
  add(Note::Of::machines, machines.machines);
  add(Note::Of::scene, results.info.scene_notes);
  return notes;
}

}  // namespace

std::string_view word_of(State state) {
  constexpr std::array<std::string_view, 4> words{"held", "warning", "broken", "refused"};
  return words[static_cast<size_t>(state)];
}

std::vector<Promise> promises_of(const Results& results) {
  std::vector<Promise> promises;
  if (judges_frames(results.points))
    for (const PointRecord& frame : results.points) promises.push_back(promise_of(frame));
  for (const BoundResult& bound : results.bounds) promises.push_back(promise_of(bound, results));
  for (const LawResult& law : results.laws) promises.push_back(promise_of(law, results));
  if (results.baseline) promises.push_back(promise_of(*results.baseline));
  return promises;
}

Findings::Findings(const Results& of)
    : all(of),
      verdict(verdict_of(of)),
      sentence(verdict_sentence(of)),
      promises(promises_of(of)),
      notes(notes_of(of)),
      groups(compared_groups(of)) {
  const auto says = std::find_if(of.laws.begin(), of.laws.end(),
                                 [](const LawResult& law) { return !law.samples.empty() && !law.found.empty(); });
  if (says != of.laws.end()) headline = &*says;
  for (const ComparedGroup& group : groups) techniques.push_back(techniques_of(group, of));
  const std::vector<Recommendation> good =
      conditions_of(of.info) == of.info.over ? good_choices(groups) : good_choices(of);
  recommended = recommend(of, good);
}

}  // namespace noonmark
