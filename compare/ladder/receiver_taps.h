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
  // The map must outlive the reading: the depths of taps that are alike are read when they are asked for.
  void read(const LookupProbe& probe, const TapTruth& truth, const MapSettings& settings, const MapDepths& map,
            size_t i) {
    const auto count = static_cast<size_t>(truth.taps_per_receiver);
    map_ = &map;
    format_ = settings.format;
    size_ = count;
    reference_ = probe.reference[i];
    asks_ = probe.asks(i);
    lit_beyond_far_ = reference_ > 1.0f && settings.lit_beyond_far;
    blended_ = probe.pattern.bilinear();
    const uint8_t* const bits = &truth.taps[(i - truth.first) * count];
    const bool on_one_side = list_texels(probe, settings, i);
    const bool plane = probe.tap_reference->plane;
    by_depth_ = asks_ && !blended_ && !plane;
    // Beyond far no tap is covered, wherever it reads.
    one_truth_ = asks_ && !plane && (on_one_side || reference_ > 1.0f) && std::equal(bits + 1, bits + count, bits);
    alike_ = one_truth_ && !blended_;
    list_weights(probe, i);
    if (one_truth_) {
      same_ = tap_of(probe, bits[0], settings, map.size(), i, 0, read_by(probe, i, 0));
      return;
    }
    taps_.resize(count);
    for (size_t t = 0; t < count; ++t) {
      const int tap = static_cast<int>(t);
      taps_[t] = tap_of(probe, bits[t], settings, map.size(), i, tap, read_by(probe, i, tap));
    }
  }

  size_t size() const { return size_; }
  // A tap as it reads the exact map.
  Tap operator[](size_t t) const { return one_truth_ ? at_depth(depth_in(*map_, t), format_, t) : taps_[t]; }
  // The same tap as it reads another map at the same texels.
  Tap on(const MapDepths& map, DepthFormat format, size_t t) const { return at_depth(depth_in(map, t), format, t); }
  // The same tap if it reads this depth.
  Tap at_depth(float depth, DepthFormat format, size_t t) const {
    Tap tap = one_truth_ ? same_ : taps_[t];
    if (!asks_) return tap;
    if (one_truth_) tap.weight = weight(t);
    tap.depth = depth;
    tap.always_lit = lit_beyond_far_ || compares_clamped(blended_, format, tap.depth);
    return tap;
  }

  // True if nothing but the depth that a tap reads decides whether it is lit, and each tap weighs 1: neither a plane, nor a
  // sampler.
  bool by_depth() const { return by_depth_; }
  // True if the truth of all taps is the same, and they differ only in the depth that they read and in their weight.
  bool one_truth() const { return one_truth_; }
  // As whole_weight() counts: a share of the blend, or 1.
  double weight(size_t t) const {
    if (!blended_) return 1;
    const size_t side = weight_u_.size();
    return weight_u_[t % side] * weight_v_[t / side];
  }
  // True if the taps differ in that depth only, so that they are judged together.
  bool alike() const { return alike_; }
  // Of tap t: the depth that it reads in a map with the same texels.
  float depth_in(const MapDepths& map, size_t t) const {
    return index_[t] == on_border ? border_depth : map[index_[t]];
  }
  // Of taps by_depth(): how many are lit at this bias on a map with the same texels.
  size_t lit_on(const MapDepths& map, float bias) const {
    if (lit_beyond_far_) return size_;
    const float biased = reference_ - bias;  // as Tap::lit()
    size_t lit = biased > border_depth ? 0 : beside_;
    for (const Run& run : runs_) {
      const float* const depth = &map.depth[run.first];
      uint32_t of_run = 0;
      for (uint32_t k = 0; k < run.length; ++k) of_run += !(biased > depth[k]);
      lit += of_run;
    }
    return lit;
  }

 private:
  static constexpr uint32_t on_border = ~uint32_t{0};
  // Texels that follow each other in the lists of the maps.
  struct Run {
    uint32_t first, length;
  };

  // Lists the texels that the taps read. Returns true if all taps lie inside the map, or if all taps lie outside it; false if
  // some lie inside and some outside.
  bool list_texels(const LookupProbe& probe, const MapSettings& settings, size_t i) {
    const TexelSet& texels = *map_->texels;
    const glm::ivec2 map_size = texels.size();
    index_.clear();
    runs_.clear();
    beside_ = 0;
    if (probe.cube_resolution == 0 && probe.pattern.texel_side() > 0) {
      probe.square_at(probe.map_texels[i], i, square_);
      if (inside_map(square_.front(), map_size) && inside_map(square_.back(), map_size)) {
        for (const glm::ivec2 row : square_) texels.indexes(row.y, square_, index_);
        list_runs();
        return true;
      }
      if (settings.wrap == Wrap::clamp_to_border && beside_map(square_.front(), square_.back(), map_size)) {
        index_.assign(size_, on_border);
        beside_ = size_;
        return true;
      }
    }
    size_t inside = 0;
    for (int tap = 0; tap < static_cast<int>(size_); ++tap) {
      const glm::ivec2 texel = probe.texel(i, tap), at = wrapped(texel, map_size, settings.wrap, probe.pattern.block);
      inside += inside_map(texel, map_size);
      beside_ += at.x < 0;
      index_.push_back(at.x < 0 ? on_border : static_cast<uint32_t>(texels.index(at)));
    }
    list_runs();
    return inside == 0 || inside == size_;
  }
  void list_runs() {
    for (const uint32_t index : index_) {
      if (index == on_border) continue;
      if (!runs_.empty() && index == runs_.back().first + runs_.back().length)
        ++runs_.back().length;
      else
        runs_.push_back({index, 1});
    }
  }
  void list_weights(const LookupProbe& probe, size_t i) {
    weight_u_.clear(), weight_v_.clear();
    if (!blended_) return;
    const glm::dvec2 fraction = probe.pattern.fetch_fraction(probe.map_texels[i]);
    for (int t = 0; t < probe.pattern.blended_side; ++t) {
      weight_u_.push_back(probe.pattern.along_axis(0, t, fraction.x));
      weight_v_.push_back(probe.pattern.along_axis(1, t, fraction.y));
    }
  }
  TapRead read_by(const LookupProbe& probe, size_t i, int tap) const {
    TapRead read;
    if (probe.cube_resolution == 0) read.position = probe.map_texels[i];
    read.texel = probe.texel(i, tap);
    read.depth = depth_in(*map_, static_cast<size_t>(tap));
    return read;
  }

  const MapDepths* map_ = nullptr;  // the exact map
  size_t size_ = 0;
  std::vector<uint32_t> index_;              // TexelSet::index of the texel that a tap reads
  std::vector<Run> runs_;                    // the same, without the taps that read the border
  size_t beside_ = 0;                        // the taps that read the border
  std::vector<Tap> taps_;                    // not of one_truth()
  Tap same_;                                 // each of them then, but for its depth and its weight
  std::vector<double> weight_u_, weight_v_;  // of the columns and rows of a blended square
  DepthFormat format_ = DepthFormat::d32f;   // of the exact map
  float reference_ = 0;
  bool asks_ = true, lit_beyond_far_ = false, blended_ = false, by_depth_ = false, one_truth_ = false, alike_ = false;
  std::vector<glm::ivec2> square_;  // its memory is used again
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
