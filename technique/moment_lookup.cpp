#include "technique/moment_lookup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "technique/filters.h"

namespace noonmark {
namespace {

// The parameters that this lookup reads; the others are 0. The exact formula stores moments as they are.
template <class Parameters>
Parameters parameters_of(const LookupKind& kind, const LookupSettings& settings) {
  Parameters p{};
  const auto set = [&](std::string_view name, auto& field) {
    for (const auto& read : kind.reads)
      if (read.parameter->name() == name) field = static_cast<std::remove_reference_t<decltype(field)>>(settings[name]);
  };
  set("v_min", p.v_min);
  set("floor", p.floor);
  set("exponent", p.exponent);
  set("negative_exponent", p.negative_exponent);
  set("moment_bias", p.moment_bias);
  set("moments", p.moments);
  return p;
}

}  // namespace

MomentLookup::MomentLookup(const Settings& settings)
    : kind_(&find_lookup(settings.lookup.kind)),
      format_(settings.map.moments),
      parameters_(parameters_of<in_float::LookupParameters>(*kind_, settings.lookup)),
      exact_(parameters_of<in_extended::LookupParameters>(*kind_, settings.lookup)),
      reduction_(settings.lookup["reduction"]),
      span_(settings.lookup["reduction_span"]),
      level_(std::countr_zero(static_cast<unsigned>(texel_block(settings)))) {
  if (kind_->compares()) throw std::logic_error("MomentLookup: the lookup compares depths");
  bare_ = exact_;
  bare_.v_min = bare_.floor = bare_.moment_bias = 0;
  given_span_ = span_ != 0;
  if (!given_span_) span_ = 1 - reduction_;
  if (kind_->spread) {
    spread_ = spread_blur(settings.lookup);
    kernel_ = spread_->kernel_u;
    return;
  }
  kernel_ = find_filter(settings.filter.kind).blur(settings.filter);
}

std::string MomentLookup::key() const {
  const in_float::LookupParameters& p = parameters_;
  std::string key = fmt::format("{} {} {} {} {} {} {}", kind_->name, static_cast<int>(format_), p.exponent,
                                p.negative_exponent, p.moments, level_, fmt::join(kernel_, " "));
  if (spread_)
    for (const SpreadBlur::Tap& tap : spread_->along_u) key += fmt::format(" {} {}", tap.texel, tap.next);
  return key;
}

glm::vec4 MomentLookup::stored(float depth) const { return kind_->formulas->stored(depth, parameters_); }

float MomentLookup::lit(glm::vec4 moments, float depth) const {
  return kind_->formulas->lit(moments, depth, parameters_);
}

Bounded MomentLookup::bounded_lit(glm::vec4 m, float depth) const {
  const auto exact = [](float value) { return Bounded(static_cast<double>(value)); };
  const in_float::LookupParameters& p = parameters_;
  const in_bounds::LookupParameters bounded{
      exact(p.v_min), exact(p.floor), exact(p.exponent), exact(p.negative_exponent), exact(p.moment_bias), p.moments};
  return kind_->formulas->bounded_lit({exact(m.x), exact(m.y), exact(m.z), exact(m.w)}, exact(depth), bounded);
}

double MomentLookup::exact(TruthInDouble& depths, double receiver) const {
  return depths.lit(kind_->formulas->truth, receiver, exact_);
}

double MomentLookup::bare(TruthInDouble& depths, double receiver) const {
  return depths.lit(kind_->formulas->truth, receiver, bare_);
}

double MomentLookup::exact(const Spread& fetched, double receiver) const {
  return static_cast<double>(kind_->spread->truth({fetched.mean, fetched.deviation, 0, 0}, receiver, exact_));
}

double MomentLookup::bare(const Spread& fetched, double receiver) const {
  return static_cast<double>(kind_->spread->truth({fetched.mean, fetched.deviation, 0, 0}, receiver, bare_));
}

double MomentLookup::reduced(double lit) const { return std::clamp((lit - reduction_) / span_, 0.0, 1.0); }

// With the span 1 - r of the rounded r: then what is lit stays exactly 1.
float MomentLookup::reduced(float lit) const {
  const auto reduction = static_cast<float>(reduction_);
  const float span = given_span_ ? static_cast<float>(span_) : 1 - reduction;
  return std::clamp((lit - reduction) / span, 0.0f, 1.0f);
}

}  // namespace noonmark
