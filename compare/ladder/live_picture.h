// What OpenGL shows at every bias, and why each pixel is wrong there: for each pixel the biases at which its answer
// changes, and its answer from each of them on. The report's page draws it without OpenGL.
//
//   LivePicture picture = empty_live_picture(width, height);
//   add_live_strip(picture, evidence, stored_map, part, strip);  // for each strip of the picture
//   write_file_atomically("p0003-live.bin", live_file(picture));
//
// A tap's verdict changes only at its threshold (compare/ladder/tap_threshold.h), on the exact map or on the stored
// map. So it is enough to climb the ladder once at each threshold of a pixel. The thresholds are floats, because the
// shader compares floats: a float bias that is compared with them gives the shader's own answer. This holds for
// filters that are means of comparisons. A sampler that blends the taps rounds its weights in a way that no
// specification defines, so such a filter has a stack of pictures in its place (compare/ladder/picture_stack.h).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "compare/ladder/bias_curves.h"
#include "compare/ladder/ladder.h"
#include "compare/ladder/live_file.h"
#include "technique/settings.h"

namespace noonmark {

// The most taps of a filter with a live picture, because numbers of taps are stored in a byte.
inline constexpr int most_live_taps = 255;

// The answer of a pixel from this bias on, up to the next one's.
struct LiveAnswer {
  float from = 0;             // in the parameter's own unit; the first answer of a pixel has 0
  uint8_t lit = 0;            // lit taps at R5
  uint8_t cause = 0;          // a Cause: why the pixel is wrong; 0 if it is right
  uint8_t acne = 0;           // taps with this cause at R4
  uint8_t peter_panning = 0;  // taps with this cause at R4
};

struct LivePicture {
  int taps = 1;                                  // of a receiver
  std::string parameter;                         // "bias.constant": the setting that is varied
  std::string unit;                              // of the parameter: "depth", "m", "texel"
  BiasScale scale;                               // from the parameter to window depth, metres and texels
  Image<uint8_t> flags;                          // LiveFlags
  Image<uint8_t> n_dot_l;                        // live_cosine, for shading alone
  std::vector<std::vector<LiveAnswer>> answers;  // of each pixel; empty unless it faces the light
};

// Bytes of a pixel's answers: one for each threshold, which are two for each tap, in a list that grows by doubling.
inline double live_answer_bytes(double taps) {
  return sizeof(std::vector<LiveAnswer>) + 2 * sizeof(LiveAnswer) * (2 * taps + 1);
}

// Whether the settings have a live picture: part of the bias with a curve, and a filter that is a mean of at most
// most_live_taps comparisons. The reason as a sentence if not; otherwise empty.
std::string why_no_live_picture(const Settings& settings);

LivePicture empty_live_picture(int width, int height);

// Adds the receivers of a strip; of several maps one after the other those of each. evidence: holds the strip's taps; its r4 and r5 are not read. stored_map: the GPU's map
// as its sampler returns it. varied: the part of evidence.bias that varies.
void add_live_strip(LivePicture& picture, const LookupEvidence& evidence, const MapDepths& stored_map,
                    const BiasPart& varied, PixelRange strip);

// The file of a live picture: compare/ladder/live_file.h with these arrays:
//   float from[answers]; uint8 lit[answers], cause[answers], acne[answers], peter_panning[answers];
//   uint8 flags[pixels], n_dot_l[pixels]; uint16 count[pixels]
// count is the number of a pixel's answers. The line has kind ("thresholds"), width, height, taps, answers, parameter,
// unit, depth_per_unit, m_per_depth, texels_per_depth and the names of the causes.
std::string live_file(const LivePicture& picture);

// The bytes of the file's arrays: of so many answers and pixels, and of what a picture has so far. More receivers only add to them.
size_t live_array_bytes(size_t answers, size_t pixels);
size_t live_array_bytes(const LivePicture& picture);

}  // namespace noonmark
