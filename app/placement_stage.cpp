#include "app/placement_stage.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

namespace noonmark {
namespace {

// The lattice points that are held at a time. One takes 9 bytes and a share of its tile.
constexpr size_t most_points = size_t{1} << 23;

// Positions in the map at the placements (i, i); OpenGL itself computes them.
std::vector<Image<glm::vec2>> positions_of(gl::Renderer& renderer, const Placements& placements,
                                           const LookupProbe& probe, const PointSetup& point) {
  std::vector<Image<glm::vec2>> positions = {probe.map_texels};
  for (int i = 1; i < placements.side(); ++i)
    positions.push_back(
        renderer.probe(placements.frame(point.frame, i * placements.side() + i), point.settings).map_texels);
  return positions;
}

}  // namespace

PlacementStage::PlacementStage(gl::Renderer& renderer, const raytrace::Tracer& tracer, const LookupProbe& probe,
                               const ViewStage& view, const TruthStage& truth, const PointSetup& point,
                               const BiasPart* part, std::vector<float> edges)
    : placements_(point.settings.map.placements),
      frame_(point.frame),
      truth_(truth.receivers),
      map_(point.settings.map),
      bias_(point.settings.bias),
      probe_(placements_, probe, positions_of(renderer, placements_, probe, point)),
      rays_(tracer.placements(view.receivers, truth.receivers, point.frame, placements_, point.settings.map,
                              Bias(point.settings.bias), polygon_offset_unit(renderer, point.settings))),
      counts_(placements_, probe, part, std::move(edges)) {}

template <class Visit>
void PlacementStage::in_parts(PixelRange strip, size_t points, const Visit& visit) const {
  const size_t pixels = std::max<size_t>(1, most_points / (points * static_cast<size_t>(probe_.probe().taps())));
  for (size_t first = strip.first; first < strip.end; first += pixels)
    visit(PixelRange{first, std::min(strip.end, first + pixels)});
}

void PlacementStage::add(const TapTruth& known, PixelRange strip) {
  const PlacementEvidence evidence{truth_, probe_.probe(), known, map_, bias_, frame_.map_size()};
  in_parts(strip, static_cast<size_t>(placements_.count()), [&](PixelRange part) {
    rays_.trace(probe_, part, &time_);
    // The same partition on any machine, so that the sums of weights are too.
    struct Body {
      const PlacementStage& stage;
      const PlacementEvidence& evidence;
      PlacementCounts counts;
      Body(const PlacementStage& s, const PlacementEvidence& e)
          : stage(s), evidence(e), counts(s.counts_.empty_copy()) {}
      Body(Body& other, tbb::split) : Body(other.stage, other.evidence) {}
      void operator()(const tbb::blocked_range<size_t>& range) {
        PlacedTaps taps;
        LatticeBox box;
        for (size_t i = range.begin(); i != range.end(); ++i) {
          if (!stage.truth_.facing[i]) continue;
          stage.probe_.taps_of(i, taps);
          stage.rays_.judge(i, taps, box);
          counts.add(evidence, i, taps, box);
        }
      }
      void join(const Body& other) { counts.add(other.counts); }
    } body(*this, evidence);
    tbb::parallel_deterministic_reduce(
        tbb::blocked_range<size_t>(part.first, part.end, std::max<size_t>(1, part.size() / 16)), body);
    counts_.add(body.counts);
  });
}

void PlacementStage::compare(const LookupEvidence& evidence, int placement, PixelRange strip) {
  in_parts(strip, 1, [&](PixelRange part) {
    rays_.trace(probe_, part, &time_, placement);
    disagreements_ += tbb::parallel_reduce(
        tbb::blocked_range<size_t>(part.first, part.end, 8192), uint64_t{0},
        [&](const tbb::blocked_range<size_t>& range, uint64_t found) {
          PlacedTaps taps;
          LatticeBox box;
          for (size_t i = range.begin(); i != range.end(); ++i) {
            if (!truth_.facing[i]) continue;
            probe_.taps_of(i, placement, taps);
            rays_.judge(i, taps, box);
            found += noonmark::disagreements(evidence, i, taps, box);
          }
          return found;
        },
        std::plus<>());
  });
}

}  // namespace noonmark
