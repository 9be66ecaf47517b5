// Laws: compute the value that one number of a point must have from its other numbers. A bound only gives a limit; a
// law also gives the reason for the limit.
//
//   Law law{.name = "1", .measured = "acne_free_bias_m", .predicted = "k * texel_m * tan_deg(scene.theta_deg)"};
//   std::vector<LawResult> results = evaluate_laws(points, std::span(&law, 1), reproduce);
//
// Both sides are formulas (compare/judge/formula.h). Their names are, in this order: the law's own definitions (`let`),
// the settings that are numbers by their row's name (a flag is 1 or 0, a point has .x .y .z), the metrics, the
// quantities of the bias curve, and the numbers of one cascade (cascade_number() in compare/results/quantities.h).
//
// A law is broken by a difference beyond the tolerance at any sample, by a side or a tolerance that is not finite, by a
// tolerance below 0, and if no point matches it. A formula that reads what the ambiguous receivers may change (ambiguous_room() in
// compare/judge/undecided.h) has no known value, which is not finite.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compare/judge/conditions.h"
#include "compare/results/records.h"

namespace noonmark {

struct Law {
  std::string name;  // "1 acne-free bias"
  std::string says;  // one sentence that states the law
  // One sentence about the result, with {formula} for its figures. A formula is evaluated at the worst sample (the one
  // furthest off), and {against: formula} at the point that it is compared with.
  std::string found;
  std::string measured, predicted;
  LawRelation relation = LawRelation::equal;
  double within = 0;  // tolerance as a fraction of |predicted|
  std::string slack;  // tolerance in the measured number's unit, a formula of the measured point; empty: none
  // each: every point is a sample. mean: the only sample is the means of both sides over the points. slope: the only
  // sample is the exponent p of measured ~ over^p. It is fitted to the means at each value of the setting `over` (least
  // squares of the logarithms).
  std::string join = "each";
  std::string over;    // slope: a setting that is a number
  Conditions where;    // which points are measured; empty: all
  Conditions against;  // if given, `predicted` is evaluated at another point: the one that differs from the measured
                       // point only in the settings named here, which have the given values there
  std::string location{};  // where the experiment gives it: "file:line:column"; empty: not known
  std::vector<std::pair<std::string, std::string>> let;  // definitions, in order; each may use the ones before
};

// Throws Error(usage) for a formula that cannot be read, for an unknown name (with the nearest one as a suggestion),
// for a setting that is no number, for a join or an `over` that does not fit, and for wrong conditions (conditions.h).
void check_law(const Law& law);

// What the law's sides read that is known only with a bias curve.
std::vector<std::string> curve_names(const Law& law);

// The metrics that any of the law's formulas reads, its definitions and the figures of its sentence included.
std::vector<std::string> metric_names(const Law& law);

// Returns one result for each law, in order. points: the points that the laws are about. reproduce returns the command
// that renders one point. Throws as check_law does.
std::vector<LawResult> evaluate_laws(std::span<const PointRecord> points, std::span<const Law> laws,
                                     const std::function<std::string(const PointRecord&)>& reproduce);

// "acne_free_bias_m = k * texel_m (within 5%)"
std::string law_text(const LawResult& law);

// "0.0676", "<= 0.707": the value that the law requires at the worst sample; "-" if there is no sample.
std::string predicted_text(const LawResult& law);

// "0.981 .. 1.002": the least and the largest measured / predicted of the samples whose prediction is larger than their
// tolerance. Empty if there is no such sample, if one is not finite, and for limits, for which a ratio has no meaning.
std::string ratio_text(const LawResult& law);

}  // namespace noonmark
