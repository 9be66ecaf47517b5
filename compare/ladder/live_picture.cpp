#include "compare/ladder/live_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

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
  struct Part {  // memory that is used again
    std::vector<float> on_exact_map, on_stored_map, changes;
    std::vector<LiveAnswer> answers;
    Climb::Part residuals;
  };
  Answers(LivePicture& picture, const LookupEvidence& evidence, const MapDepths& stored_map, const BiasPart& varied,
          PixelRange strip)
      : picture_(picture),
        e_(evidence),
        stored_map_(stored_map),
        varied_(varied),
        ladder_(empty_ladder(picture.flags.width, picture.flags.height)),
        climb_(evidence, strip, ladder_) {}

  void receiver(size_t i, const ReceiverTaps& taps, Part& part) const {
    const TapThreshold threshold(e_.probe, e_.bias, varied_, i);
    part.on_exact_map.clear(), part.on_stored_map.clear();
    for (size_t t = 0; t < taps.size(); ++t) {
      add(threshold(taps[t]), part.on_exact_map);
      add(threshold(stored(taps, t)), part.on_stored_map);
    }
    std::sort(part.on_exact_map.begin(), part.on_exact_map.end());
    std::sort(part.on_stored_map.begin(), part.on_stored_map.end());
    part.changes.assign(1, 0);
    std::merge(part.on_exact_map.begin(), part.on_exact_map.end(), part.on_stored_map.begin(), part.on_stored_map.end(),
               std::back_inserter(part.changes));
    part.changes.erase(std::unique(part.changes.begin(), part.changes.end()), part.changes.end());
    part.answers.clear();
    size_t on_exact = 0, shown = 0;  // lit taps
    for (const float amount : part.changes) {
      while (on_exact < part.on_exact_map.size() && part.on_exact_map[on_exact] <= amount) ++on_exact;
      while (shown < part.on_stored_map.size() && part.on_stored_map[shown] <= amount) ++shown;
      const LiveAnswer answer = answer_at(amount, threshold.bias_at(amount), {on_exact, shown}, i, taps, part);
      const auto same = [&](const LiveAnswer& a) {
        return a.lit == answer.lit && a.cause == answer.cause && a.acne == answer.acne &&
               a.peter_panning == answer.peter_panning;
      };
      if (part.answers.empty() || !same(part.answers.back())) part.answers.push_back(answer);
    }
    picture_.answers[i].assign(part.answers.begin(), part.answers.end());
  }
  void join(const Part&) {}
  void end_batch() const {}

 private:
  struct Lit {
    size_t on_exact_map, shown;
  };
  Tap stored(const ReceiverTaps& taps, size_t t) const { return taps.on(stored_map_, e_.map.format, t); }
  static void add(float threshold, std::vector<float>& thresholds) {
    if (std::isfinite(threshold)) thresholds.push_back(threshold);
  }

  // The ladder itself says what the causes are. R4 and R5 are given to it as OpenGL's lookup computes them: the lit
  // taps, divided once by their number in float.
  LiveAnswer answer_at(float amount, float bias, Lit lit, size_t i, const ReceiverTaps& taps, Part& part) const {
    const auto whole = static_cast<float>(taps.size());
    const float r4 = static_cast<float>(lit.on_exact_map) / whole, r5 = static_cast<float>(lit.shown) / whole;
    climb_.receiver(i, taps, {bias, r4, r5}, part.residuals);
    const auto taps_of = [&](Cause cause) {
      return static_cast<uint8_t>(std::lround(std::abs(ladder_[cause][i]) * whole));
    };
    return {amount, static_cast<uint8_t>(lit.shown), ladder_.cause[i], taps_of(Cause::acne),
            taps_of(Cause::peter_panning)};
  }

  LivePicture& picture_;
  const LookupEvidence& e_;
  const MapDepths& stored_map_;
  const BiasPart& varied_;
  Ladder ladder_;
  Climb climb_;
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
  const TapPattern pattern = tap_pattern(settings);
  if (pattern.blurred) return fmt::format("lookup.kind = {} compares no depths", settings.lookup.kind);
  if (pattern.bilinear()) return "a sampler blends the filter's taps, and how it rounds their weights is not specified";
  if (pattern.taps > most_live_taps) return fmt::format("the filter has more than {} taps", most_live_taps);
  if (mixes_maps(settings)) return "cascades.blend mixes the answers of two maps in a pixel";
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
                    const BiasPart& varied, PixelRange strip) {
  const ReceiverTruth& truth = evidence.truth;
  for (size_t i = strip.first; i < strip.end; ++i) {
    picture.flags[i] |= static_cast<uint8_t>((truth.facing[i] ? live_facing : 0) | (truth.lit[i] != 0 ? live_lit : 0) |
                                             (truth.ambiguous[i] ? live_ambiguous : 0));
    picture.n_dot_l[i] = live_cosine(evidence.probe.n_dot_l[i]);
  }
  Answers answers(picture, evidence, stored_map, varied, strip);
  read_taps(evidence, strip, answers);
}

size_t live_array_bytes(size_t answers, size_t pixels) {
  constexpr size_t of_answer = sizeof(float) + 4 * sizeof(uint8_t), of_pixel = 2 * sizeof(uint8_t) + sizeof(uint16_t);
  return answers * of_answer + pixels * of_pixel;
}

size_t live_array_bytes(const LivePicture& picture) {
  size_t answers = 0;
  for (const std::vector<LiveAnswer>& of : picture.answers) answers += of.size();
  return live_array_bytes(answers, picture.answers.size());
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
