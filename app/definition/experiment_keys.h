// The keys of an experiment file that are not settings, described once. The reader takes from here which keys a table has
// and which words a key takes; the JSON schema (app/definition/experiment_schema.h) and the tables of `noonmark settings --html`
// (app/verbs/settings_page.h) are made from it.
//
//   for (const ExperimentKey& key : experiment_keys("bound")) print(key.name);
#pragma once
#include <span>
#include <string_view>
#include <vector>

namespace noonmark {

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
    quantity,    // the name of a metric or of a quantity of the curve
    quantities,  // a list of them
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
  std::string_view name;
  Kind kind;
  std::string_view help;  // one sentence
  std::vector<std::string_view> choices = {};
  double least = -1e300, most = 1e300;
  // In which of the two tables "root" and "part" it stands; of other tables both.
  bool in_root = true, in_part = true;
  bool required = false;
};

// table: "root" (the file and a part), "plot", "answer", "curve", "phase", "frame", "bound", "law",
// "range", "lights" (of a [[lights]], beside its settings).
std::span<const ExperimentKey> experiment_keys(std::string_view table);

// The names, for messages. in_part: of the table "root", those of a part.
std::vector<std::string_view> key_names(std::string_view table, bool in_part = false);

// The words that the key takes.
const std::vector<std::string_view>& key_choices(std::string_view table, std::string_view key);

}  // namespace noonmark
