#include "app/definition/experiment_keys.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "app/definition/experiment.h"
#include "technique/placements.h"

namespace noonmark {
namespace {

using Kind = ExperimentKey::Kind;

ExperimentKey of_file(std::string_view name, Kind kind, std::string_view help,
                      std::vector<std::string_view> choices = {}) {
  ExperimentKey key{name, kind, help, std::move(choices)};
  key.in_part = false;
  return key;
}
ExperimentKey of_part(std::string_view name, Kind kind, std::string_view help) {
  ExperimentKey key{name, kind, help};
  key.in_root = false;
  key.required = true;
  return key;
}
ExperimentKey whole(std::string_view name, std::string_view help, double least, double most, bool required = false) {
  return {name, Kind::whole, help, {}, least, most, true, true, required};
}
ExperimentKey required(ExperimentKey key) {
  key.required = true;
  return key;
}

const std::vector<ExperimentKey>& root_keys() {
  static const std::vector<ExperimentKey> keys = {
      {"sweep", Kind::sweep, "Settings with several values; every combination is a point."},
      {"over", Kind::sweep, "Settings with several values that the user does not choose, such as views."},
      {"curve", Kind::table, "The error against the bias."},
      {"phase", Kind::table, "The phase diagram: texel size against bias."},
      {"let", Kind::formulas, "Definitions for the formulas of laws."},
      of_file("frame", Kind::tables, "The frame of another renderer; check judges it."),
      {"bound", Kind::tables, "A limit of a metric; check judges it."},
      {"law", Kind::tables, "What one number must be, given others; check judges it."},
      of_part("name", Kind::text, "The part's name; different for every part."),
      of_file("title", Kind::text, "The heading of the report."),
      of_file("pictures", Kind::choice, "Which points get pictures; default: first, and broken where check measures.",
              {"first", "all", "none", "broken", "worst", "extremes", "answers"}),
      of_file("exr", Kind::flag,
              "Whether points with pictures also have their numbers as OpenEXR files; default: false."),
      of_file("times", Kind::flag,
              "Whether map and lookup are timed; default: where a metric that is named is a time."),
      of_file("plot", Kind::table, "Which metrics stand at the top of the report's list."),
      of_file("answer", Kind::table, "What the answer makes small, and what it counts as cost."),
      of_file("part", Kind::tables, "One of several experiments in one file."),
      of_file("lights", Kind::lights,
              "The lights of one frame, measured together: \"all\" of the scene, a list of names, a table [[lights]] "
              "for each, "
              "or the file's \"parts\"."),
  };
  return keys;
}

const std::vector<ExperimentKey>& plot_keys() {
  static const std::vector<ExperimentKey> keys = {
      {"metrics", Kind::quantities, "Metrics or quantities of the curve, each once."}};
  return keys;
}

const std::vector<ExperimentKey>& answer_keys() {
  static const std::vector<ExperimentKey> keys = {
      {"cost", Kind::metric, "The cost: the least is recommended; default: texel_work."},
      {"accuracy", Kind::metric, "The error: the least among equal costs; default: error_soft."},
      {"choose",
       Kind::names,
       "What recommend may choose although the file gives it.",
       {"map.resolution", "map.fit", "bias", "filter"}}};
  return keys;
}

const std::vector<ExperimentKey>& curve_keys() {
  static const std::vector<ExperimentKey> keys = {
      {"enabled", Kind::flag, "Whether bias curves are made; default: true."},
      {"acne_bound", Kind::fraction,
       "How much acne a usable bias may leave, a fraction of the counted receivers; default: 0.001."},
      {"peter_panning_bound", Kind::fraction, "How much Peter Panning a usable bias may make; default: 0.001."},
      {"bias_depth", Kind::amounts,
       "At which biases, in window depth, the curve is stored; 0 or more, ascending; default: 0 and 20 a decade from "
       "1e-7."},
      {"over",
       Kind::choice,
       "Of filtered maps: a setting that has a curve besides lookup.reduction.",
       {curve_settings().begin(), curve_settings().end()}},
      {"over_values", Kind::amounts, "Its values, ascending; default: 0 and two a decade."}};
  return keys;
}

const std::vector<ExperimentKey>& phase_keys() {
  static const std::vector<ExperimentKey> keys = {
      {"enabled", Kind::flag, "Whether there is a diagram; default: true where the table stands."},
      {"acne_bound", Kind::fraction, "How much acne a usable pair may leave; default: that of [curve]."},
      {"peter_panning_bound", Kind::fraction,
       "How much Peter Panning a usable pair may make; default: that of [curve]."},
      whole("placements", "S: each texel size is measured at S x S placements; default: 8.", 1, Placements::most),
      whole("texel_sizes", "How many texel sizes, in equal steps of their logarithm; default: 25.", 2, most_phase_rows),
      whole("width_px",
            "Width of the picture whose receivers are counted, in pixels; at most view.width_px; default: 640.", 1,
            8192)};
  return keys;
}

const std::vector<ExperimentKey>& frame_table_keys() {
  static const std::vector<ExperimentKey> keys = {
      required({"file", Kind::text, "The path of its frame.json, from this file's folder."}),
      {"name", Kind::text, "What the report calls it; without one, the path of the file."},
      {"accept", Kind::names, "Checks of the delivery whose failure does not stop it."},
      {"without_map", Kind::flag, "Judge it by place alone, though its file names a shadow map; needs no OpenGL."}};
  return keys;
}

const std::vector<ExperimentKey>& light_keys() {
  static const std::vector<ExperimentKey> keys = {
      required({"name", Kind::text, "The light: its name, or that of its node; it is light.name."})};
  return keys;
}

const std::vector<ExperimentKey>& bound_keys() {
  static const std::vector<ExperimentKey> keys = {
      required({"metric", Kind::pattern, "A metric, a quantity of the curve, or a pattern of names (aliasing*)."}),
      {"max", Kind::limit,
       "The largest value that is allowed, in the metric's unit; a share also in percent: \"0.5%\"."},
      {"min", Kind::limit, "The smallest value that is allowed."},
      {"join",
       Kind::choice,
       "What is compared when several points match; default: worst.",
       {"worst", "mean", "median"}},
      {"placement", Kind::choice, "Which placement of the grid is judged; default: worst.", {"worst", "first"}},
      {"level",
       Kind::choice,
       "warn: a broken bound is a warning, and the exit code stays 0; default: error.",
       {"error", "warn"}},
      {"where", Kind::conditions, "Which points match; default: all."}};
  return keys;
}

const std::vector<ExperimentKey>& law_keys() {
  static const std::vector<ExperimentKey> keys = {
      required({"name", Kind::text, "Different for every law of the file."}),
      {"says", Kind::text, "The law in words."},
      {"found", Kind::text, "One sentence with the figures that were found, as {formula}."},
      required({"measured", Kind::formula, "What was measured."}),
      {"equals", Kind::formula, "What it must be."},
      {"at_most", Kind::formula, "What it must not exceed."},
      {"at_least", Kind::formula, "What it must reach."},
      {"within", Kind::number, "Tolerance as a fraction of the predicted number; default: 0.", {}, 0},
      {"slack", Kind::formula, "Tolerance in the measured number's unit; default: 0."},
      {"join", Kind::choice, "What one sample of the law is; default: each.", {"each", "mean", "slope"}},
      {"over", Kind::setting, "With join = slope: the setting on the horizontal axis."},
      {"where", Kind::conditions, "Which points are measured."},
      {"against", Kind::conditions, "At which other point the predicted side is read."}};
  return keys;
}

const std::vector<ExperimentKey>& range_keys() {
  static const std::vector<ExperimentKey> keys = {
      required({"min", Kind::number, "The first value."}),
      required({"max", Kind::number, "The last value."}),
      whole("steps", "How many values, both ends among them.", 2, static_cast<double>(max_points), true),
      {"scale", Kind::choice, "How the values between are spaced; default: linear.", {"linear", "log"}}};
  return keys;
}

struct NamedKeys {
  std::string_view table;
  const std::vector<ExperimentKey>& (*keys)();
};
constexpr NamedKeys tables[] = {{"root", root_keys},   {"plot", plot_keys},   {"answer", answer_keys},
                                {"curve", curve_keys}, {"phase", phase_keys}, {"frame", frame_table_keys},
                                {"bound", bound_keys}, {"law", law_keys},     {"range", range_keys},
                                {"lights", light_keys}};

}  // namespace

std::span<const ExperimentKey> experiment_keys(std::string_view table) {
  for (const NamedKeys& named : tables)
    if (named.table == table) return named.keys();
  throw std::logic_error("no table of an experiment file: " + std::string(table));
}

std::vector<std::string_view> key_names(std::string_view table, bool in_part) {
  std::vector<std::string_view> names;
  for (const ExperimentKey& key : experiment_keys(table))
    if (in_part ? key.in_part : key.in_root) names.push_back(key.name);
  return names;
}

const std::vector<std::string_view>& key_choices(std::string_view table, std::string_view key) {
  for (const ExperimentKey& row : experiment_keys(table))
    if (row.name == key) return row.choices;
  throw std::logic_error("no key of an experiment file: " + std::string(key));
}

}  // namespace noonmark
