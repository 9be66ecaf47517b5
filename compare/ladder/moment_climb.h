// The ladder of a lookup in a map of moments (technique/lookups.h). It has no verdicts of taps, so its causes are not booked
// tap by tap.
//
// Rungs: R0, R1, R2 and R3 as of any lookup: the kernel of the blur and of the linear fetch is a pattern of weighted taps. R4
// is exact: the lookup's formula on the depths of the exact map, without rounding (MomentLookup::exact), reduced. R5 is
// OpenGL's. Between R3 and R4 lie two numbers that are no rungs: the bare bound, without any bias, floor or reduction, and
// the bound with bias and floors.
//
// With D the taps at the places looked up (D = R2 unless the lookup is moved), the change R4 - D is parted into lasting steps
// (compare/ladder/lasting_steps.h) over D, R3, bare, with floors, R4. So no cause stands on a pixel that is right:
//   aliasing          to R3
//   leak              to the bare bound, if it lightens; over_darkening, if it darkens
//   peter_panning     to the bound with bias and floors, if it lightens; over_darkening, if it darkens
//   reduction         to R4
// Before they are booked, coverage takes as much as the weight of the taps that lie outside the map, beyond far or before
// near, and undecided as much as the weight of the taps whose truth float error can change, both from the first step on.
// moment_precision and precision are the lasting steps from R4 to what OpenGL makes of the exact map, and from there to R5.
#pragma once
#include <optional>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/ladder/reduction_window.h"
#include "technique/moment_lookup.h"

namespace noonmark {

class ReceiverTaps;

// One receiver from R2 to R4, in double. Shares of 1; a step is negative if it darkens.
struct MomentSteps {
  double exact_lit = 0;  // R2
  LookupChain chain;     // from D on
  double shown = 0;      // R4
  // The undecided parts of the steps from R1 to R2 and from there to D.
  double before_exact = 0, before_moved = 0;
  double displacement = 0;
  LookupParts parts;  // of R4 - D
  // How much the bare bound is darker than the comparison of the same depths (law 13); negative if it is lighter.
  double below_comparison = 0;
  bool decided = false;  // ExactBound::decided: then nothing is reduced

  // Finds `shown` and `parts` from the chain, with this lookup's reduction.
  void reduce(const MomentLookup& lookup);

  double all_undecided() const { return before_exact + before_moved + parts.undecided; }
};

// The memory that moment_steps() uses again for the next receiver of a thread.
struct MomentScratch {
  std::vector<double> depths, weights;  // of the taps of one receiver
  TruthInDouble truth;                  // set to the depths that its fetch blends
  std::optional<Spread> fetched = {};   // in place of it: what its fetch gives of a blur that stores spreads
};

// Of a facing receiver. Pictures of OpenGL in the evidence are not read.
MomentSteps moment_steps(const LookupEvidence& evidence, size_t i, const ReceiverTaps& taps, MomentScratch& scratch);

// The bound of a receiver by another lookup in the same map and with another bias of the compared depth, in double. scratch: as
// moment_steps() left it for this receiver. The lookup has the same kind, blur and stored moments as that of the evidence.
struct ExactBound {
  double lit = 0;       // before light-bleed reduction
  float reference = 0;  // the biased depth, as the shader computes it
  bool decided =
      false;  // nothing is looked up: outside of what the map answers, or beyond far; then nothing is reduced
};
ExactBound exact_bound(const LookupEvidence& evidence, size_t i, const MomentLookup& lookup, const Bias& bias,
                       MomentScratch& scratch);

// Climbs a strip, as a judge of read_taps (compare/ladder/receiver_taps.h). The evidence has moments; its r4 is OpenGL's
// result on the exact map. The ladder has all of Cause.
class MomentClimb {
 public:
  struct Part {
    double steps = 0, taps = 0;  // the largest residuals of the ladder
    double below_comparison = 0;
    MomentScratch scratch;
    ReductionWindow reductions;  // of the counted receivers
  };
  // All must outlive this. kept: null, or one for each pixel of the picture, to which what is found of the receivers is written.
  MomentClimb(const LookupEvidence& evidence, PixelRange strip, Ladder& ladder,
              std::vector<MomentSteps>* kept = nullptr);
  // Climbs the strip from what another climb has kept, in place of read_taps: of a lookup that differed in its reduction alone.
  void climb_again(PixelRange strip);
  void receiver(size_t i, const ReceiverTaps& taps, Part& part) const;
  void join(const Part& part);
  void end_batch() const {}
  double below_comparison() const { return below_comparison_; }
  // Of the counted receivers, for another lookup.reduction.
  const ReductionWindow& reductions() const { return reductions_; }

 private:
  void book(size_t i, const MomentSteps& steps, Part& part) const;

  const LookupEvidence& e_;
  Ladder& ladder_;
  std::vector<MomentSteps>* kept_;
  double below_comparison_ = 0;
  ReductionWindow reductions_;
};

}  // namespace noonmark
