// The keys of an experiment file that are not settings: one row for each. The reader (app/definition/toml_reader.h) and the writer
// (app/definition/experiment_text.h) fill and write what the row points at; the JSON schema and the tables of
// `noonmark settings --html` (app/verbs/settings_page.h) are made from it.
//
//   for (const ExperimentKey& key : experiment_keys("bound")) print(key.name);
//   for (const ExperimentKey& key : keys_of(bound)) use(key.place);
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/definition/experiment.h"

namespace noonmark {

inline constexpr double any_number = -1e300;  // as the least one

struct ExperimentKey {
  // What stands behind the key.
  enum class Kind {
    text,        // a string
    names,       // a list of strings, of `choices` if there are any
    choice,      // one of `choices`
    flag,        // true or false
    number,      // finite, at least `least`
    fraction,    // 0 ... 1, or as text in percent: "0.5%"
    limit,       // a number; of a share also as text in percent
    whole,       // least ... most
    quantities,  // a list of names of metrics or of quantities of the curve
    pattern,     // such a name, or a pattern of names
    metric,      // the name of a metric
    formula,     // a string or a number
    formulas,    // a table of them
    setting,     // the name of a setting
    sweep,       // a table of settings with several values
    conditions,  // a table of settings with the values that match
    amounts,     // a list of numbers, or a range
    table,       // [name]: its keys are experiment_keys(name)
    tables,      // [[name]]
    lights,      // "all" or "parts", a list of names, or [[lights]], which has a name and settings
  };
  // Where the value is; without a place its reader and its writer name the key.
  using Place = std::variant<std::monostate, std::string*, bool*, int*, double*, std::optional<double>*,
                             std::vector<std::string>*, std::vector<double>*>;
  std::string_view name;
  Kind kind;
  std::string_view help;  // one sentence
  Place place = {};
  std::vector<std::string_view> choices = {};
  double least = any_number, most = -any_number;
  // In which of the two tables "root" and "part" it stands; of other tables both.
  bool in_root = true, in_part = true;
  bool required = false;
};

// The values of a range: min ... max.
struct RangeOfValues {
  std::optional<double> min, max;
  int steps = 0;
  std::string scale;
};

std::vector<ExperimentKey> keys_of(Experiment& experiment);  // of the file and of a part
std::vector<ExperimentKey> plot_keys(Experiment& experiment);
std::vector<ExperimentKey> answer_keys(Experiment& experiment);
std::vector<ExperimentKey> curve_keys(Experiment& experiment);
std::vector<ExperimentKey> keys_of(PhaseRequest& phase);
std::vector<ExperimentKey> keys_of(FrameRequest& frame);
std::vector<ExperimentKey> keys_of(Bound& bound);
std::vector<ExperimentKey> keys_of(Law& law);
std::vector<ExperimentKey> keys_of(RangeOfValues& range);
std::vector<ExperimentKey> keys_of_light(std::string& name);

// The same without places. table: "root" (the file and a part), "plot", "answer", "curve", "phase", "frame", "bound", "law",
// "range", "lights" (of a [[lights]], beside its settings).
std::vector<ExperimentKey> experiment_keys(std::string_view table);

// The names, for messages. in_part: of the table "root", those of a part.
std::vector<std::string_view> key_names(const std::vector<ExperimentKey>& keys, bool in_part = false);

// What a key takes, in words.
std::string taken_by(const ExperimentKey& key);

// The JSON schema (draft 7) of the experiment file, for editors: they complete keys and settings, show their help and mark
// mistakes. TOML has the same data model; `#:schema FILE` in the first line names it (Taplo, Even Better TOML). Made from the
// rows of the settings, of the keys and of the metrics. What a schema cannot say is left to the reader: settings that conflict,
// that are both fixed and swept, formulas, ranges that give no integers.
std::string experiment_schema();

}  // namespace noonmark
