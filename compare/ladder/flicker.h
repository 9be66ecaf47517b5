// Flicker: what changes in R5 from one frame to the next although the truth does not change. Both frames' maps are looked
// up at the same world points, the receivers of the first frame, so no difference between two pictures can look like
// flicker.
//
//   Flicker flicker = flicker_of({now, choice, grid, depth, next}, points);
//   record.metrics.merge(measure_flicker(flicker));
//
// The change is split by lookups that differ in one respect from one to the next, as the ladder's rungs do:
//
//  now     frame 0: its map and its kernel
//  choice  the same, but each point in the cascade that frame 1 chooses                  cascade changed
//  grid    the map of frame 1 with the depth range of frame 0; the kernel of frame 0      grid moved
//  depth   the map of frame 1; the kernel of frame 0                                      depth re-rounded
//  next    frame 1: its map and its kernel                                                kernel turned
//
// A part of the change is booked where it begins to last: the class gets what its step adds to the change that all later
// steps keep. So steps that undo each other are not counted, no class is negative, and the classes of a receiver add up to
// |next - now| exactly. The whole change of a receiver that one of the maps does not hold with all its taps is of a class
// of its own: there the lookup goes from one answer to another because the map's edge passes over it.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "base/image.h"

namespace noonmark {

enum class FlickerClass { cascade, grid, depth, kernel, coverage };
inline constexpr size_t flicker_classes = 5;
inline constexpr size_t flicker_steps = 4;  // the classes that are steps from lookup to lookup

// Bytes of a pixel: four lookups and what is booked of them, which pixels see a receiver and which light reaches it there, and the
// receivers as they are uploaded again.
inline constexpr double flicker_bytes_per_pixel = 90;

// The result of each lookup at the receivers of the first frame, in the order above.
struct FlickerLookups {
  const Image<float>&now, &choice, &grid, &depth, &next;  // with one map choice is now
};

// The points of the world at which flicker is taken: the receivers of the first frame.
struct FlickerPoints {
  // 1: the receiver is seen in both frames, and its truth R1 is the same in both. Only these count.
  Image<uint8_t> counted;
  Image<uint8_t> held;         // 1: both maps hold it, with room for all taps
  uint64_t shared = 0;         // receivers seen in both frames that face the light in both and are not ambiguous
  uint64_t truth_changed = 0;  // those of them whose truth changes
  // Receivers that face the light and are not ambiguous in the first frame, and are not shared. Each is counted once, as
  // the first of: outside the next frame's picture; hidden there, seen from its back, or ambiguous in that; turned away
  // from the next frame's light, or ambiguous there.
  uint64_t outside = 0, hidden = 0, unlit = 0;
  uint64_t ambiguous = 0;  // of hidden and unlit, those of which rounding decides that
};

struct Flicker {
  FlickerPoints points;
  Image<float> now, next;
  std::array<Image<float>, flicker_classes> parts;  // of |next - now|; 0 where nothing is counted
};

// The steps' parts of one receiver's change. Their sum, from the first to the last, is |r[4] - r[0]|.
std::array<double, flicker_steps> flicker_parts(const std::array<double, flicker_steps + 1>& r);

Flicker flicker_of(const FlickerLookups& lookups, FlickerPoints points);

// The metrics flicker, flicker_changed, flicker_cascade, flicker_grid, flicker_depth, flicker_kernel, flicker_coverage, flicker_truth,
// flicker_points, flicker_outside, flicker_hidden, flicker_unlit and flicker_ambiguous.
// Fractions of no points are left out. A lookup that is not finite makes its class not finite.
std::map<std::string, double> measure_flicker(const Flicker& flicker);

// Whether a setting says which frame of a motion a point is. The points that differ in nothing else are one choice.
inline bool names_a_frame(std::string_view setting) { return setting == "motion.frame" || setting == "scene.time_s"; }

}  // namespace noonmark
