#include "compare/report/section_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"
#include "compare/report/cause_colors.h"
#include "compare/results/number_text.h"
#include "technique/light_kind.h"

namespace noonmark::report {
namespace {

// In the order of a cube's tiles (technique/light_frame.h).
constexpr const char* face_names[] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

// Of a cube with its face, and counted in that face: the faces stand one above the other in the map's image.
std::string texel_text(const ReceiverSection& section, const SectionTap& tap) {
  if (section.light != kind_of_light(LightKind::point).name())
    return fmt::format("texel ({}, {})", tap.texel.x, tap.texel.y);
  return fmt::format("texel ({}, {}) of the cube's face {}", tap.texel.x, tap.texel.y - tap.tile * section.map_size.x,
                     face_names[tap.tile]);
}

std::string away_text(const ReceiverSection& section, const SectionTap& tap) {
  return fmt::format("{} from the {}", quantity_text(glm::length(tap.centre), "texels", 2),
                     section.moved ? "place looked up" : "receiver");
}

// "3.1 mm nearer to the light than", "2 m farther from the light than".
std::string nearer_text(double depth_m, double than_m) {
  return depth_m < than_m ? fmt::format("{} nearer to the light than", length_text(than_m - depth_m))
                          : fmt::format("{} farther from the light than", length_text(depth_m - than_m));
}

// Of what the texel's depth is nearer than the receiver's, the larger part: the way on the receiver's plane to the centre, or what the
// casters were moved.
std::string why_nearer(const ReceiverSection& section, const SectionTap& tap) {
  const double plane_m = tap.reference_m + glm::dot(section.gradient_m, tap.centre);
  if (section.casters_moved && plane_m - tap.exact_m > tap.reference_m - plane_m)
    return fmt::format("casters are moved or offset before the map is drawn, which stores the surface {} where it is",
                       nearer_text(tap.exact_m, plane_m));
  return "one depth stands for the whole texel";
}

std::string acne_text(const ReceiverSection& section, const SectionTap& tap) {
  return fmt::format(
      "The exact map stores in {} a depth {} the compared depth. The texel's centre is {}, and no shadow edge lies "
      "between them: the surface shadows itself, because {}. {} more bias would light the tap.",
      texel_text(section, tap), nearer_text(tap.exact_m, tap.compared_m), away_text(section, tap),
      why_nearer(section, tap), length_text(tap.compared_m - tap.exact_m));
}

std::string panning_text(const ReceiverSection& section, const SectionTap& tap) {
  std::string text = fmt::format(
      "The centre of {} is in shadow, but the exact map stores a depth {} the compared depth, so light shows. ",
      texel_text(section, tap), nearer_text(tap.exact_m, tap.compared_m));
  if (tap.exact_m < tap.reference_m)
    return text + fmt::format(
                      "What casts the shadow is stored {} nearer to the light than the receiver, and the bias "
                      "of {} reaches past it. With less than {} of bias the tap would be dark.",
                      length_text(tap.reference_m - tap.exact_m), length_text(section.bias_m),
                      length_text(tap.threshold_m));
  if (!section.missing) return text + "What casts the shadow is not in the map at a depth before the receiver.";
  const MissingBlocker& missing = *section.missing;
  if (missing.culled)
    return text + fmt::format(
                      "The face of '{}' that casts the shadow is culled from the map, {}", printable(missing.part),
                      missing.drawn_m ? fmt::format("and the next face of it that is drawn there lies {} the receiver.",
                                                    nearer_text(*missing.drawn_m, tap.reference_m))
                                      : "and no other face of it stands there: the map has nothing of it.");
  if (section.casters_moved && !missing.drawn_m)
    return text + fmt::format(
                      "The casters are moved before the map is drawn, and the face of '{}' that casts the shadow "
                      "does not cover the texel's centre then.",
                      printable(missing.part));
  if (section.casters_moved)
    return text + fmt::format(
                      "The casters are moved or offset before the map is drawn: the face of '{}' that casts the "
                      "shadow is {} the receiver then.",
                      printable(missing.part), nearer_text(std::max(*missing.drawn_m, tap.exact_m), tap.reference_m));
  return text + fmt::format("The face of '{}' that casts the shadow is not in the map at a depth before the receiver.",
                            printable(missing.part));
}

std::string aliasing_text(const ReceiverSection& section, const SectionTap& tap) {
  const bool dark = tap.cause == Cause::aliasing_dark;
  return fmt::format(
      "The centre of {} is {}, and it is {}: the exact map stores a depth {} the compared depth. The receiver's own "
      "place "
      "is {}. A shadow's edge runs between them, and a texel has one answer for both. {}.",
      texel_text(section, tap), away_text(section, tap), dark ? "in shadow" : "lit",
      nearer_text(tap.exact_m, tap.compared_m), dark ? "lit" : "in shadow",
      section.light == "directional" ? "A finer map or a smaller extent brings the centre nearer; no bias does"
                                     : "A finer map brings the centre nearer; no bias does");
}

std::string coverage_text(const ReceiverSection& section, const SectionTap& tap) {
  const char* const verdict = tap.lit ? "lit, though it is in shadow" : "dark, though it is lit";
  if (section.beyond_far)
    return fmt::format(
        "The receiver lies {} beyond the map's far plane, so the tap is {}. A larger far would cover it.",
        length_text(section.reference_m - section.far_m), verdict);
  if (!tap.inside)
    return fmt::format(
        "The tap reads {}, outside the map of {} x {} texels. What it gets there makes it {}. A larger extent or "
        "another "
        "wrap mode helps.",
        texel_text(section, tap), section.map_size.x, section.map_size.y, verdict);
  return fmt::format(
      "What casts the shadow at the centre of {} lies before the map's near plane ({} from the light's origin of "
      "depths), "
      "so the map does not have it, and the tap is {}. A smaller near would cover it.",
      texel_text(section, tap), length_text(section.near_m), verdict);
}

std::string precision_text(const ReceiverSection& section, const SectionTap& tap) {
  if (tap.lit == tap.shown_lit)
    return "On the exact map the lookup's result is another one: the difference is the rounding of the weights with "
           "which "
           "OpenGL's sampler blends the taps.";
  return fmt::format(
      "On the exact map the tap is {}, which is right. OpenGL's map stores in {} a depth {} the exact one, and the "
      "compared "
      "depth lies {} the stored one: the tap is {}. A deeper format or a tighter near and far helps.",
      tap.lit ? "lit" : "dark", texel_text(section, tap), nearer_text(tap.stored_m, tap.exact_m),
      tap.compared_m > tap.stored_m ? fmt::format("{} behind", length_text(tap.compared_m - tap.stored_m))
                                    : fmt::format("{} before", length_text(tap.stored_m - tap.compared_m)),
      tap.shown_lit ? "lit" : "dark");
}

std::string filter_text(const ReceiverSection& section) {
  const auto dark =
      std::count_if(section.taps.begin(), section.taps.end(), [](const SectionTap& t) { return !t.exact_lit; });
  return fmt::format(
      "At their exact places {} of {} taps are in shadow, and the receiver itself is {}. The filter averages over the "
      "kernel: this blur is its purpose, and a smaller kernel has less of it.",
      dark, section.taps.size(), section.truth > 0 ? "lit" : "in shadow");
}

std::string right_text(const ReceiverSection& section, const SectionTap& tap) {
  const std::string same =
      fmt::format("The map gives what the shadow ray gives: {}.", section.truth > 0 ? "lit" : "in shadow");
  if (tap.lit != tap.shown_lit)
    return fmt::format(
        "{} But it does so by luck: the exact map stores in {} a depth {} the compared depth, which makes the tap {}, "
        "and "
        "the rounding of OpenGL's map, which stores a depth {} the exact one, turns it.",
        same, texel_text(section, tap), nearer_text(tap.exact_m, tap.compared_m), tap.lit ? "lit" : "dark",
        nearer_text(tap.stored_m, tap.exact_m));
  return fmt::format("{} The exact map stores in {} a depth {} the compared depth.", same, texel_text(section, tap),
                     nearer_text(tap.exact_m, tap.compared_m));
}

std::string cause_text(const ReceiverSection& section) {
  const SectionTap& tap = section.taps[section.key_tap];
  switch (section.cause) {
    case Cause::acne:
      return acne_text(section, tap);
    case Cause::peter_panning:
      return panning_text(section, tap);
    case Cause::aliasing_dark:
    case Cause::aliasing_light:
      return aliasing_text(section, tap);
    case Cause::coverage_dark:
    case Cause::coverage_light:
      return coverage_text(section, tap);
    case Cause::precision:
      return precision_text(section, tap);
    case Cause::filter:
      return filter_text(section);
    case Cause::displacement:
      return fmt::format(
          "The lookup is moved by {}, and there the light differs from that at the receiver. This is the "
          "price of an offset; a smaller one moves shadows less.",
          length_text(section.moved_m));
    case Cause::undecided:
      return "Float error can change the truth at a tap, so it is not known to which cause this error belongs.";
    case Cause::light_size:
    case Cause::leak:  // a section is of a lookup that compares depths
    case Cause::over_darkening:
    case Cause::reduction:
    case Cause::moment_precision:
    case Cause::none:
      break;
  }
  return right_text(section, tap);
}

std::string bias_text(const ReceiverSection& section) {
  if (section.bias_m == 0) return "The compared depth has no bias.";
  return fmt::format("The bias here is {} along the light = {} = {} of the map's depth.", length_text(section.bias_m),
                     quantity_text(section.bias_m / section.texel_m, "texels", 3), number_text(section.bias_depth, 3));
}

std::string lower_first(std::string_view text) {
  std::string lower(text);
  if (!lower.empty() && lower[0] >= 'A' && lower[0] <= 'Z' && !lower.starts_with("Peter")) lower[0] += 'a' - 'A';
  return lower;
}

// "The lookup has 9 taps; wrong: 2 acne (too dark); 1 aliasing, too dark. The pixel shows 0.667 of the light ..."
std::string taps_text(const ReceiverSection& section) {
  std::string text = fmt::format("The lookup has {} taps", section.taps.size());
  std::string wrong;
  for (int c = 1; c < compared_cause_count; ++c) {
    const auto cause = static_cast<Cause>(c);
    const auto count = std::count_if(section.taps.begin(), section.taps.end(),
                                     [&](const SectionTap& tap) { return tap.cause == cause; });
    if (count == 0) continue;
    const CauseColor* const color = find_color(cause_name(cause));
    wrong +=
        fmt::format("{}{} {}", wrong.empty() ? "" : "; ", count, lower_first(color ? color->label : cause_name(cause)));
  }
  text += wrong.empty() ? "; each is right for its own place." : fmt::format("; wrong: {}.", wrong);
  return text + fmt::format(" The pixel shows {} of the light, the truth is {}.",
                            number_text(static_cast<double>(section.shown), 3),
                            number_text(static_cast<double>(section.truth), 3));
}

std::string left_out_text(const ReceiverSection& section) {
  std::string text;
  const auto add = [&](const std::string& sentence) { text += (text.empty() ? "" : " ") + sentence; };
  const auto other_face =
      std::count_if(section.taps.begin(), section.taps.end(), [](const SectionTap& tap) { return !tap.same_tile; });
  if (other_face > 0)
    add(fmt::format("{} on another face of the cube {} not drawn.",
                    other_face == 1 ? "1 tap" : fmt::format("{} taps", other_face), other_face == 1 ? "is" : "are"));
  if (section.moved && section.cause == Cause::displacement)
    add("The plane goes through the place looked up.");
  else if (section.moved)
    add(fmt::format("The lookup is moved by {}; the plane goes through the place looked up.",
                    length_text(section.moved_m)));
  if (section.casters_moved) add("The map is drawn from moved casters; the surfaces are drawn where they stand.");
  if (!section.has_slope) add("The surface faces the light, so the plane runs along the map's rows.");
  if (section.soft_truth != section.truth)
    add(fmt::format("Of the light with its size {} is seen; only its centre is drawn.",
                    number_text(static_cast<double>(section.soft_truth), 3)));
  return text;
}

std::string label_of(Cause cause) {
  const CauseColor* const color = find_color(cause_name(cause));
  return std::string(color ? color->label : cause_name(cause));
}

}  // namespace

std::string section_title(const ReceiverSection& section) {
  if (section.ambiguous) return "Not known, ambiguous truth";
  if (section.cause == Cause::none) return section.truth > 0 ? "Right, lit" : "Right, shadowed";
  return label_of(section.cause);
}

std::vector<std::string> section_words(const ReceiverSection& section) {
  std::vector<std::string> words{cause_text(section), bias_text(section)};
  if (section.ambiguous)
    words.insert(words.begin(),
                 "Float error changes the truth of this receiver, so it is left out of every error, and it is not "
                 "known whether the "
                 "pixel is right. What follows is so for one of the two truths.");
  if (section.taps.size() > 1) words.push_back(taps_text(section));
  if (section.largest != section.cause)
    words.push_back(fmt::format("The largest part of this pixel's error is another: {}.", label_of(section.largest)));
  if (std::string left_out = left_out_text(section); !left_out.empty()) words.push_back(std::move(left_out));
  return words;
}

}  // namespace noonmark::report
