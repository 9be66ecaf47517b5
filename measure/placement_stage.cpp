#include "measure/placement_stage.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

namespace noonmark {
namespace {

// The lattice points that are held at a time. One takes 9 bytes and a share of its tile.
constexpr size_t most_points = size_t{1} << 23;

// Positions in the map at the placements (i, i); OpenGL itself computes them.
std::vector<Image<glm::vec2>> positions_of(gl::Renderer& renderer, const Placements& placements,
                                           const LookupProbe& probe, const Technique& technique) {
  std::vector<Image<glm::vec2>> positions = {probe.map_texels};
  for (int i = 1; i < placements.side(); ++i)
    positions.push_back(
        renderer.probe(technique.at(placements.frame(technique.frame, i * placements.side() + i))).map_texels);
  return positions;
}

}  // namespace

std::unique_ptr<PlacementStage> make_placement_stage(const PlacementInput& in, const BiasPart* part,
                                                     std::vector<float> edges) {
  if (in.technique.frame.light().placements_form_lattice())
    return std::make_unique<LatticeStage>(in.renderer, in.tracer, in.probe, in.view, in.truth, in.technique, part,
                                          std::move(edges));
  return std::make_unique<TurnStage>(in, part, std::move(edges));
}

LatticeStage::LatticeStage(gl::Renderer& renderer, const raytrace::Tracer& tracer, const LookupProbe& probe,
                           const ViewStage& view, const TruthStage& truth, const Technique& technique,
                           const BiasPart* part, std::vector<float> edges)
    : PlacementStage(technique.frame,
                     PlacementCounts(Placements(technique.settings.map.placements), probe, part, std::move(edges))),
      truth_(truth.receivers),
      map_(technique.settings.map),
      bias_(technique.bias),
      probe_(counts_.placements(), probe, positions_of(renderer, counts_.placements(), probe, technique)),
      rays_(tracer.placements(view.receivers, truth.receivers, technique.frame, counts_.placements(),
                              technique.settings.map, technique.bias, polygon_offset_unit(renderer, technique))) {}

template <class Visit>
void LatticeStage::in_parts(PixelRange strip, size_t points, const Visit& visit) const {
  const size_t pixels = std::max<size_t>(1, most_points / (points * static_cast<size_t>(probe_.probe().taps())));
  for (size_t first = strip.first; first < strip.end; first += pixels)
    visit(PixelRange{first, std::min(strip.end, first + pixels)});
}

void LatticeStage::add(const TapTruth& known, PixelRange strip) {
  const PlacementEvidence evidence{truth_, probe_.probe(), known, map_, bias_, frame_.map_size()};
  in_parts(strip, static_cast<size_t>(counts_.placements().count()), [&](PixelRange part) {
    rays_.trace(probe_, part, &time_);
    // The same partition on any machine, so that the sums of weights are too.
    struct Body {
      const LatticeStage& stage;
      const PlacementEvidence& evidence;
      PlacementCounts counts;
      Body(const LatticeStage& s, const PlacementEvidence& e) : stage(s), evidence(e), counts(s.counts_.empty_copy()) {}
      Body(Body& other, tbb::split) : Body(other.stage, other.evidence) {}
      void operator()(const tbb::blocked_range<size_t>& range) {
        PlacedTaps taps;
        LatticeBox box;
        for (size_t i = range.begin(); i != range.end(); ++i) {
          if (!stage.truth_.facing[i] || stage.truth_.share_of(i) == 0) continue;
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

void LatticeStage::compare(const LookupEvidence& evidence, int placement, PixelRange strip) {
  const raytrace::PlacementTracer::RayError error = rays_.ray_error();
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
            found += noonmark::disagreements(evidence, i, taps, box, error.everywhere ? error.depth : 0, error.depth,
                                             [&](glm::ivec2 point) { return rays_.on_edge(point); });
          }
          return found;
        },
        std::plus<>());
  });
}

TurnStage::TurnStage(const PlacementInput& input, const BiasPart* part, std::vector<float> edges)
    : PlacementStage(input.technique.frame, PlacementCounts(Placements(input.technique.settings.map.placements),
                                                            input.probe, part, std::move(edges))),
      in_(input),
      first_(counts_.empty_copy_of_one()) {}

void TurnStage::add(const LookupEvidence& evidence, PixelRange strip) { count(evidence, strip, first_); }

void TurnStage::finish() {
  if (first_.receivers() == 0) return;  // nothing can be judged
  counts_.put(0, first_);
  for (int placement = 1; placement < counts_.placements().count(); ++placement) {
    const Technique turned = in_.technique.at(frame(placement));
    LookupStage lookup = in_.stages.prepare_lookup(in_.renderer, in_.tracer, in_.view, in_.truth, turned);
    PlacementCounts one = counts_.empty_copy_of_one();
    each_strip_of(in_.renderer, lookup, in_.truth, turned,
                  [&](const LookupEvidence& evidence, PixelRange strip) { count(evidence, strip, one); });
    counts_.put(placement, one);
    for (const StageTime& stage : {lookup.texel_stage, lookup.tap_stage}) {
      time_.milliseconds += stage.milliseconds;
      time_.rays += stage.rays;
    }
  }
}

void TurnStage::compare(const LookupEvidence& evidence, int placement, PixelRange strip) {
  if (!again_ || compared_ != placement) again_.emplace(counts_.empty_copy_of_one());
  compared_ = placement;
  count(evidence, strip, *again_);
}

void TurnStage::count(const LookupEvidence& evidence, PixelRange strip, PlacementCounts& one) const {
  struct Body {
    const LookupEvidence& evidence;
    PlacementCounts counts;
    Body(const LookupEvidence& e, const PlacementCounts& like) : evidence(e), counts(like.empty_copy()) {}
    Body(Body& other, tbb::split) : Body(other.evidence, other.counts) {}
    void operator()(const tbb::blocked_range<size_t>& range) {
      for (size_t i = range.begin(); i != range.end(); ++i)
        if (evidence.truth.facing[i]) counts.add(evidence, i);
    }
    void join(const Body& other) { counts.add(other.counts); }
  } body(evidence, one);
  // The same partition on any machine, so that the sums of weights are too.
  tbb::parallel_deterministic_reduce(
      tbb::blocked_range<size_t>(strip.first, strip.end, std::max<size_t>(1, strip.size() / 16)), body);
  one.add(body.counts);
}

}  // namespace noonmark
