// Techniques of a group of choices: the settings that make one dearer are points of one curve, all others tell curves apart.
//
//   const Techniques techniques = techniques_of(group, results);
//   for (size_t i = 0; i < group.choices.size(); ++i) curve[techniques.of[i]].push_back(i);
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "compare/judge/tradeoff.h"
#include "compare/results/records.h"

namespace noonmark {

struct Techniques {
  // The swept number that makes a choice dearer: whatever the other settings are, a larger value has a higher cost (texel_work;
  // RunInfo::cost where that is not measured). Of several map.resolution, otherwise the first of the settings' table. Empty: none.
  std::string scale;
  std::vector<size_t> of;     // of each choice its technique
  std::vector<size_t> first;  // of each technique its first choice; in this order
};
// Choices are of one technique if they have the same part and the same swept settings, but for the scale and for tuned_settings():
// a technique stands at its best numbers.
Techniques techniques_of(const ComparedGroup& group, const Results& results);

// The numbers of a choice that cost nothing and that a user tunes, so that they make no technique of their own: the bias that its
// curves vary; of one that compares no depths its exponents, its reduction and its least variance, and bias.constant, because such a
// lookup has no bias curve. What blurs (filter.*, lookup.radius, lookup.samples) is not among them.
std::vector<std::string> tuned_settings(const Choice& choice);

// The cause of which one choice has more than another, and how much of it both have: the cause with the largest difference of the
// means over the conditions, at the bias. Empty if the first has more of no cause.
struct MoreOf {
  std::string cause;
  double one = 0, other = 0;
};
std::optional<MoreOf> more_of(const ComparedChoice& one, const ComparedChoice& other, AtBias at);

}  // namespace noonmark
