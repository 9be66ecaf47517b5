// What to type into other engines, for the report of an experiment: of its one choice of settings (recommended.toml has one), or of the
// choice that the report's answer names.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/advise/engines/engine_settings.h"
#include "app/definition/experiment.h"
#include "compare/judge/choices.h"
#include "compare/results/records.h"
#include "measure/workbench.h"

namespace noonmark {

// Which points the lines describe: the one home of this question.
struct DescribedChoice {
  std::vector<Settings> conditions;        // of the choice, at the recommended bias; at least one
  std::vector<const PointRecord*> points;  // the same, as they were measured; in the results
  // "the answer of this report"; empty: there is no other choice.
  std::string why;
};
// The only choice; of several that can be compared the recommended one, and where none is recommended that of least error. Empty
// with parts, with choices that cannot be compared (several scenes or views), and while conditions of some are not measured.
std::optional<DescribedChoice> described_choice(const Results& results);

// The text that `recommend` writes as engines.txt, of the described choice. It begins with the point that it is of, if there are
// several choices. The error that lines give is measured for maps of moments, because engines store other numbers than the point may
// have, and for cascades, which engines fit in their own way. Throws Error.
std::string experiment_engines(Workbench& bench, const Results& results);
// The same of an experiment with one choice, before anything is measured: without the error. points: at least one.
std::string experiment_engines(Workbench& bench, const Experiment& experiment, std::span<const Settings> points);

// Of what these conditions show. Throws Error.
SeenDepths depths_in_views(Workbench& bench, std::span<const Settings> conditions);

}  // namespace noonmark
