// What OpenGL shows at a few values of one part of the bias, or of the light-bleed reduction, and why each pixel is wrong there: a
// stack of pictures, each measured at its value. The report's page shows one of them at a time.
//
//   PictureStack stack = empty_picture_stack(receivers, truth, probe, "bias.normal_offset");
//   for (double value : stack_values(most, as_set, {}, 0)) add_picture(stack, value, measure(value));
//   write_file_atomically("p0003-live.bin", stack_file(stack));
//
// It stands where a picture at every bias (compare/ladder/live_picture.h) would not be exact:
// - A part that moves the lookup or changes the map has no thresholds, because the taps read other texels at each value.
// - A tap that a sampler blends has a threshold, and its weight does not depend on the bias. But the sampler rounds the
//   weights to about 8 bits in a way that no specification defines, and a comparison in a fixed-point map may round the
//   compared depth. So the sum of the weights of the lit taps is only near to what OpenGL shows.
// - A filter of more than most_live_taps taps would need two answers for each of them in each pixel.
// - A lookup that compares no depths has no thresholds. What costs nothing to change there is its reduction.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/ladder/bias_curves.h"
#include "compare/ladder/live_file.h"
#include "scenes/receivers.h"
#include "technique/settings.h"

namespace noonmark {

// The pictures of a stack, at most; a pixel names its picture in a byte.
inline constexpr size_t most_stacked = 13;

// The part of the bias that a stack varies. Null if it varies lookup.reduction instead (has_reduction_curve). It is the part that
// the bias curve varies. If there is no such curve, it is the first part that is not 0.
const BiasPart* stacked_part(const Settings& settings);

// The values of a stack, ascending: 0, the value as set, the marks, and, as far as most_stacked has room, values a factor
// of sqrt(2) apart on both sides of the middle. The middle is the value as set, or the first positive mark if that is 0, or
// else `otherwise`. marks: values that the report speaks of (the recommended one, the ends of the usable window), the most
// important first; those that are not finite or outside 0 ... most, the largest value of the setting, are left out. otherwise:
// above 0.
std::vector<double> stack_values(double most, double as_set, const std::vector<double>& marks, double otherwise);

// The causes whose sizes are told of each picture: of a part of the bias acne and Peter Panning, of the reduction the leak, and
// both that darken.
std::span<const Cause> stack_causes(std::string_view parameter);

struct PictureStack {
  struct Value {
    double value = 0;  // of the setting, in its own unit
    // The metrics of the picture at that value: the error, and the causes that follow the setting (stack_causes).
    double error = 0;
    std::vector<double> causes;
  };
  // The answer of a pixel from the picture of this number on, up to the next answer's.
  struct Answer {
    uint8_t from = 0;   // an index into values; the first answer of a pixel has 0
    uint8_t cause = 0;  // a Cause: why the pixel is wrong; 0 if it is right
    float light = 0;    // R5
  };
  std::string parameter;                     // "bias.normal_offset": the setting that is varied
  std::string why;                           // why there is no picture at every bias: why_no_live_picture()
  std::string unit;                          // of the parameter: "texels", "depth", "m"; "" if it has none
  std::optional<BiasScale> scale;            // of a part of the compared depth: to window depth, metres and texels
  std::vector<Value> values;                 // in the order in which they were added: ascending
  Image<uint8_t> flags;                      // LiveFlags
  Image<uint8_t> n_dot_l;                    // live_cosine
  std::vector<std::vector<Answer>> answers;  // of each pixel; empty unless it faces the light
};

// Bytes of a pixel's answers: one for each picture, in a list that grows by doubling.
inline constexpr double stacked_answer_bytes =
    sizeof(std::vector<PictureStack::Answer>) + 2 * sizeof(PictureStack::Answer) * most_stacked;

// Without a picture. The images have the same size. parameter: what it varies.
PictureStack empty_picture_stack(const ReceiverImage& receivers, const ReceiverTruth& truth, const LookupProbe& probe,
                                 std::string parameter);

// ladder: of the same receivers, without a rung on top of R5.
void add_picture(PictureStack& stack, double value, const Ladder& ladder);

// The file: compare/ladder/live_file.h with these arrays:
//   float light[answers]; uint8 from[answers], cause[answers]; uint8 flags[pixels], n_dot_l[pixels], count[pixels]
// count is the number of a pixel's answers. The line has kind ("stack"), width, height, answers, parameter, unit, why, told
// (the names of stack_causes), values (a list of objects: value, error, and each of these causes; a metric that is not finite is
// null), the names of all causes, and
// for a part of the compared depth depth_per_unit, m_per_depth and texels_per_depth.
std::string stack_file(const PictureStack& stack);

}  // namespace noonmark
