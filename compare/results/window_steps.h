// What the usable window of a bias curve is read from, at any bounds: how many taps are acne from which amount of the bias
// on, and how many are Peter Panning. It is stored with the curve, so that other bounds need no other measurement.
//
//   if (curve.steps.can_judge({0.002, 0.002})) judge_window(curve, {0.002, 0.002});
//
// Amounts are in the unit of the curve's parameter; they are floats because the shader compares floats. Each list holds
// the part in which the share of the taps is at most most_share, so that it stays short.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "compare/results/cause_bounds.h"

namespace noonmark {

struct BiasCurve;

struct WindowSteps {
  struct Step {
    float amount;
    double taps;
    bool operator==(const Step&) const = default;
  };
  using Steps = std::vector<Step>;  // amounts ascend

  double most_share = -1;  // the largest bound that can be judged; -1: none
  double taps = 0;         // of all counted receivers: a share is the taps of a step divided by this
  double unit_depth = 1;   // window depth of one unit of the amounts
  Steps acne;              // from this amount on, so many taps are acne; descending
  Steps peter_panning;  // below this amount, so many taps are Peter Panning; ascending; the last amount may be infinite
  // The same at the worst placement of the map's grid, at the edges of its counts. Empty without map.placements.
  Steps acne_worst, peter_panning_worst;  // at this amount

  bool can_judge(const CauseBounds& bounds) const {
    return bounds.acne_bound <= most_share && bounds.peter_panning_bound <= most_share;
  }
  bool operator==(const WindowSteps&) const = default;
};

// Bounds up to this share can be judged from every stored curve; more only if the run itself asked for more. Larger
// bounds are seldom of use, and the lists grow with them.
inline constexpr double least_most_share = 0.05;

// Sets the curve's bounds and its windows, from its steps. The steps must be able to judge the bounds, or be empty (no
// receiver is counted): then there is no window.
void judge_window(BiasCurve& curve, const CauseBounds& bounds);

// A list as bytes, for the store. Whole numbers of taps take a few bytes a step. The second function throws
// std::exception if the bytes are not those of a list.
std::string bytes_of_steps(const WindowSteps::Steps& steps);
WindowSteps::Steps steps_of_bytes(const std::string& bytes);

}  // namespace noonmark
