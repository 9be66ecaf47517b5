// The taps of one receiver, read once for all that judge them: the ladder, the soundness check and the bias curve. They
// read different maps at the same texels.
//
//   read_taps(evidence, strip, climbing, soundness, counts);
//
// A judge has
//   struct Part;                                                         // what one thread has found
//   void receiver(size_t i, const ReceiverTaps& taps, Part& part) const; // for every facing receiver of the strip
//   void join(Part& part);                                               // once for each thread
//   void end_batch();                                                    // after the threads of a batch have joined
#pragma once
#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "compare/ladder/ladder.h"

namespace noonmark {

class ReceiverTaps {
 public:
  void read(const LookupEvidence& e, size_t i) { read(e.probe, e.taps, e.map, e.exact_map, i); }
  void read(const LookupProbe& probe, const TapTruth& truth, const MapSettings& settings, const MapDepths& map,
            size_t i) {
    const auto count = static_cast<size_t>(truth.taps_per_receiver);
    taps_.resize(count);
    index_.resize(count);
    const TexelSet& texels = *map.texels;
    const glm::ivec2 size = texels.size();
    TapRead read;
    if (probe.cube_resolution == 0) read.position = probe.map_texels[i];
    for (size_t t = 0; t < count; ++t) {
      const int tap = static_cast<int>(t);
      read.texel = probe.texel(i, tap);
      const glm::ivec2 at = wrapped(read.texel, size, settings.wrap);
      index_[t] = at.x < 0 ? on_border : texels.index(at);
      read.depth = depth_in(map, t);
      taps_[t] = tap_of(probe, truth.bits(i, tap), settings, size, i, tap, read);
    }
    asks_ = probe.asks(i);
    lit_beyond_far_ = probe.reference[i] > 1.0f && settings.lit_beyond_far;
    blended_ = probe.pattern.bilinear();
  }

  size_t size() const { return taps_.size(); }
  // A tap as it reads the exact map.
  const Tap& operator[](size_t t) const { return taps_[t]; }
  // The same tap as it reads another map at the same texels.
  Tap on(const MapDepths& map, DepthFormat format, size_t t) const { return at_depth(depth_in(map, t), format, t); }
  // The same tap if it reads this depth.
  Tap at_depth(float depth, DepthFormat format, size_t t) const {
    Tap tap = taps_[t];
    if (!asks_) return tap;
    tap.depth = depth;
    tap.always_lit = lit_beyond_far_ || compares_clamped(blended_, format, tap.depth);
    return tap;
  }

 private:
  static constexpr size_t on_border = ~size_t{0};
  float depth_in(const MapDepths& map, size_t t) const {
    return index_[t] == on_border ? border_depth : map[index_[t]];
  }

  std::vector<Tap> taps_;
  std::vector<size_t> index_;  // TexelSet::index of the texel that it reads
  bool asks_ = true, lit_beyond_far_ = false, blended_ = false;
};

// At most this many taps are read before the judges join what the threads have found. It bounds the memory of a curve's
// lists.
inline constexpr size_t batch_taps = size_t{1} << 23;

// Throws std::logic_error if the evidence does not hold the taps of this strip.
template <class... Judges>
void read_taps(const LookupEvidence& e, PixelRange strip, Judges&... judges) {
  require_strip(e, strip);
  const size_t batch = std::max<size_t>(1, batch_taps / static_cast<size_t>(e.taps.taps_per_receiver));
  for (size_t first = strip.first; first < strip.end; first += batch) {
    tbb::combinable<std::tuple<typename Judges::Part...>> found;
    tbb::parallel_for(tbb::blocked_range<size_t>(first, std::min(strip.end, first + batch), 8192),
                      [&](const tbb::blocked_range<size_t>& range) {
                        auto& parts = found.local();
                        ReceiverTaps taps;
                        for (size_t i = range.begin(); i != range.end(); ++i) {
                          if (!e.truth.facing[i]) continue;
                          taps.read(e, i);
                          std::apply([&](auto&... part) { (judges.receiver(i, taps, part), ...); }, parts);
                        }
                      });
    found.combine_each([&](auto& parts) { std::apply([&](auto&... part) { (judges.join(part), ...); }, parts); });
    (judges.end_batch(), ...);
  }
}

}  // namespace noonmark
