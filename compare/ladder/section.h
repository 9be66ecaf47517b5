// A section through one receiver: the plane that holds the receiver's light ray and the direction in which its surface
// leaves the light the fastest. It holds the numbers from which a drawing shows why the pixel is right or wrong.
//
//   const ReceiverSection section = section_of({scene, receivers, technique, ladder, evidence, stored, stored_rows}, {312, 175});
//   section.taps[section.key_tap].cause       // of the tap that decides
//
// Its axes: s runs along a straight line of the map's image, in texels from the place looked up; depth is what the map
// measures, in metres (along the light's axis; of a point light the distance). Light rays are lines s = const. The
// surfaces are the scene's triangles cut by the plane, exactly. Depths of the lookup are the shader's own numbers, as
// in the ladder.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/ladder/ladder.h"
#include "scenes/receivers.h"
#include "scenes/scene.h"
#include "technique/technique.h"

namespace noonmark {

// One tap of the lookup. Depths are in metres; bias included where it says so.
struct SectionTap {
  int tap = 0;
  glm::ivec2 texel{0};     // that it reads; of a flat map perhaps outside the image
  glm::dvec2 centre{0};    // of that texel, in texels from the place looked up
  double along = 0;        // the same, along the section: s
  double reference_m = 0;  // what it is compared with, before the bias
  double compared_m = 0;   // what is compared: after the bias
  double exact_m = 0;      // the depth at the texel in the exact map
  double stored_m = 0;     // the depth in OpenGL's map
  double threshold_m = 0;  // the bias from which the tap is lit on the exact map; 0: from none on
  double weight = 0;       // a share: the weights of all taps have the sum 1
  bool exact_lit = false;  // F: the truth at the tap's exact place
  bool moved_lit = false;  // D: the truth there, where the lookup is moved
  bool texel_lit = false;  // V: the truth at the texel's centre
  bool lit = false;        // L: the verdict on the exact map, R4
  bool shown_lit = false;  // the verdict on OpenGL's map, R5
  bool inside = true;      // the texel lies in the map
  bool near_clipped = false;
  int tile = 0;           // that it reads: the face of a cube; 0 of a flat map
  bool same_tile = true;  // false: it reads another face of the cube than the place looked up
  Cause cause = Cause::none;
};

// What the line of the section crosses in the map: a texel, or the same place outside the map.
struct SectionColumn {
  glm::ivec2 texel{0};
  double from = 0, to = 0;        // s
  bool inside = true;             // false: outside the map; the lookup wraps, or reads the border
  bool border = false;            // the border's depth 1 is read
  double centre = 0;              // s of the texel's centre, projected onto the section
  double beside = 0;              // distance of the centre from the section, in texels, with a sign
  double stored_m = 0;            // OpenGL's map
  std::optional<double> exact_m;  // empty: no tap of the picture reads this texel
};

// A triangle cut by the plane: two points, or more where the map is no orthographic one, because a straight line is then
// drawn as a curve. (s, depth in metres).
struct SectionLine {
  uint32_t triangle = 0;
  std::vector<glm::dvec2> points;
};

// Of the triangle that the light meets first at the centre of a texel that is in shadow, where the map has no depth before the
// receiver.
struct MissingBlocker {
  std::string part;     // its name
  bool culled = false;  // the map does not draw the triangle
  std::optional<double>
      drawn_m;  // the first depth there of the faces of the part that the map draws; empty: there is none
};

struct ReceiverSection {
  glm::ivec2 pixel{0};
  glm::dvec3 position_m{0}, normal{0, 1, 0};  // of the receiver, in the world
  std::string light;                          // "directional"
  bool axial = true;                          // depth is measured along the light's axis, not as a distance
  int tile = 0;                               // the face of a cube; 0 of a flat map
  int cascade = 0;                            // from 1, the nearest; 0: the point has one map
  double share = 1;                           // of this map in the pixel's result: below 1 in a blend band
  glm::ivec2 map_size{1};
  double near_m = 0, far_m = 1;
  glm::dvec2 place{0};         // looked up, in texels of the map's image
  glm::dvec2 direction{1, 0};  // of the section in that image; unit
  bool has_slope = true;       // false: the surface faces the light, and the direction is the map's first axis
  glm::dvec2 gradient_m{0};    // of the receiver's plane: metres of depth per texel
  double texel_m = 0;          // width of a texel at the place looked up
  double reach = 0;            // the section shows -reach <= s <= reach, in texels
  double receiver_s = 0, receiver_m = 0;  // the receiver; it differs from the place looked up where the lookup is moved
  double reference_m = 0, bias_m = 0, bias_depth = 0;
  bool moved = false;  // the lookup is moved (normal offset)
  double moved_m = 0;  // by this length
  bool beyond_far = false;
  bool casters_moved = false;                                    // the map is drawn from moved or offset casters
  float soft_truth = 0, truth = 0, on_exact_map = 0, shown = 0;  // R0, R1, R4, R5; the latter two of this map alone
  bool ambiguous = false;              // float error changes R1, so it is not known whether the pixel is right
  Cause cause = Cause::none;           // of the pixel, as the ladder names it
  std::vector<SectionColumn> columns;  // by s
  std::vector<SectionTap> taps;        // in the order of the pattern
  Cause largest = Cause::none;         // the same, unless explain() made `cause` another one
  size_t key_tap = 0;                  // the tap that explains the pixel
  // Of the tap that explains its Peter Panning; empty without one, and where the map stores a depth before the receiver.
  std::optional<MissingBlocker> missing;
  std::vector<SectionLine> surfaces;
  std::optional<double>
      blocker_m;  // a surface between the light and the receiver on its ray: the nearest to the receiver
};

struct SectionInput {
  const Scene& scene;
  const ReceiverImage& receivers;
  const Technique& technique;
  const Ladder& ladder;
  const LookupEvidence& evidence;                            // holds the taps of the pixel
  const MapDepths& stored;                                   // OpenGL's map at the texels that taps read
  const std::function<Image<float>(int, int)>& stored_rows;  // rows of the whole of it: (first, number)
  double share = 1;                                          // of this map in the pixel's result
};

// The pixels of a measured picture whose sections explain it: the one with the largest error, and of each cause the one with
// the largest part of it. Each once; those without a section (section_of) are left out.
// probe_of: the probe of the map that a pixel's receiver is looked up in.
using ProbeOf = std::function<const LookupProbe&(size_t)>;
std::vector<glm::ivec2> section_pixels(const PointRecord& record, const Ladder& ladder, const ProbeOf& probe_of);

// The pixel that stands for a cause, one of Ladder::causes: deepest in the largest patch (compare/ladder/wrong_patch.h) of the counted
// pixels that have most of it. in_all: of those whose largest part it is, however large. Empty if no pixel with a section has any.
std::optional<glm::ivec2> typical_pixel(const Ladder& ladder, size_t cause, bool in_all, const ProbeOf& probe_of);

// Throws Error(usage) if the pixel lies outside the picture, shows no surface, or shows one that faces away from the
// light, and if the lookup reads no map there. Throws Error(defect) if a number of it is not finite.
ReceiverSection section_of(const SectionInput& input, glm::ivec2 pixel);

// Makes the section explain this cause, if one of its taps has it, in place of the cause of the pixel's largest part.
void explain(ReceiverSection& section, Cause cause);

}  // namespace noonmark
