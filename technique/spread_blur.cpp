#include "technique/spread_blur.h"

#include <cmath>
#include <stdexcept>

namespace noonmark {
namespace {

// Evenly from -radius to radius; a single tap stands in the middle.
std::vector<double> places_of(const LookupSettings& settings) {
  const int count = settings.whole("samples");
  std::vector<double> places;
  for (int i = 0; i < count; ++i)
    places.push_back(count == 1 ? 0 : settings["radius"] * (2 * i - (count - 1)) / (count - 1));
  return places;
}

}  // namespace

SpreadBlur spread_blur(const LookupSettings& settings) {
  SpreadBlur blur;
  const std::vector<double> places = places_of(settings);
  const int reach = static_cast<int>(std::ceil(settings["radius"])), size = 2 * reach + 1;
  const double share = 1.0 / static_cast<double>(places.size());
  blur.kernel_u.resize(static_cast<size_t>(size));
  blur.kernel_v.resize(static_cast<size_t>(size));
  for (const double place : places) {
    const double nearest = std::floor(place + 0.5), before = std::floor(place);
    const auto next = static_cast<float>(place - before);
    const auto at = [&](double texel) { return static_cast<size_t>(static_cast<int>(texel) + reach); };
    blur.along_v.push_back({static_cast<int>(nearest), 0});
    blur.along_u.push_back({static_cast<int>(before), next});
    blur.kernel_v[at(nearest)] += share;
    blur.kernel_u[at(before)] += share * (1 - static_cast<double>(next));
    if (next > 0) blur.kernel_u[at(before + 1)] += share * static_cast<double>(next);
  }
  return blur;
}

Spread spread_of(const SpreadBlur& blur, std::span<const double> depths) {
  const int size = blur.size(), reach = size / 2;
  if (depths.size() != static_cast<size_t>(size) * static_cast<size_t>(size))
    throw std::logic_error("spread_of: another number of depths than the blur has texels");
  // Of a column of depths, as the first pass stores it.
  const auto column = [&](int u) {
    const auto depth = [&](const SpreadBlur::Tap& tap) -> long double {
      return depths[static_cast<size_t>((tap.texel + reach) * size + u + reach)];
    };
    const auto taps = static_cast<long double>(blur.along_v.size());
    Spread made;
    long double square = 0;
    for (const SpreadBlur::Tap& tap : blur.along_v) made.mean += depth(tap) / taps;
    for (const SpreadBlur::Tap& tap : blur.along_v) square += (depth(tap) - made.mean) * (depth(tap) - made.mean);
    made.deviation = std::sqrt(square / taps);
    return made;
  };
  std::vector<Spread> columns;
  for (int u = -reach; u <= reach; ++u) columns.push_back(column(u));
  const auto fetched = [&](const SpreadBlur::Tap& tap) {
    const Spread& one = columns[static_cast<size_t>(tap.texel + reach)];
    if (tap.next == 0) return one;
    const Spread& other = columns[static_cast<size_t>(tap.texel + reach + 1)];
    const auto next = static_cast<long double>(tap.next);
    return Spread{(1 - next) * one.mean + next * other.mean, (1 - next) * one.deviation + next * other.deviation};
  };
  const auto taps = static_cast<long double>(blur.along_u.size());
  Spread made;
  long double square = 0;
  for (const SpreadBlur::Tap& tap : blur.along_u) made.mean += fetched(tap).mean / taps;
  for (const SpreadBlur::Tap& tap : blur.along_u) {
    const Spread one = fetched(tap);
    square += one.deviation * one.deviation + (one.mean - made.mean) * (one.mean - made.mean);
  }
  made.deviation = std::sqrt(square / taps);
  return made;
}

}  // namespace noonmark
