#include "compare/ladder/live_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "compare/ladder/live_arrays.h"
#include "compare/ladder/receiver_taps.h"
#include "compare/ladder/tap_threshold.h"
#include "technique/tap_pattern.h"

namespace noonmark {
namespace {

// Climbs each receiver at each of its thresholds, as a judge of read_taps. A thread writes only the pixels that it
// reads, so the threads share the images.
class Answers {
 public:
  struct Part {};
  Answers(LivePicture& picture, const LookupEvidence& evidence, const MapDepths& stored_map, const BiasSettings& bias,
          const BiasPart& varied)
      : picture_(picture),
        e_(evidence),
        stored_map_(stored_map),
        settings_(bias),
        varied_(varied),
        r4_(picture.flags.width, picture.flags.height, 0),
        r5_(r4_),
        ladder_(empty_ladder(picture.flags.width, picture.flags.height)) {}

  void receiver(size_t i, const ReceiverTaps& taps, Part&) const {
    const TapThreshold threshold(e_.probe, e_.bias, varied_, i);
    std::vector<float> changes{0};
    for (size_t t = 0; t < taps.size(); ++t)
      for (const float at : {threshold(taps[t]), threshold(stored(taps, t))})
        if (std::isfinite(at)) changes.push_back(at);
    std::sort(changes.begin(), changes.end());
    changes.erase(std::unique(changes.begin(), changes.end()), changes.end());
    std::vector<LiveAnswer>& answers = picture_.answers[i];
    for (const float bias : changes) {
      const LiveAnswer answer = answer_at(bias, i, taps);
      const auto same = [&](const LiveAnswer& a) {
        return a.lit == answer.lit && a.cause == answer.cause && a.acne == answer.acne &&
               a.peter_panning == answer.peter_panning;
      };
      if (answers.empty() || !same(answers.back())) answers.push_back(answer);
    }
  }
  void join(const Part&) {}
  void end_batch() const {}

 private:
  Tap stored(const ReceiverTaps& taps, size_t t) const { return taps.on(stored_map_, e_.map.format, t); }

  // The ladder itself says what the causes are. R4 and R5 are given to it as OpenGL's lookup computes them: the lit
  // taps, divided once by their number in float.
  LiveAnswer answer_at(float amount, size_t i, const ReceiverTaps& taps) const {
    BiasSettings settings = settings_;
    settings[varied_.name] = amount;
    const Bias bias(settings);
    const float depth = bias.at(e_.probe, i);
    const auto whole = static_cast<float>(taps.size());
    int on_exact_map = 0, shown = 0;
    for (size_t t = 0; t < taps.size(); ++t) {
      on_exact_map += taps[t].lit(depth);
      shown += stored(taps, t).lit(depth);
    }
    r4_[i] = static_cast<float>(on_exact_map) / whole;
    r5_[i] = static_cast<float>(shown) / whole;
    const LookupEvidence evidence{e_.truth, e_.probe, e_.taps, e_.exact_map, e_.map, bias, r4_, r5_};
    Climb::Part residuals;
    Climb(evidence, {i, i + 1}, ladder_).receiver(i, taps, residuals);
    const auto taps_of = [&](Cause cause) {
      return static_cast<uint8_t>(std::lround(std::abs(ladder_[cause][i]) * whole));
    };
    return {amount, static_cast<uint8_t>(shown), ladder_.cause[i], taps_of(Cause::acne), taps_of(Cause::peter_panning)};
  }

  LivePicture& picture_;
  const LookupEvidence& e_;
  const MapDepths& stored_map_;
  const BiasSettings& settings_;
  const BiasPart& varied_;
  mutable Image<float> r4_, r5_;
  mutable Ladder ladder_;
};

std::string head_of(const LivePicture& picture, size_t answers) {
  return live_head({{"kind", "thresholds"},
                    {"width", picture.flags.width},
                    {"height", picture.flags.height},
                    {"taps", picture.taps},
                    {"answers", answers},
                    {"parameter", picture.parameter},
                    {"unit", picture.unit},
                    {"depth_per_unit", picture.scale.depth_per_unit},
                    {"m_per_depth", picture.scale.m_per_depth},
                    {"texels_per_depth", picture.scale.texels_per_depth}});
}

}  // namespace

std::string why_no_live_picture(const Settings& settings) {
  if (!curve_part(settings.bias)) {
    for (const BiasPart& part : bias_parts())
      if (settings.bias[part.name] != 0) return fmt::format("bias.{} {}", part.name, part.no_curve);
  }
  if (reads_moments(settings)) return fmt::format("lookup.kind = {} compares no depths", settings.lookup.kind);
  const TapPattern pattern = tap_pattern(settings);
  if (pattern.bilinear()) return "a sampler blends the filter's taps, and how it rounds their weights is not specified";
  if (pattern.taps > most_live_taps) return fmt::format("the filter has more than {} taps", most_live_taps);
  if (settings.cascades.count > 1 && settings.cascades.blend > 0)
    return "cascades.blend mixes the answers of two maps in a pixel";
  return "";
}

LivePicture empty_live_picture(int width, int height) {
  LivePicture picture;
  picture.flags = Image<uint8_t>(width, height, 0);
  picture.n_dot_l = picture.flags;
  picture.answers.resize(picture.flags.size());
  return picture;
}

void add_live_strip(LivePicture& picture, const LookupEvidence& evidence, const MapDepths& stored_map,
                    const BiasSettings& bias, const BiasPart& varied, PixelRange strip) {
  const ReceiverTruth& truth = evidence.truth;
  for (size_t i = strip.first; i < strip.end; ++i) {
    picture.flags[i] |= static_cast<uint8_t>((truth.facing[i] ? live_facing : 0) | (truth.lit[i] != 0 ? live_lit : 0) |
                                             (truth.ambiguous[i] ? live_ambiguous : 0));
    picture.n_dot_l[i] = live_cosine(evidence.probe.n_dot_l[i]);
  }
  Answers answers(picture, evidence, stored_map, bias, varied);
  read_taps(evidence, strip, answers);
}

std::string live_file(const LivePicture& picture) {
  std::vector<float> from;
  std::vector<uint8_t> lit, cause, acne, peter_panning;
  std::vector<uint16_t> count;  // at most 2 * most_live_taps + 1
  for (const std::vector<LiveAnswer>& answers : picture.answers) {
    count.push_back(static_cast<uint16_t>(answers.size()));
    for (const LiveAnswer& answer : answers) {
      from.push_back(answer.from);
      lit.push_back(answer.lit);
      cause.push_back(answer.cause);
      acne.push_back(answer.acne);
      peter_panning.push_back(answer.peter_panning);
    }
  }
  std::string file = head_of(picture, from.size());
  append_array(file, from);
  for (const std::vector<uint8_t>* values : std::initializer_list<const std::vector<uint8_t>*>{
           &lit, &cause, &acne, &peter_panning, &picture.flags.pixels, &picture.n_dot_l.pixels})
    append_array(file, *values);
  append_array(file, count);
  return file;
}

}  // namespace noonmark
