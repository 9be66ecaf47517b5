// What became of each lookup that a recommendation was asked to choose among (recommend --lookups): an answer, or by what its best
// settings lost.
#pragma once
#include <string>
#include <vector>

#include "app/advise/recommend.h"

namespace noonmark {

struct LookupFate {
  enum class Outcome {
    answer,  // it is one of the three answers
    lost,    // it keeps the bounds, as far as it was measured, and something else is cheaper, errs less or is simpler
    broke,   // all of it that was measured breaks a bound
    not_measured  // none of it could have been an answer
  } outcome = Outcome::not_measured;
  std::string lookup;           // lookup.kind
  const Tried* best = nullptr;  // in the advice: the answer, the best that lost, or what came nearest to the bounds
  std::string
      why;  // a clause: "it has the same work, and an error of 0.25% in place of 0.24%, under the first condition"
};
std::string outcome_name(LookupFate::Outcome outcome);  // "not measured"

// In the order in which they were asked for; `compare` first. Empty if one kind of lookup alone was. The pointers are into the
// advice.
std::vector<LookupFate> lookup_fates(const Advice& advice);

// Of two settings that are no answer, whether the first came nearer to one: what keeps the bounds before what fails for the eye,
// for an error or a budget, and that before what breaks a bound on causes, by how far.
bool is_nearer(const Tried& tried, const Tried& than, const AdviceRequest& request);

// Each share divided by its bound, and of these the largest: 2 is twice the bound. Infinite if a bound is 0 and its share is not.
double excess(const FilteredShares& shares, const CurveOptions& bounds);

}  // namespace noonmark
