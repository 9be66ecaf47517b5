// A lookup in a map of moments, on the host: what a texel stores and what the lookup makes of it, in float as the shader
// computes it, and exactly, from the depths themselves.
//
//   const MomentLookup lookup(settings);
//   lookup.stored(0.25f);                       // the moments of a texel
//   lookup.exact(depths, 0.3);                  // R4: the lit fraction, before lookup.reduction
//   lookup.reduced(0.25);
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "technique/lookups.h"
#include "technique/settings.h"
#include "technique/spread_blur.h"

namespace noonmark {

class MomentLookup {
 public:
  // Throws std::logic_error if the settings' lookup compares depths.
  explicit MomentLookup(const Settings& settings);

  const LookupKind& kind() const { return *kind_; }
  MomentFormat format() const { return format_; }
  const in_float::LookupParameters& parameters() const { return parameters_; }
  std::span<const double> kernel() const { return kernel_; }  // of the blur, along each axis; sum 1
  int level() const { return level_; }                        // how often the stored texels are halved before the blur
  // Its own blur, in place of a kernel; null: the blur is the kernel's.
  const SpreadBlur* spread() const { return spread_ ? &*spread_ : nullptr; }
  // Of all that the texels of a blurred map depend on, besides the depths.
  std::string key() const;

  // As the shader: of a texel of this window depth; the lit fraction of a receiver of this biased window depth, before
  // lookup.reduction.
  glm::vec4 stored(float depth) const;
  float lit(glm::vec4 moments, float depth) const;
  // The lit fraction of these moments and this depth, with a bound of the error of a shader's float arithmetic.
  Bounded bounded_lit(glm::vec4 moments, float depth) const;

  // The lit fraction from the depths of the texels, before lookup.reduction: the number that the formula has on moments that
  // are not rounded (technique/lookup_truth.h). receiver: its biased window depth.
  double exact(TruthInDouble& depths, double receiver) const;
  // The same without the parameters that lift or darken the bound: variance floors and the bias of the moments. By law 13 it
  // is never below the share of the depths that are not before the receiver.
  double bare(TruthInDouble& depths, double receiver) const;

  // The same two of a lookup with a spread(), from the mean and the deviation that its fetch gives without rounding.
  double exact(const Spread& fetched, double receiver) const;
  double bare(const Spread& fetched, double receiver) const;

  // After light-bleed reduction: (lit - r) / span, clamped to [0, 1]; span is 1 - r unless lookup.reduction_span gives it.
  double reduction() const { return reduction_; }
  double reduced(double lit) const;
  float reduced(float lit) const;  // as the shader of an engine computes it

 private:
  const LookupKind* kind_;
  MomentFormat format_;
  in_float::LookupParameters parameters_;
  in_extended::LookupParameters exact_, bare_;
  double reduction_, span_;
  bool given_span_ = false;  // otherwise it is 1 - r
  int level_;
  std::vector<double> kernel_;
  std::optional<SpreadBlur> spread_;
};

}  // namespace noonmark
