// Whether the visibility is that of the frame's own pixels, or of a picture that was flipped or shifted beside its receivers.
// No shadow is moved to make it fit: a flip is seen in the whole picture, and a shift of a pixel where the visibility has no
// surface, or where one surface hides another that has a different truth.
//
//   const std::optional<SurfaceAlignment> found = surface_alignment(frame);
//   if (found && found->flip) print(found->flip->says);
#pragma once
#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <optional>

#include "frames/checks.h"
#include "frames/frame.h"
#include "technique/evidence.h"

namespace noonmark {

struct PictureFlip {
  bool left_to_right = false, upside_down = false;
  const char* says = "";  // "flipped left to right"
};
inline constexpr std::array<PictureFlip, 3> flips{{
    {true, false, "flipped left to right"},
    {false, true, "flipped upside down"},
    {true, true, "turned by 180 degrees"},
}};

// By the pixels that have no surface: the visibility's own (-1, NaN, alpha 0) and those of the given receivers.
struct SurfaceAlignment {
  size_t differing = 0;               // pixels where only one of both has a surface
  const PictureFlip* flip = nullptr;  // leaves less than a tenth of them
  glm::ivec2 shift{0};  // of one pixel at most; leaves less than three tenths of them. x to the right, y down
  size_t left = 0;      // what the flip or the shift leaves
  bool misplaced() const { return flip || shift != glm::ivec2(0); }
};
// Empty if the visibility or the receivers have a surface nowhere or everywhere, or no receivers are given.
std::optional<SurfaceAlignment> surface_alignment(const GivenFrame& frame);

// By the values, of all receivers that face the light and whose truth is firm.
struct ValueAlignment {
  // The mean |visibility - R0| as delivered and with the flip, over the pixels that have a visibility both ways.
  struct Compared {
    size_t count = 0;
    double delivered = 0, flipped = 0;
  };
  std::array<Compared, flips.size()> by_flip;
  // The flip with which the visibility differs from the truth by less than a third, or null. A light that is mirrored in a
  // scene that is symmetric looks the same.
  const PictureFlip* flip() const;
};
ValueAlignment value_alignment(const GivenFrame& frame, const ReceiverTruth& truth);

// By the outlines of surfaces in the picture where a lit and a shadowed one meet that lie apart in depth, with no true edge of
// either within `outline_reach_px` on it, seen or hidden. Such a change lies at the outline whatever bias, map and filter do, because the
// lookup knows nothing of the camera. A picture that is shifted has it a pixel further: then the surfaces on one side of such
// outlines show the truth of the other, lit ones and dark ones alike, and those on the other side do not. A leak
// along an outline makes dark surfaces lit, but no lit ones dark.
struct OutlineAlignment {
  static constexpr int outline_reach_px = 3, inside_px = 3;
  static constexpr double apart_px = 4;  // the least distance from each other's plane, in widths of a pixel
  static constexpr size_t enough = 20;   // of each kind of pixel on each side
  static constexpr double mostly = 0.7, rarely = 0.3;
  struct Side {
    size_t lit = 0, dark = 0;              // pixels whose neighbour on this side is the other surface
    double lit_wrong = 0, dark_wrong = 0;  // their mean |visibility - R0|
    // Of those behind which, away from the outline, the same surface goes on: how much darker the lit ones are than the pixel
    // `inside_px` behind them, and how much lighter the dark ones, in the mean.
    size_t lit_inside = 0, dark_inside = 0;
    double lit_pull = 0, dark_pull = 0;
    // The same of the next pixel, one further from the outline. What mixes the samples of a pixel ends there; a map's filter over wide
    // texels goes on.
    double lit_next = 0, dark_next = 0;
    // Whether both are pulled, by more than this, and the next pixels by less than half as much.
    bool mixed(double least) const {
      return lit_pull > least && dark_pull > least && lit_next < lit_pull / 2 && dark_next < dark_pull / 2;
    }
    // Outlines whose lit side is brighter than the dark one by more than a half, at `inside_px` behind both; and on how many of them
    // the step at the outline itself is less than half of that, and the middle of its two values less than a quarter of that off.
    // To a lookup, which knows nothing of the camera, the two sides are two places. A blur of the picture makes ramps.
    size_t steps = 0, ramps = 0;
    bool told() const { return lit >= enough && dark >= enough; }
    bool of_neighbour() const { return lit_wrong > mostly && dark_wrong > mostly; }
    bool of_itself() const { return lit_wrong < rarely && dark_wrong < rarely; }
  };
  Side left, right, above, below;
  bool told_x() const { return left.told() && right.told(); }
  bool told_y() const { return above.told() && below.told(); }
  // The more blurred of left and right, and above and below. A blur by motion has one direction.
  struct Ramps {
    size_t steps = 0, ramps = 0;
    // Filters over wide texels and blurred moments make ramps of at most a tenth of the steps. A blur over 5 pixels makes them of
    // more than a half, except where the acne of single pixels is blurred with them.
    bool of_blur() const { return steps >= enough && 2 * ramps >= steps; }
  };
  Ramps ramps() const;
  // All sides together.
  Side all() const;
  // x to the right, y down, of a pixel or a few; 0 along an axis that is not told.
  glm::ivec2 shift() const;
};
OutlineAlignment outline_alignment(const CheckEvidence& evidence);

// The width of a pixel at each receiver, across the view, in metres; 0 without a receiver.
Image<float> pixel_width_m(const ViewMatrix& view, const ReceiverImage& receivers);

}  // namespace noonmark
