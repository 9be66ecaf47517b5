#include "measure/placement_stage.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <type_traits>

#include "compare/ladder/moment_counts.h"

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
        renderer.map_positions(technique.at(placements.frame(technique.frame, i * placements.side() + i))));
  return positions;
}

// Each placement is measured by itself, with a probe, an exact map and a truth of the taps of its own. Counts: PlacementCounts
// or MomentCounts.
template <class Counts>
class OneByOneStage final : public PlacementStage {
 public:
  OneByOneStage(const PlacementInput& input, Counts counts)
      : PlacementStage(input.technique.frame),
        in_(input),
        counts_(std::move(counts)),
        first_(counts_.empty_copy_of_one()) {}

  void add(const LookupEvidence& evidence, PixelRange strip) override { count(evidence, strip, first_); }

  void finish() override {
    if (first_.receivers() == 0) return;  // nothing can be judged
    counts_.put(0, std::move(first_));
    for (int placement = 1; placement < placements().count(); ++placement) {
      const Technique placed = in_.technique.at(frame(placement));
      LookupStage lookup = in_.stages.prepare_lookup(in_.renderer, in_.tracer, in_.view, in_.truth, placed);
      Counts one = counts_.empty_copy_of_one();
      each_strip_of(in_.renderer, lookup, in_.truth, placed,
                    [&](const LookupEvidence& evidence, PixelRange strip) { count(evidence, strip, one); });
      counts_.put(placement, std::move(one));
      for (const StageTime& stage : {lookup.texel_stage, lookup.tap_stage}) {
        time_.milliseconds += stage.milliseconds;
        time_.rays += stage.rays;
      }
    }
  }

  void compare(const LookupEvidence& evidence, int placement, PixelRange strip) override {
    if (!again_ || compared_ != placement) again_.emplace(counts_.empty_copy_of_one());
    compared_ = placement;
    count(evidence, strip, *again_);
  }

  uint64_t disagreements() const override { return again_ ? counts_.disagreements(compared_, *again_) : 0; }
  const Placements& placements() const override { return counts_.placements(); }
  PlacementShares shares() const override { return counts_.shares(); }
  double receivers() const override { return counts_.receivers(); }
  const PlacementCounts* counts() const override {
    if constexpr (std::is_same_v<Counts, PlacementCounts>) return &counts_;
    return nullptr;
  }
  std::optional<ReductionWindow::Window> reductions() const override {
    if constexpr (std::is_same_v<Counts, MomentCounts>) return counts_.usable();
    return std::nullopt;
  }

 private:
  // Adds a strip of one placement.
  static void count(const LookupEvidence& evidence, PixelRange strip, Counts& one) {
    struct Body {
      const LookupEvidence& evidence;
      Counts counts;
      Body(const LookupEvidence& e, const Counts& like) : evidence(e), counts(like.empty_copy()) {}
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

  PlacementInput in_;
  Counts counts_;
  Counts first_;                 // of placement 0
  std::optional<Counts> again_;  // of the placement that is compared
  int compared_ = 0;
};

}  // namespace

std::unique_ptr<PlacementStage> make_placement_stage(const PlacementInput& in, PlacementRequest request) {
  const Placements placements(in.technique.settings.map.placements);
  if (in.technique.moments)
    return std::make_unique<OneByOneStage<MomentCounts>>(in, MomentCounts(placements, request.reductions));
  if (in.technique.frame.light().placements_form_lattice())
    return std::make_unique<LatticeStage>(in.renderer, in.tracer, in.probe, in.view, in.truth, in.technique,
                                          std::move(request));
  return std::make_unique<OneByOneStage<PlacementCounts>>(
      in, PlacementCounts(placements, in.probe, request.part, std::move(request.edges)));
}

LatticeStage::LatticeStage(gl::Renderer& renderer, const raytrace::Tracer& tracer, const LookupProbe& probe,
                           const ViewStage& view, const TruthStage& truth, const Technique& technique,
                           PlacementRequest request)
    : PlacementStage(technique.frame),
      checks_(request.checks),
      counts_(Placements(technique.settings.map.placements), probe, request.part, std::move(request.edges)),
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

}  // namespace noonmark
