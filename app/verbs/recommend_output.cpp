#include "app/verbs/recommend_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "app/advise/engine_trial.h"
#include "app/advise/recommend_text.h"
#include "base/shell_words.h"
#include "base/text.h"
#include "scenes/library.h"
#include "technique/light_frame.h"

namespace noonmark {

std::string whole_text(const Advice& advice) {
  std::string text;
  for (const auto& lines : {answer_text(advice), reasons_text(advice), rejected_text(advice)})
    for (const std::string& line : lines) text += printable(line) + "\n";
  return text;
}

namespace {

// What to type into the engines that are shown, each with what it gave in the engine itself, and where the others are.
void print_lines(const std::vector<EngineAdvice>& engines, std::span<const std::string> shown, const std::string& out) {
  std::vector<std::string> others;
  for (const EngineAdvice& engine : engines) {
    const std::string word = engine_word(engine.engine);
    if (std::find(shown.begin(), shown.end(), word) == shown.end()) {
      others.push_back(fmt::format("{} ({})", engine.engine, word));
      continue;
    }
    fmt::print("\nWhat to type into {} ({}):\n", engine.engine, engine.version);
    for (const std::string& line : engine_lines(engine)) fmt::print("  {}\n", line);
    for (const std::string& line : trial_text(engine)) fmt::print("{}\n", printable(line));
  }
  if (!others.empty())
    fmt::print("\nLines for {}: {}/engines.txt, or --lines NAME\n", fmt::join(others, ", "), printable(out));
}

}  // namespace

void print_advice(const Advice& advice, const std::vector<EngineAdvice>& engines, std::span<const std::string> shown,
                  const std::string& no_lines, Workbench& bench, const std::string& out) {
  const AdviceRequest& request = advice.request;
  if (no_lines.empty())
    print_lines(engines, shown, out);
  else
    fmt::print("\n{}.\n", printable(no_lines));
  if (const std::string note = notes_line(bench.scene(request.conditions.front().scene)); !note.empty())
    fmt::print("note: {}\n", printable(note));
  std::set<std::string> of_lights;  // conditions may be lights that stand elsewhere
  for (const Settings& condition : request.conditions)
    for (const std::string& note : light_notes(bench.scene(condition.scene), condition)) of_lights.insert(note);
  for (const std::string& note : of_lights) fmt::print("note: {}\n", printable(note));
  fmt::print("Why, and what simpler settings miss: {0}/recommended.txt; pictures: {0}/recommended-*.png\n",
             printable(out));
  for (const Answer& answer : advice.answers)
    if (&answer != advice.answer())
      fmt::print("The answer \"{0}\": {1}/recommended-{0}.toml; --answer {0} makes it the first\n",
                 answer_name(answer.kinds.front()), printable(out));
  fmt::print("Next: noonmark check {}/recommended.toml\n", printable(shell_quoted(out)));
}

}  // namespace noonmark
