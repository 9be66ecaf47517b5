// The table of a trial, and what follows from it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "app/advise/engine_trial.h"
#include "base/error.h"
#include "compare/results/number_text.h"

namespace noonmark {
namespace {

std::string trial_percent(double share) { return fmt::format("{:.4f}%", 100 * share); }

std::string trial_verdict(const TrialView& view) {
  if (!view.refused.empty()) return "not judged";
  return view.broken.empty() ? "held" : "BROKEN";
}

std::vector<std::string> trial_table(const EngineAdvice& engine) {
  const EngineTrial& trial = *engine.trial;
  std::vector<std::string> lines = {fmt::format(
      "Tried in {}: what these lines promise at the places that each frame shows, and the engine's own frame ({})",
      engine.engine, trial.folder)};
  lines.push_back(
      fmt::format("  {:<20}{:>10}{:>10}{:>10}{:>15}", "view", "promised", "measured", "acne", "Peter Panning"));
  for (const TrialView& view : trial.views) {
    const bool judged = view.refused.empty();
    const auto cell = [&](double share) { return judged ? trial_percent(share) : std::string("-"); };
    lines.push_back(fmt::format("  {:<20}{:>10}{:>10}{:>10}{:>15}  {}", view.name,
                                view.promise ? trial_percent(view.promise->error) : "-", cell(view.measured.error),
                                cell(view.measured.acne), cell(view.measured.peter_panning), trial_verdict(view)));
  }
  return lines;
}

}  // namespace

std::vector<std::string> trial_text(const EngineAdvice& engine) {
  if (!engine.trial) return {};
  const EngineTrial& trial = *engine.trial;
  std::vector<std::string> lines;
  if (!trial.views.empty()) lines = trial_table(engine);
  if (!trial.no_frame.empty()) lines.push_back(fmt::format("{}: {}.", engine.engine, trial.no_frame));
  for (const std::string& note : trial.notes) lines.push_back("note: " + note);
  for (const TrialView& view : trial.views) {
    if (!view.refused.empty())
      lines.push_back(
          fmt::format("{}, view {}: the frame is not judged, because {}.", engine.engine, view.name, view.refused));
    if (!view.broken.empty())
      lines.push_back(fmt::format(
          "{}, view {}: measured {}{}. So these lines are not an answer in this engine.", engine.engine, view.name,
          fmt::join(view.broken, " and "),
          view.promise
              ? fmt::format(", promised acne {}, Peter Panning {} and error {}", share_text(view.promise->acne),
                            share_text(view.promise->peter_panning), share_text(view.promise->error))
              : ""));
  }
  return lines;
}

bool broken_in_engine(const std::vector<EngineAdvice>& engines) {
  return std::any_of(engines.begin(), engines.end(), [](const EngineAdvice& engine) {
    return engine.trial && (engine.lines.empty() || std::any_of(engine.trial->views.begin(), engine.trial->views.end(),
                                                                [](const TrialView& view) {
                                                                  return !view.broken.empty() || !view.refused.empty();
                                                                }));
  });
}

void require_frames(const std::vector<EngineAdvice>& engines) {
  for (const EngineAdvice& engine : engines)
    if (engine.trial && !engine.lines.empty() && !engine.trial->no_frame.empty())
      throw Error(ErrorKind::device, engine.trial->no_frame);
}

}  // namespace noonmark
