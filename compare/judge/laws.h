// Laws: what one number of a point must be, given its others. A bound names a limit; a law says where the limit comes
// from.
//
//   Law law{.name = "1", .measured = "acne_free_bias_m", .predicted = "k * texel_m * tan_deg(scene.theta_deg)"};
//   std::vector<LawResult> results = evaluate_laws(points, {law}, reproduce);
//
// Both sides are formulas (compare/judge/formula.h). Their names are, in this order: the law's own definitions (`let`),
// the settings that are numbers by their row's name (a flag is 1 or 0, a point has .x .y .z), the metrics, and the
// quantities of the bias curve.
//
// What breaks a law: a difference beyond the tolerance at any sample; a side, or a tolerance, that is not finite; a
// tolerance below 0; no point to ask.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "compare/judge/conditions.h"
#include "compare/store/records.h"

namespace noonmark {

struct Law {
  std::string name;  // "1 acne-free bias"
  std::string says;  // one sentence: the law itself
  // One sentence of what was found, with {formula} for its figures: read at the sample furthest off, or, as {against:
  // formula}, at the point that it is compared with.
  std::string found;
  std::string measured, predicted;
  LawRelation relation = LawRelation::equal;
  double within = 0;  // tolerance as a fraction of |predicted|
  std::string slack;  // and in the measured number's own unit: a formula of the measured point; empty: none
  // each: every point is a sample. mean: the means of both sides over the points are the only sample. slope: the
  // exponent p of measured ~ over^p, fitted to the means at each value of the setting `over` (least squares of the
  // logarithms), is the only sample.
  std::string join = "each";
  std::string over;    // slope: a setting that is a number
  Conditions where;    // which points are measured; empty: all
  Conditions against;  // with it, `predicted` is read at the other point: the one that differs from the measured point
                       // in nothing but the settings named here, which have there the one value given for each
  std::vector<std::pair<std::string, std::string>> let;  // definitions, in order; each may use the ones before
};

// Throws Error(usage): a formula that cannot be read; a name that is nothing (suggesting the nearest); a setting that
// is no number; a join or an `over` that does not fit; where and against as check_conditions() (conditions.h) has it.
void check_law(const Law& law);

// The quantities of the bias curve that the law's sides read.
std::vector<std::string> curve_names(const Law& law);

// One result for each law, in order. points: those that the laws speak of. reproduce gives the command that renders one
// point. Throws as check_law does.
std::vector<LawResult> evaluate_laws(std::span<const PointRecord> points, std::span<const Law> laws,
                                     const std::function<std::string(const PointRecord&)>& reproduce);

// "acne_free_bias_m = k * texel_m (within 5%)"
std::string law_text(const LawResult& law);

// "0.0676", "<= 0.707": what the law asks of the sample that is furthest off; "-" without a sample.
std::string predicted_text(const LawResult& law);

// "0.981 .. 1.002": the least and the largest measured / predicted, of the samples whose prediction is more than what
// they may be off; empty without one, where one is not finite, and for limits, of which it says nothing.
std::string ratio_text(const LawResult& law);

// A table for a terminal: law, points, predicted, measured, deviation, verdict; under each broken law the sample that
// is furthest off and the command that reproduces it.
std::string law_table(std::span<const LawResult> laws);

}  // namespace noonmark
