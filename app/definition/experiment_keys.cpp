#include "app/definition/experiment_keys.h"

#include "technique/placements.h"

namespace noonmark {
namespace {

using Kind = ExperimentKey::Kind;

ExperimentKey of_file(ExperimentKey key) {
  key.in_part = false;
  return key;
}
ExperimentKey of_part(ExperimentKey key) {
  key.in_root = false;
  key.required = true;
  return key;
}
ExperimentKey required(ExperimentKey key) {
  key.required = true;
  return key;
}

}  // namespace

std::vector<ExperimentKey> keys_of(Experiment& experiment) {
  return {
      {"sweep", Kind::sweep, "Settings with several values; every combination is a point."},
      {"over", Kind::sweep, "Settings with several values that the user does not choose, such as views."},
      {"curve", Kind::table, "The error against the bias."},
      {"phase", Kind::table, "The phase diagram: texel size against bias."},
      {"let", Kind::formulas, "Definitions for the formulas of laws."},
      of_file({"frame", Kind::tables, "The frame of another renderer; check judges it."}),
      {"bound", Kind::tables, "A limit of a metric; check judges it."},
      {"law", Kind::tables, "What one number must be, given others; check judges it."},
      of_part({"name", Kind::text, "The part's name; different for every part.", &experiment.part}),
      of_file({"title", Kind::text, "The heading of the report.", &experiment.title}),
      of_file({"pictures",
               Kind::choice,
               "Which points get pictures; default: first, and broken where check measures.",
               &experiment.pictures,
               {"first", "all", "none", "broken", "worst", "extremes", "answers"}}),
      of_file({"exr", Kind::flag,
               "Whether points with pictures also have their numbers as OpenEXR files; default: false.",
               &experiment.exr}),
      of_file(
          {"times", Kind::flag, "Whether map and lookup are timed; default: where a metric that is named is a time."}),
      of_file({"plot", Kind::table, "Which metrics stand at the top of the report's list."}),
      of_file({"answer", Kind::table, "What the answer makes small, and what it counts as cost."}),
      of_file({"part", Kind::tables, "One of several experiments in one file."}),
      of_file({"lights", Kind::lights,
               "The lights of one frame, measured together: \"all\" of the scene, a list of names, a table [[lights]] "
               "for each, or the file's \"parts\"."}),
  };
}

std::vector<ExperimentKey> plot_keys(Experiment& experiment) {
  return {
      {"metrics", Kind::quantities, "Metrics or quantities of the curve, each once.", &experiment.plot},
  };
}

std::vector<ExperimentKey> answer_keys(Experiment& experiment) {
  return {
      {"cost", Kind::metric, "The cost: the least is recommended; default: texel_work.", &experiment.cost},
      {"accuracy", Kind::metric, "The error: the least among equal costs; default: error_soft.", &experiment.accuracy},
      {"choose",
       Kind::names,
       "What recommend may choose although the file gives it.",
       &experiment.choose,
       {"map.resolution", "map.fit", "bias", "filter"}},
  };
}

std::vector<ExperimentKey> curve_keys(Experiment& experiment) {
  CurveOptions& curve = experiment.curve;
  return {
      {"enabled", Kind::flag, "Whether bias curves are made; default: true.", &experiment.curve_enabled},
      {"acne_bound", Kind::fraction,
       "How much acne a usable bias may leave, a fraction of the counted receivers; default: 0.001.",
       &curve.acne_bound},
      {"peter_panning_bound", Kind::fraction, "How much Peter Panning a usable bias may make; default: 0.001.",
       &curve.peter_panning_bound},
      {"bias_depth", Kind::amounts,
       "At which biases, in window depth, the curve is stored; 0 or more, ascending; default: 0 and 20 a decade from "
       "1e-7.",
       &curve.bias_depth},
      {"over",
       Kind::choice,
       "Of filtered maps: a setting that has a curve besides lookup.reduction.",
       &curve.over.setting,
       {curve_settings().begin(), curve_settings().end()}},
      {"over_values", Kind::amounts, "Its values, ascending; default: 0 and two a decade.", &curve.over.values},
  };
}

std::vector<ExperimentKey> keys_of(PhaseRequest& phase) {
  return {
      {"enabled", Kind::flag, "Whether there is a diagram; default: true where the table stands.", &phase.enabled},
      {"acne_bound", Kind::fraction, "How much acne a usable pair may leave; default: that of [curve].",
       &phase.acne_bound},
      {"peter_panning_bound", Kind::fraction,
       "How much Peter Panning a usable pair may make; default: that of [curve].", &phase.peter_panning_bound},
      {"placements",
       Kind::whole,
       "S: each texel size is measured at S x S placements; default: 8.",
       &phase.placements,
       {},
       1,
       Placements::most},
      {"texel_sizes",
       Kind::whole,
       "How many texel sizes, in equal steps of their logarithm; default: 25.",
       &phase.texel_sizes,
       {},
       2,
       most_phase_rows},
      {"width_px",
       Kind::whole,
       "Width of the picture whose receivers are counted, in pixels; at most view.width_px; default: 640.",
       &phase.width_px,
       {},
       1,
       8192},
  };
}

std::vector<ExperimentKey> keys_of(FrameRequest& frame) {
  return {
      required({"file", Kind::text, "The path of its frame.json, from this file's folder.", &frame.file}),
      {"name", Kind::text, "What the report calls it; without one, the path of the file.", &frame.name},
      {"accept", Kind::names, "Checks of the delivery whose failure does not stop it.", &frame.accepted},
      {"without_map", Kind::flag, "Judge it by place alone, though its file names a shadow map; needs no OpenGL.",
       &frame.without_map},
  };
}

std::vector<ExperimentKey> keys_of_light(std::string& name) {
  return {
      required({"name", Kind::text, "The light: its name, or that of its node; it is light.name.", &name}),
  };
}

std::vector<ExperimentKey> keys_of(Bound& bound) {
  return {
      required({"metric", Kind::pattern, "A metric, a quantity of the curve, or a pattern of names (aliasing*).",
                &bound.metric}),
      {"max", Kind::limit,
       "The largest value that is allowed, in the metric's unit; a share also in percent: \"0.5%\".", &bound.max},
      {"min", Kind::limit, "The smallest value that is allowed.", &bound.min},
      {"join",
       Kind::choice,
       "What is compared when several points match; default: worst.",
       &bound.join,
       {"worst", "mean", "median"}},
      {"placement",
       Kind::choice,
       "Which placement of the grid is judged; default: worst.",
       &bound.placement,
       {"worst", "first"}},
      {"level",
       Kind::choice,
       "warn: a broken bound is a warning, and the exit code stays 0; default: error.",
       &bound.level,
       {"error", "warn"}},
      {"where", Kind::conditions, "Which points match; default: all."},
  };
}

std::vector<ExperimentKey> keys_of(Law& law) {
  return {
      required({"name", Kind::text, "Different for every law of the file.", &law.name}),
      {"says", Kind::text, "The law in words.", &law.says},
      {"found", Kind::text, "One sentence with the figures that were found, as {formula}.", &law.found},
      required({"measured", Kind::formula, "What was measured.", &law.measured}),
      {"equals", Kind::formula, "What it must be."},
      {"at_most", Kind::formula, "What it must not exceed."},
      {"at_least", Kind::formula, "What it must reach."},
      {"within", Kind::number, "Tolerance as a fraction of the predicted number; default: 0.", &law.within, {}, 0},
      {"slack", Kind::formula, "Tolerance in the measured number's unit; default: 0.", &law.slack},
      {"join", Kind::choice, "What one sample of the law is; default: each.", &law.join, {"each", "mean", "slope"}},
      {"over", Kind::setting, "With join = slope: the setting on the horizontal axis.", &law.over},
      {"where", Kind::conditions, "Which points are measured."},
      {"against", Kind::conditions, "At which other point the predicted side is read."},
  };
}

std::vector<ExperimentKey> keys_of(RangeOfValues& range) {
  return {
      required({"min", Kind::number, "The first value.", &range.min}),
      required({"max", Kind::number, "The last value.", &range.max}),
      required({"steps", Kind::whole, "How many values, both ends among them.", &range.steps, {}, 2, max_points}),
      {"scale", Kind::choice, "How the values between are spaced; default: linear.", &range.scale, {"linear", "log"}},
  };
}

std::vector<ExperimentKey> experiment_keys(std::string_view table) {
  Experiment experiment;
  FrameRequest frame;
  Bound bound;
  Law law;
  RangeOfValues range;
  std::vector<ExperimentKey> keys = table == "root"     ? keys_of(experiment)
                                    : table == "plot"   ? plot_keys(experiment)
                                    : table == "answer" ? answer_keys(experiment)
                                    : table == "curve"  ? curve_keys(experiment)
                                    : table == "phase"  ? keys_of(experiment.phase)
                                    : table == "frame"  ? keys_of(frame)
                                    : table == "bound"  ? keys_of(bound)
                                    : table == "law"    ? keys_of(law)
                                    : table == "range"  ? keys_of(range)
                                                        : keys_of_light(experiment.part);
  for (ExperimentKey& key : keys) key.place = {};
  return keys;
}

std::vector<std::string_view> key_names(const std::vector<ExperimentKey>& keys, bool in_part) {
  std::vector<std::string_view> names;
  for (const ExperimentKey& key : keys)
    if (in_part ? key.in_part : key.in_root) names.push_back(key.name);
  return names;
}

}  // namespace noonmark
