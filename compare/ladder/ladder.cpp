#include "compare/ladder/ladder.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "compare/ladder/receiver_taps.h"
#include "compare/results/quantities.h"

namespace noonmark {

double larger_residual(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN() : std::max(a, b);
}

Cause pixel_cause(const Ladder& ladder, size_t i, bool filtered) {
  const float truth = ladder.truth()[i];
  if (ladder[Rung::shown][i] == truth) return Cause::none;
  if (!filtered && ladder[Rung::on_exact_map][i] == truth) return Cause::precision;
  Cause largest = Cause::none;
  float size = 0;
  for (size_t c = static_cast<size_t>(Cause::filter); c < ladder.built_in(); ++c) {
    const auto cause = static_cast<Cause>(c);
    if (!filtered && cause == Cause::precision) continue;
    if (std::abs(ladder[cause][i]) > size) {
      size = std::abs(ladder[cause][i]);
      largest = cause;
    }
  }
  return largest;
}

bool inside_of_map(const LookupProbe& probe, size_t i, const MapDepths& map) {
  return probe.cube_resolution > 0 || inside_map(LookupProbe::floored(probe.map_texels[i]), map.size());
}

void require_strip(const LookupEvidence& e, PixelRange strip) {
  if (e.taps.taps_per_receiver != e.probe.taps()) throw std::logic_error("the truth's taps are not the probe's");
  if (!e.taps.holds(strip) || !e.probe.holds(strip)) throw std::logic_error("not the strip that the evidence holds");
}

Ladder climb(const LookupEvidence& e) {
  Ladder ladder = empty_ladder(e.truth.facing.width, e.truth.facing.height);
  climb(e, {0, e.truth.facing.size()}, ladder);
  return ladder;
}

Ladder empty_ladder(int width, int height, int causes) {
  Ladder ladder;
  for (std::string_view name : rung_names) ladder.rungs.push_back({std::string(name), {}});
  for (int c = 0; c < causes; ++c) ladder.causes.push_back({std::string(cause_name(static_cast<Cause>(c))), {}});
  std::vector<Image<float>*> images = {&ladder.doubt};
  for (Ladder::RungImage& rung : ladder.rungs) images.push_back(&rung.lit);
  for (Ladder::CauseImage& cause : ladder.causes) images.push_back(&cause.step);
  // Of a large picture they are some 60 MB, and the kernel gives them page by page.
  tbb::parallel_for(size_t{0}, images.size(), [&](size_t i) { *images[i] = Image<float>(width, height, 0); });
  ladder.cause = Image<uint8_t>(width, height, 0);
  ladder.flags = Image<uint8_t>(width, height, 0);
  return ladder;
}

void rebook(Ladder& ladder, Cause from, RungCause as, const Image<uint8_t>& mask) {
  if (!is_free_name(as.name)) throw std::logic_error("a cause cannot have the name " + as.name);
  Image<float>& step = ladder[from];
  Image<float> moved(step.width, step.height, 0);
  for (size_t i = 0; i < moved.size(); ++i) {
    if (mask.size() != 0 && !mask[i]) continue;
    std::swap(step[i], moved[i]);
    if (ladder.cause[i] == static_cast<uint8_t>(from)) ladder.cause[i] = static_cast<uint8_t>(ladder.causes.size());
  }
  ladder.causes.push_back({as.name, std::move(moved)});
  ladder.brought.push_back(std::move(as));
}

void add_rung(Ladder& ladder, RungOnTop rung) {
  Image<float>& picture = rung.picture;
  if (picture.width != ladder.flags.width || picture.height != ladder.flags.height)
    throw std::logic_error("the rung " + rung.name + " has another size than the ladder");
  const auto named = [](const std::string& wanted) { return [&](const auto& one) { return one.name == wanted; }; };
  if (std::any_of(ladder.rungs.begin(), ladder.rungs.end(), named(rung.name)) ||
      std::any_of(ladder.causes.begin(), ladder.causes.end(), named(rung.cause)))
    throw std::logic_error("the ladder has a rung " + rung.name + " or a cause " + rung.cause + " already");
  if (!is_free_name(rung.cause)) throw std::logic_error("a cause cannot have the name " + rung.cause);
  if (!rung.color) {
    const auto taken = [&](const std::array<uint8_t, 3>& color) {
      return std::any_of(ladder.brought.begin(), ladder.brought.end(),
                         [&](const RungCause& cause) { return cause.color == color; });
    };
    const auto free = std::find_if_not(spare_colors.begin(), spare_colors.end(), taken);
    rung.color = free == spare_colors.end() ? spare_colors.front() : *free;
  }
  const Image<float>& below = ladder.shown();
  Image<float> step(picture.width, picture.height, 0);
  const auto index = static_cast<uint8_t>(ladder.causes.size());
  for (size_t i = 0; i < picture.size(); ++i) {
    if (!(ladder.flags[i] & flag_facing)) {
      picture[i] = 0;
      continue;
    }
    step[i] = picture[i] - below[i];
    float largest = 0;
    for (size_t c = static_cast<size_t>(Cause::filter); c < ladder.causes.size(); ++c)
      largest = std::max(largest, std::abs(ladder.causes[c].step[i]));
    if (picture[i] == ladder.truth()[i])
      ladder.cause[i] = static_cast<uint8_t>(Cause::none);
    else if (!(std::abs(step[i]) <= largest) || ladder.cause[i] == static_cast<uint8_t>(Cause::none))
      ladder.cause[i] = index;
    if (std::isnan(step[i])) ladder.residual = std::numeric_limits<double>::quiet_NaN();
  }
  ladder.rungs.push_back({rung.name, std::move(picture)});
  ladder.causes.push_back({rung.cause, std::move(step)});
  ladder.brought.push_back({rung.cause, rung.label, rung.help, *rung.color, rung.name});
}

Climb::Climb(const LookupEvidence& evidence, PixelRange strip, Ladder& ladder) : e_(evidence), ladder_(ladder) {
  for (size_t i = strip.first; i < strip.end; ++i)
    ladder.flags[i] = static_cast<uint8_t>((evidence.truth.facing[i] ? flag_facing : 0) |
                                           (evidence.truth.ambiguous[i] ? flag_ambiguous : 0));
}

void Climb::receiver(size_t i, const ReceiverTaps& taps, Part& worst) const {
  const bool given = !e_.probe.pattern.bilinear() && e_.r4.size() != 0;
  receiver(i, taps, {e_.bias.at(e_.probe, i), given ? std::optional(e_.r4[i]) : std::nullopt, e_.r5[i]}, worst);
}

void Climb::receiver(size_t i, const ReceiverTaps& taps, const Shown& shown, Part& worst) const {
  const LookupEvidence& e = e_;
  Ladder& ladder = ladder_;
  const double whole = whole_weight(e.probe);
  if (e.probe.reference[i] > 1.0f || !e.probe.asks(i) || !inside_of_map(e.probe, i, e.exact_map))
    ladder.flags[i] |= flag_outside;

  double exact_lit = 0, moved_lit = 0, texel_lit = 0, all_lit = 0, unsure = 0;
  // The undecided parts of three steps: from R1 to the exact places, from there to the places looked up, and from
  // there to R4. They are signed.
  double before_exact = 0, before_moved = 0, before_r4 = 0;
  std::array<double, compared_cause_count> booked{};
  const auto book = [&](const Tap& tap, bool lit, double weight) {
    if (tap.exact_lit) exact_lit += weight;
    if (tap.moved_lit) moved_lit += weight;
    if (tap.texel_lit) texel_lit += weight;
    if (lit) all_lit += weight;
    const Cause cause = tap_cause(tap, lit);
    booked[static_cast<size_t>(cause)] += weight;
    if (tap.exact_sure && tap.moved_sure && tap.texel_sure) return;
    unsure += weight;
    const auto step = [&](bool from, bool to) { return weight * (static_cast<int>(to) - static_cast<int>(from)); };
    if (!tap.exact_sure) before_exact += step(e.truth.lit[i] != 0, tap.exact_lit);
    if (!tap.exact_sure || !tap.moved_sure) before_moved += step(tap.exact_lit, tap.moved_lit);
    if (cause == Cause::undecided) before_r4 += step(tap.moved_lit, lit);
  };
  if (taps.alike()) {  // those that are lit are booked at once, and so are those that are dark
    const size_t lit = taps.lit_on(e.exact_map, shown.bias);
    if (lit > 0) book(taps[0], true, static_cast<double>(lit));
    if (lit < taps.size()) book(taps[0], false, static_cast<double>(taps.size() - lit));
  } else {
    for (size_t t = 0; t < taps.size(); ++t) {
      const Tap tap = taps[t];
      book(tap, tap.lit(shown.bias), tap.weight);
    }
  }
  if (unsure > 0) ladder.flags[i] |= flag_undecided;
  // Computed in double and rounded once to float: the shader's own count / N is the same quotient in float.
  const auto share = [&](double weight) { return static_cast<float>(weight / whole); };
  const float r[std::size(rung_names)] = {e.truth.soft[i],  static_cast<float>(e.truth.lit[i]), share(exact_lit),
                                          share(texel_lit), shown.r4.value_or(share(all_lit)),  shown.r5};
  for (size_t n = 0; n < std::size(r); ++n) ladder.rungs[n].lit[i] = r[n];

  const auto set = [&](Cause cause, float value) { ladder[cause][i] = value; };
  set(Cause::light_size, r[1] - r[0]);
  set(Cause::filter, r[2] - r[1] - share(before_exact));
  set(Cause::displacement, share(moved_lit) - r[2] - share(before_moved));
  set(Cause::undecided, share(before_exact + before_moved + before_r4));
  ladder.doubt[i] = share(unsure);
  set(Cause::precision, r[5] - r[4]);
  for (const CauseRow& row : cause_rows) {
    if (row.effect == CauseEffect::either || static_cast<size_t>(*row.cause) >= booked.size()) continue;
    const float size = share(booked[static_cast<size_t>(*row.cause)]);
    set(*row.cause, row.effect == CauseEffect::darkens ? -size : size);
  }

  double all = 0, classes = 0;
  for (const Ladder::CauseImage& c : ladder.causes) all += c.step[i];
  for (int c = static_cast<int>(Cause::displacement); c <= static_cast<int>(Cause::coverage_light); ++c)
    classes += ladder[static_cast<Cause>(c)][i];
  classes += (before_moved + before_r4) / whole;
  worst.steps = larger_residual(worst.steps, std::abs((static_cast<double>(r[5]) - r[0]) - all));
  worst.taps = larger_residual(worst.taps, std::abs((static_cast<double>(r[4]) - r[2]) - classes));
  ladder.cause[i] = static_cast<uint8_t>(pixel_cause(ladder, i, taps.size() > 1));
}

void Climb::join(const Part& part) {
  ladder_.residual = larger_residual(ladder_.residual, part.steps);
  ladder_.tap_residual = larger_residual(ladder_.tap_residual, part.taps);
}

namespace {

void take(Ladder& ladder, const Ladder& other, size_t i) {
  for (size_t n = 0; n < ladder.rungs.size(); ++n) ladder.rungs[n].lit[i] = other.rungs[n].lit[i];
  for (size_t c = 0; c < ladder.causes.size(); ++c) ladder.causes[c].step[i] = other.causes[c].step[i];
  ladder.cause[i] = other.cause[i];
  ladder.flags[i] = other.flags[i];
  ladder.doubt[i] = other.doubt[i];
}

void mix(Ladder& ladder, const Ladder& other, size_t i, double share) {
  const auto mixed = [&](float& here, float there) {
    here = static_cast<float>((1 - share) * static_cast<double>(here) + share * static_cast<double>(there));
  };
  for (size_t n = 0; n < ladder.rungs.size(); ++n) mixed(ladder.rungs[n].lit[i], other.rungs[n].lit[i]);
  double steps = 0;
  for (size_t c = 0; c < ladder.causes.size(); ++c) {
    mixed(ladder.causes[c].step[i], other.causes[c].step[i]);
    steps += static_cast<double>(ladder.causes[c].step[i]);
  }
  mixed(ladder.doubt[i], other.doubt[i]);
  ladder.flags[i] |= other.flags[i];
  ladder.cause[i] = static_cast<uint8_t>(pixel_cause(ladder, i, true));
  const double change = static_cast<double>(ladder.shown()[i]) - static_cast<double>(ladder.soft_truth()[i]);
  ladder.residual = larger_residual(ladder.residual, std::abs(change - steps));
}

}  // namespace

void join(Ladder& ladder, const Ladder& other, const Image<double>& share) {
  if (ladder.rungs.size() != other.rungs.size() || ladder.causes.size() != other.causes.size() ||
      ladder.flags.size() != other.flags.size() || share.size() != ladder.flags.size())
    throw std::logic_error("join: ladders of different rungs, causes or sizes");
  for (size_t i = 0; i < ladder.flags.size(); ++i) {
    if (!(other.flags[i] & flag_facing)) continue;
    if (!(ladder.flags[i] & flag_facing))
      take(ladder, other, i);
    else if (share[i] > 0)
      mix(ladder, other, i, share[i]);
  }
  ladder.residual = larger_residual(ladder.residual, other.residual);
  ladder.tap_residual = larger_residual(ladder.tap_residual, other.tap_residual);
}

void climb(const LookupEvidence& e, PixelRange strip, Ladder& ladder) {
  require_strip(e, strip);
  Climb climbing(e, strip, ladder);
  read_taps(e, strip, climbing);
}

}  // namespace noonmark
