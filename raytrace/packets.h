// Work on all cores in runs of one packet.
#pragma once
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

#include "raytrace/embree_scene.h"

namespace noonmark {

// Calls visit(first, n) for consecutive runs of n <= 16 items that cover [0, count).
template <class Visit>
void for_each_packet(size_t count, const Visit& visit) {
  const size_t packets = (count + packet_size - 1) / packet_size;
  tbb::parallel_for(tbb::blocked_range<size_t>(0, packets, 64), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t packet = range.begin(); packet != range.end(); ++packet) {
      const size_t first = packet * packet_size;
      visit(first, static_cast<int>(std::min<size_t>(packet_size, count - first)));
    }
  });
}

}  // namespace noonmark
