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
    : embree_(&embree), view_(&view), wrap_(wrap), wanted_(std::make_shared<TexelSet>(view.frame().map_size())) {
  assert(view.scene().triangles.size() < no_primitive >> 1);
}

void TexelRays::ask(const Image<uint8_t>& facing, const LookupProbe& probe, PixelRange pixels) {
  const glm::ivec2 size = wanted_->size();
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
                          if (read.x >= 0) wanted_->add(read);
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

void TexelRays::first_hits(int count, const glm::dvec3* places, FirstHit* hits) {
  uint32_t triangles[packet_size];
  view_->first_hits(*embree_, count, places, triangles);
  bool clipped = false;
  for (int i = 0; i < count; ++i) {
    const bool before_near = view_->clipped(triangles[i], places[i]);
    clipped |= before_near;
    hits[i] = FirstHit(triangles[i], before_near);
  }
  if (clipped) std::atomic_ref(any_clipped_).store(true, std::memory_order_relaxed);
}

void TexelRays::each_packet_inside(const auto& visit) const {
  tbb::parallel_for(size_t{0}, texels_->tiles(), [&](size_t tile) {
    glm::dvec3 places[packet_size];
    size_t first = texels_->first(tile);
    int count = 0;
    const auto flush = [&] {
      if (count > 0) visit(count, first, places);
      first += static_cast<size_t>(count);
      count = 0;
    };
    for (int row = 0; row < TexelSet::side; ++row)
      for (uint64_t bits = texels_->bits(tile, row); bits; bits &= bits - 1) {
        places[count++] = view_->texel_place(texels_->origin(tile) + glm::ivec2(std::countr_zero(bits), row));
        if (count == packet_size) flush();
      }
    flush();
  });
}

void TexelRays::each_inside(const std::function<void(int, size_t, const glm::dvec3*, const uint32_t*)>& visit) const {
  each_packet_inside([&](int count, size_t first, const glm::dvec3* places) {
    uint32_t hits[packet_size];
    for (int i = 0; i < count; ++i) hits[i] = inside_[first + static_cast<size_t>(i)].triangle();
    visit(count, first, places, hits);
  });
}

void TexelRays::trace() {
  wanted_->close();
  texels_ = std::move(wanted_);
  inside_.resize(texels_->count());
  each_packet_inside(
      [&](int count, size_t first, const glm::dvec3* places) { first_hits(count, places, &inside_[first]); });

  outside_.resize(outside_keys_.size());
  for_each_packet(outside_keys_.size(), [&](size_t first, int count) {
    glm::dvec3 places[packet_size];
    FirstHit hits[packet_size];
    for (int i = 0; i < count; ++i)
      places[i] = view_->texel_place(texel_of(outside_keys_[first + static_cast<size_t>(i)]));
    first_hits(count, places, hits);
    for (int i = 0; i < count; ++i) {
      const size_t at = first + static_cast<size_t>(i);
      outside_[at] = {outside_keys_[at], hits[i]};
    }
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
