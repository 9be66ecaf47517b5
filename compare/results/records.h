// compare/results/: what is known of a measured point, as plain numbers and text, with one table row for each number:
// metrics, numbers of the curve, of a point, of a phase diagram. May include base, scenes and technique; computes nothing
// and stores nothing. A new number begins here.
//
// Records: the results of a sweep for each point, as plain numbers and text. The store keeps them. The report, the
// bounds, CSV, JUnit and the summary read them.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compare/results/cause_bounds.h"
#include "compare/results/phase_record.h"
#include "compare/results/window_steps.h"

namespace noonmark {

// What a number is over all placements of the map's grid, for each entry of BiasCurve::bias_depth. best: the least.
struct Band {
  std::vector<double> mean, worst, best;
};

// The error as a function of the amount of one part of the bias, from one lookup pass (compare/ladder/bias_curves.h).
// All else is as in the point's settings, also the part's own floor and cap. Parts that draw another map or move the
// lookup have no curve. Every series has one value for each entry of bias_depth, a fraction of the counted receivers
// (facing and not ambiguous).
//
// The axis is window depth; m_per_depth and texels_per_depth convert it to metres and texels. Under a spot light, and
// for a point light's texels, the depth of a metre or a texel differs from receiver to receiver. Then each of the two
// factors is its median over the facing receivers. If bias.unit is such a unit, the axis is the parameter times that
// median depth per unit. So metres and texels are always the parameter's own if that is its unit, and a value that is
// read from the axis and set as the bias gives the curve's error.
struct BiasCurve : CauseBounds {
  std::string parameter;  // "bias.constant": the setting that is varied
  std::string made;       // "one pass": exact, from thresholds; or "one pass, except for the sampler's weights"
  std::vector<double> bias_depth;  // ascending, window depth; the first is 0
  std::vector<double> error;       // mean |R5 - R1|
  std::vector<double> error_soft;  // mean |R5 - R0|
  std::vector<double> wrong;       // share of receivers with R5 != R1
  std::vector<double> acne, peter_panning, aliasing_dark, aliasing_light, coverage;  // at R4, booked tap by tap
  double m_per_depth = 1;       // metres = this times depth; directional: far - near
  double texels_per_depth = 1;  // directional: (far - near) / w
  // The usable window at the bounds below: every bias in [window_min, window_max] keeps both causes within their
  // bounds.
  std::optional<double> window_min_depth,
      window_max_depth;        // both empty: no bias is good enough
  double best_bias_depth = 0;  // middle of the interval of least error; twice its start if it has no end
  double best_error = 0;
  double flat_min_depth = 0, flat_max_depth = 0;  // biases whose error is within 10% of the best
  uint64_t breakpoints = 0;                       // of the exact curve
  // The least value of the parameter from which on no tap is acne, independent of the bounds above. First on the exact
  // map, where `acne` is defined, then on the GPU's own map with its format and rasteriser. Empty if no value is
  // enough.
  std::optional<double> acne_free_bias_depth, acne_free_bias_stored_depth;
  // With map.placements above 1: over all placements of the map's grid, at R4 (compare/ladder/placement_counts.h). The
  // series are empty without. The window holds at every placement; its ends are edges of the counts, so each is up to a
  // sixteenth of an octave inside the exact window.
  uint64_t placements = 0;
  Band error_band, acne_band, peter_panning_band, aliasing_band;
  std::optional<double> window_min_worst_depth, window_max_worst_depth;
  std::optional<double> acne_free_bias_worst_depth;  // exact, not at an edge
  WindowSteps steps;                                 // the windows at other bounds
};

// What a point of a filtered map would have with another value of one setting of the lookup: means over the counted
// receivers, fractions (compare/ladder/reduction_window.h). On the exact map, but for the errors that are shown.
struct LookupCurvePoint {
  std::string parameter;  // the setting: "lookup.reduction"
  double value = 0;       // of the parameter, in its unit
  double error = 0;       // |R4 - R1|
  double leak = 0, over_darkening = 0, peter_panning = 0, reduction = 0;
  double aliasing_dark = 0, aliasing_light = 0, coverage = 0;
  double shown_error = 0, shown_error_soft = 0;  // |R5 - R1| and |R5 - R0|
};

// A cause that a rung on top of R5 brought (add_rung, compare/ladder/ladder.h). Its share is the metric of its name. The
// built-in causes are described in causes.h.
struct RungCause {
  std::string name;                // "elsewhere": lower-case letters, digits and _; not the name of another metric
  std::string label;               // for legends: "Elsewhere (not from the shadow map)"
  std::string help;                // one sentence
  std::array<uint8_t, 3> color{};  // sRGB
  std::string rung;                // "R6": the rung on top of the step
};

// A picture of a point, for people. Path relative to the results' directory.
struct PictureRecord {
  std::string name;      // "truth", "map", "classes", "difference", "shaded" ...
  std::string path;      // "images/p0003-truth.png"
  std::string caption;   // one sentence
  std::string digest{};  // of the file as it was written (digest_of, base/digest.h)
};

// An image of a point, for programs.
struct ImageRecord {
  std::string path;  // "images/p0003-ladder.exr", relative to the results' directory
  std::string digest;
};

struct PointPictures {
  std::vector<PictureRecord> pictures;
  std::vector<ImageRecord> images;
};

// Where and when a point was measured.
struct Machine {
  std::string host;        // its name
  std::string cpu;         // "AMD EPYC 9B14"
  std::string driver;      // OpenGL's vendor, renderer and version
  std::string ray_tracer;  // Embree's version and instruction set
  std::string clock;       // when the point was finished by the clock of that host: ISO 8601, UTC
};

// What is kept of each cascade, by metric name.
inline constexpr const char* cascade_metrics[] = {"facing",
                                                  "counted",
                                                  "lit",
                                                  "error",
                                                  "error_soft",
                                                  "wrong",
                                                  "filter",
                                                  "displacement",
                                                  "aliasing_dark",
                                                  "aliasing_light",
                                                  "acne",
                                                  "peter_panning",
                                                  "coverage_dark",
                                                  "coverage_light",
                                                  "undecided",
                                                  "precision",
                                                  "texel_m",
                                                  "map_range_m",
                                                  "nearest_receiver_m",
                                                  "farthest_receiver_m",
                                                  "acne_free_bias_law_m",
                                                  "edge_displacement_texels",
                                                  "seam_points",
                                                  "seam_jump"};

struct PointRecord : PointPictures {
  int64_t id = 0;                               // position in the sweep, from 0
  std::string part;                             // the experiment's part; empty if it has no parts
  std::map<std::string, std::string> settings;  // every setting by its row's name, in canonical text
  std::string scene_digest;                     // of the contents of its scene (scenes/scene_digest.h)
  std::map<std::string, double> metrics;  // by metric name; not finite: could not be measured, which breaks any bound
  std::map<std::string, double> times;    // of stages: "hard_truth_ms", "texel_rays" ...
  std::optional<BiasCurve> curve;
  // Of a filtered map, over lookup.reduction, by ascending values; empty: none was asked for.
  std::vector<LookupCurvePoint> lookup_curve;
  std::optional<CauseBounds> lookup_bounds;  // of its usable window, the metrics reduction_min and reduction_max
  std::vector<LookupCurvePoint>
      over_curve;                 // the same over the setting of CurveOptions::over; empty: none was asked for
  std::vector<RungCause> causes;  // the causes that rungs on top of R5 brought, in the order of the rungs
  struct Worst {
    int x = -1, y = -1;
    double error = 0;
    std::string cause;
  } worst;  // the worst pixel; row 0 on top
  // The pixel with the largest part of a metric that is a mean or a maximum over the picture, as rendered. Metrics that
  // are 0, and numbers that no pixel has (times, counts, windows), have none.
  struct WorstOf {
    std::string metric;
    int x = -1, y = -1;  // row 0 on top
    double size = 0;     // in the metric's unit
  };
  std::vector<WorstOf> worst_of;
  // Of a point with several cascades each, near ones first; empty with one map.
  struct Cascade {
    double begin_m = 0, end_m = 0;  // the depths along the view at which its slice begins and ends
    std::map<std::string, double>
        metrics;  // those of cascade_metrics, over the receivers of this cascade alone; the seam is the
                  // one to the next
    // The least amount of the curve's parameter from which on no tap of this cascade is acne; empty: no curve, or no amount
    // is enough.
    std::optional<double> bias_needed;
  };
  std::vector<Cascade> cascades;
  // What was found out about another renderer's frame before it was judged.
  struct Delivery {
    std::string refused;      // why its shadows are not judged; empty: they are. Then no bound is judged at this point
    std::string accepted;     // the checks that failed and were accepted: "coverage: the frame is flipped in y; ..."
    std::string not_checked;  // the names of the checks that had too little to go on: "inverted, match"
  } delivery;
  Machine machine;  // the points of a joined store can be of several (compare/store/join.h)
};

// A bound and its result (compare/judge/bounds.h).
struct BoundResult {
  std::string metric;
  std::optional<double> max{}, min{};
  std::map<std::string, std::vector<std::string>> where{};  // setting name -> the canonical texts that match
  std::string join{};                                       // "worst", "mean", "median"
  bool held = false;
  double found = 0;         // the joined value; not finite if any value was not
  int64_t point = -1;       // the worst point
  int points = 0;           // the number of points it was checked on; 0 breaks the bound
  std::string reproduce{};  // the command that renders the worst point
  // "worst", "first": which placement of the map's grid was judged; empty: the points have one placement each
  std::string placement{};
  std::string part{};  // the experiment's part; empty if it has no parts
  bool warns = false;  // broken, it is a warning and does not break the verdict
  std::optional<double>
      before{};  // what the run before found (compare/judge/last_run.h); empty: it did not have this bound
  // Of these two the store has none. Where its experiment gives it: "file:line:column"; empty: not known. And whether its `where` names
  // the first point's own view.
  std::string location{};
  bool at_given_view = false;
};

enum class LawRelation { equal, at_most, at_least };

// A law and its result (compare/judge/laws.h).
struct LawResult {
  std::string part, name, says;
  std::string found;                // a sentence with its figures; empty if the law has none
  std::string measured, predicted;  // the formulas
  LawRelation relation = LawRelation::equal;
  std::string tolerance;  // "within 5%", "within 5% + depth_quantum_m"; empty: none
  std::string join;       // "each", "mean", "slope over map.resolution"
  struct Sample {
    int64_t point = -1;  // the measured point; the first one if several are joined
    double predicted = 0, measured = 0;
    double allowed = 0;  // the largest difference allowed
  };
  std::vector<Sample> samples;
  int worst = -1;  // index of the sample furthest off relative to what is allowed; -1: no sample
  bool held = false;
  std::string reproduce;  // the command that renders the worst sample's point
};

// How the results were made.
struct RunInfo {
  std::string experiment;  // path as given, or empty
  std::string file;        // the same as seen from the folder of the store; empty: not known
  std::string title;
  std::string command;          // the command line
  std::string commit, version;  // of Noonmark; commit may be "unknown"
  std::string started;          // ISO 8601, UTC
  std::string host_cpu;
  std::string gl_vendor, gl_renderer, gl_version, gl_timer;  // gl_timer: "CPU time of the process"
  std::string embree_version, embree_isa;
  std::map<std::string, std::string> libraries;  // name -> version
  std::vector<std::string> swept;                // names of the swept settings, outermost first
  std::vector<std::string> over;                 // those of them that are conditions (compare/judge/choices.h)
  std::string cost = "texel_work";               // the metric by which answers are ranked
  std::string accuracy = "error_soft";           // the metric that answers make small
  std::vector<std::string> plot;                 // metrics the experiment asks to plot
  std::string scene_name;
  uint64_t triangles = 0;
  std::vector<std::string> scene_notes;  // one line for each note of a scene (Scene::notes)
  std::vector<std::string> sweep_notes;  // one sentence for each swept setting that no point reads
  // The experiment itself, with its options (app/definition/definition.h), so that stores can be joined and judged without its file.
  // Empty if no file can say it.
  std::string definition;
  std::string share;  // "2/4": only this share of the experiment was measured; "joined": of several stores; empty: all
};

// What became of the values of a baseline (compare/judge/baseline.h).
struct BaselineComparison {
  std::vector<std::string> worse, better, notes;  // one line each
  std::vector<std::string> changed;               // the settings and scenes that are not as they were; one line each
  uint64_t compared = 0;                          // number of values
  bool held() const { return worse.empty(); }
};

struct Results {
  RunInfo info;
  std::vector<PointRecord> points;  // ordered by id; an interrupted sweep has fewer than planned
  int64_t planned_points = 0;
  std::vector<BoundResult> bounds;
  std::vector<LawResult> laws;
  std::vector<PhaseDiagram> phases;  // one for each part that asks for it; an interrupted sweep may have fewer
  std::optional<BaselineComparison> baseline;  // empty: it was compared with none
  bool stopped = false;                        // by a signal, even if no point is missing; the store has none of this
};

// An experiment that failed before it could be judged.
struct Unjudged {
  std::string experiment;  // path as given
  std::string command;
  std::string started;  // ISO 8601, UTC
  std::string why;      // one line
  int exit_code = 0;
};

}  // namespace noonmark
