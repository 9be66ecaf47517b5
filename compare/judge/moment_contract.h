// Whether OpenGL made of a map what a lookup in a map of moments says, stage by stage: what a texel stores, the two passes of
// the blur, the linear fetch, and the lit fraction. Each stage is checked from the one before it as OpenGL computed it, so
// that a bound of one stage's rounding is enough.
//
//   MomentContractCounts counts;
//   counts += check_moments(evidence, stored_map, moments, evidence.r5);   // of each map
//   metrics.merge(moment_contract_metrics(counts));
#pragma once
#include <map>
#include <string>

#include "compare/ladder/ladder.h"

namespace noonmark {

// Shares of what was checked that is off by more than its stage can be.
struct MomentContractCounts {
  uint64_t texels = 0, stored = 0;    // what a texel stores, from the depth that the sampler returns
  uint64_t sums = 0, blurred = 0;     // a sum of a halving or of a pass of the blur
  uint64_t fetches = 0, fetched = 0;  // what the lookup fetches, from the blurred texels
  uint64_t results = 0, lit = 0;      // the result, from what was fetched
  MomentContractCounts& operator+=(const MomentContractCounts& more);
};

// map: the depths of the map as its sampler returns them. moments: of that map (gl::Renderer::read_moments). result: of the
// lookup. Checked are the texels of the map's set and the facing receivers:
//   stored   equal to the formula in float on this side, as the format holds it: bit for bit in 32 bits; one of the two
//            neighbours in 16, where OpenGL may round to either. exp() is within 3 + 2 |x| units (GLSL 4.50, 4.7.1).
//   blurred  the sum of products in the shader's order, in float, as the format holds it; of a halving (lookup.level) the
//            mean of four; of a blur that stores a spread
//            (technique/spread_blur.h) within the error of float arithmetic. Texels of which a neighbour was not read are
//            left out.
//   fetched  between the blends with weights that are off by 2^-8, as samplers of GPUs have them.
//   lit      within the error of float arithmetic (technique/bounded.h).
MomentContractCounts check_moments(const LookupEvidence& evidence, const MapDepths& map, const MomentEvidence& moments,
                                   const Image<float>& result);

// contract_store, contract_blur, contract_fetch, contract_lit: shares; 0 where nothing was checked.
std::map<std::string, double> moment_contract_metrics(const MomentContractCounts& counts);

}  // namespace noonmark
