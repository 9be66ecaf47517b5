#include "raytrace/texel_rays.h"

#include <tbb/combinable.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <atomic>
#include <cassert>

#include "raytrace/packets.h"

namespace noonmark {
namespace {

constexpr size_t outside_buffer = 1u << 22;  // texels outside the map that a thread collects before it looks for twins

// Sorts by row, then column, so that neighbours in the list are neighbours in the map.
uint64_t texel_key(glm::ivec2 texel) {
  const auto shifted = [](int i) { return static_cast<uint64_t>(static_cast<uint32_t>(i) ^ 0x80000000u); };
  return shifted(texel.y) << 32 | shifted(texel.x);
}

glm::ivec2 texel_of(uint64_t key) {
  const auto back = [](uint64_t i) { return static_cast<int>(static_cast<uint32_t>(i) ^ 0x80000000u); };
  return {back(key & 0xffffffffu), back(key >> 32)};
}

}  // namespace

TexelRays::TexelRays(const EmbreeScene& embree, const LightView& view, Wrap wrap)
    : embree_(&embree), view_(&view), wrap_(wrap), wanted_(view.frame().map_size().x, view.frame().map_size().y, 0) {
  assert(view.scene().triangles.size() < no_primitive >> 1);
}

void TexelRays::ask(const Image<uint8_t>& facing, const LookupProbe& probe, PixelRange pixels) {
  const glm::ivec2 size(wanted_.width, wanted_.height);
  struct Outside {
    std::vector<uint64_t> keys;
    size_t limit = outside_buffer;
  };
  tbb::combinable<Outside> outside_keys;
  tbb::parallel_for(tbb::blocked_range<size_t>(pixels.first, pixels.end, 4096),
                    [&](const tbb::blocked_range<size_t>& range) {
                      Outside& outside = outside_keys.local();
                      for (size_t i = range.begin(); i != range.end(); ++i) {
                        if (!facing[i]) continue;
                        for (int tap = 0; tap < probe.taps(); ++tap) {
                          const glm::ivec2 texel = probe.texel(i, tap);
                          const glm::ivec2 read = wrapped(texel, size, wrap_);
                          if (read.x >= 0)
                            std::atomic_ref(wanted_.at(read.x, read.y)).store(1, std::memory_order_relaxed);
                          if (!inside_map(texel, size)) outside.keys.push_back(texel_key(texel));
                        }
                        // Neighbouring pixels ask for the same texels; without this a wide kernel outside the map fills
                        // the memory. The limit doubles with what is truly different, so that the sorting stays a small
                        // share of the work.
                        if (outside.keys.size() > outside.limit) {
                          std::sort(outside.keys.begin(), outside.keys.end());
                          outside.keys.erase(std::unique(outside.keys.begin(), outside.keys.end()), outside.keys.end());
                          outside.limit = std::max(outside_buffer, 2 * outside.keys.size());
                        }
                      }
                    });

  outside_keys.combine_each(
      [&](const Outside& part) { outside_keys_.insert(outside_keys_.end(), part.keys.begin(), part.keys.end()); });
  tbb::parallel_sort(outside_keys_);
  outside_keys_.erase(std::unique(outside_keys_.begin(), outside_keys_.end()), outside_keys_.end());
}

// Calls store(i, FirstHit) for each texel.
void TexelRays::first_hits(size_t count, const auto& texel_at, const auto& store) {
  for_each_packet(count, [&](size_t first, int n) {
    glm::dvec3 places[packet_size];
    uint32_t hits[packet_size];
    bool clipped = false;
    for (int i = 0; i < n; ++i) places[i] = view_->texel_place(texel_at(first + i));
    view_->first_hits(*embree_, n, places, hits);
    for (int i = 0; i < n; ++i) {
      const bool before_near = view_->clipped(hits[i], places[i]);
      clipped |= before_near;
      store(first + i, FirstHit(hits[i], before_near));
    }
    if (clipped) std::atomic_ref(any_clipped_).store(true, std::memory_order_relaxed);
  });
}

void TexelRays::trace() {
  for (int y = 0; y < wanted_.height; ++y)
    for (int x = 0; x < wanted_.width; ++x)
      if (wanted_.at(x, y)) inside_texels_.push_back({x, y});
  inside_ = Image<FirstHit>(wanted_.width, wanted_.height);
  wanted_ = {};
  first_hits(
      inside_texels_.size(), [&](size_t i) { return inside_texels_[i]; },
      [&](size_t i, FirstHit hit) { inside_.at(inside_texels_[i].x, inside_texels_[i].y) = hit; });

  outside_.resize(outside_keys_.size());
  first_hits(
      outside_keys_.size(), [&](size_t i) { return texel_of(outside_keys_[i]); },
      [&](size_t i, FirstHit hit) {
        outside_[i] = {outside_keys_[i], hit};
      });
  std::vector<uint64_t>().swap(outside_keys_);
}

const TexelRays::FirstHit& TexelRays::outside_hit(glm::ivec2 texel) const {
  static const FirstHit not_asked_for;
  const uint64_t key = texel_key(texel);
  const auto found = std::lower_bound(outside_.begin(), outside_.end(), key,
                                      [](const auto& entry, uint64_t wanted) { return entry.first < wanted; });
  return found != outside_.end() && found->first == key ? found->second : not_asked_for;
}

}  // namespace noonmark
