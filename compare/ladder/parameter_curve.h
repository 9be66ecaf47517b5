// What another value of one number of a filtered map's lookup would give, without another pass of OpenGL. The host computes R4
// from the depths of the exact map (compare/ladder/moment_climb.h), and R5 from the moments that OpenGL fetched at each
// receiver, in float as the shader does. R1, the map and its blur are the same at every value.
//
//   ParameterCurve over({"lookup.v_min", {}}, settings);
//   ParameterCurve::Adding adding(over, evidence, fetched);   // of each map
//   read_taps(evidence, strip, adding);
//   std::vector<LookupCurvePoint> curve = over.curve();
#pragma once
#include <array>
#include <cstdint>
#include <iterator>
#include <vector>

#include "compare/ladder/ladder.h"
#include "compare/ladder/moment_climb.h"
#include "compare/ladder/parameter_values.h"

namespace noonmark {

class ParameterCurve {
 public:
  // settings: of the point; has_curve_over() them. Throws std::logic_error otherwise.
  ParameterCurve(const ParameterValues& asked, const Settings& settings);

  // The numbers of a point of the curve.
  static constexpr double LookupCurvePoint::*numbers[] = {
      &LookupCurvePoint::error,           &LookupCurvePoint::leak,      &LookupCurvePoint::over_darkening,
      &LookupCurvePoint::peter_panning,   &LookupCurvePoint::reduction, &LookupCurvePoint::aliasing_dark,
      &LookupCurvePoint::aliasing_light,  &LookupCurvePoint::coverage,  &LookupCurvePoint::shown_error,
      &LookupCurvePoint::shown_error_soft};
  // Their sums over counted receivers, at one value. Each summand is rounded to 2^-36, so that the sums are exact and do not depend
  // on the order: up to 2^26 receivers (8192 x 8192 pixels) of up to 1 each.
  struct Sums {
    std::array<int64_t, std::size(numbers)> of{};
    bool finite = true;  // false: a summand was not, and no mean is known
    void add(const Sums& more);
    void add(const LookupCurvePoint& receiver);
  };

  // A judge of read_taps (compare/ladder/receiver_taps.h). fetched: the moments that the lookup of each receiver fetched from
  // OpenGL's own map. All that it is given outlives it.
  class Adding {
   public:
    struct Part {
      std::vector<Sums> sums;
      uint64_t receivers = 0;
      MomentScratch scratch;
    };
    Adding(ParameterCurve& curve, const LookupEvidence& evidence, const Image<glm::vec4>& fetched)
        : curve_(curve), e_(evidence), fetched_(fetched) {}
    void receiver(size_t i, const ReceiverTaps& taps, Part& part) const;
    void join(const Part& part);
    void end_batch() const {}

   private:
    ParameterCurve& curve_;
    const LookupEvidence& e_;
    const Image<glm::vec4>& fetched_;
  };

  // By ascending values: means over the receivers. Empty of no receiver.
  std::vector<LookupCurvePoint> curve() const;

 private:
  struct AtValue {
    double value = 0;
    MomentLookup lookup;
    Bias bias;
  };
  std::string setting_;
  std::vector<AtValue> at_;
  std::vector<Sums> sums_;
  uint64_t receivers_ = 0;
};

}  // namespace noonmark
