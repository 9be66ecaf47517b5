#include "raytrace/lookup_tracer.h"

#include <tbb/combinable.h>

#include <algorithm>
#include <optional>
#include <span>

#include "raytrace/drawn_map.h"
#include "raytrace/light_view.h"
#include "raytrace/own_surface.h"
#include "raytrace/packets.h"
#include "raytrace/stage_watch.h"
#include "raytrace/texel_rays.h"
#include "raytrace/traced_scene.h"

namespace noonmark::raytrace {
// The silhouettes among the taps of a receiver. A receiver that is lit and has none is lit at all of these places, for
// sure (OwnSurface::lit_at() without a crossing), so no ray is needed at a tap's exact place. For the others they are
// listed once, not searched for at each tap. Only where one table of offsets serves all receivers of parallel rays; then
// the corners of the table are those of the rectangle around the taps.
class AmongTaps {
 public:
  AmongTaps(const LightView& view, const Silhouettes& silhouettes, const LookupProbe& probe, const Bias& bias)
      : silhouettes_(silhouettes), probe_(probe) {
    const LightFrame& frame = view.frame();
    applies_ = view.rays().have_one_direction() && probe.pattern.variants == 1 && !probe.pattern.scaled_by_view &&
               probe.cube_resolution == 0 && !bias.moves_lookup();
    if (!applies_) return;
    for (int tap = 0; tap < probe.taps(); ++tap) {
      low_ = glm::min(low_, glm::vec2(probe.pattern.offset(0, tap)));
      high_ = glm::max(high_, glm::vec2(probe.pattern.offset(0, tap)));
    }
    origin_m_ = frame.origin_m, right_ = frame.right, up_ = frame.up;
    first_texel_ = glm::dvec2(view.texel_place({0, 0}));
    texel_m_ = frame.texel_m({0, 0, 0});
  }

  bool applies() const { return applies_; }

  // The taps read texels between these two.
  std::pair<glm::ivec2, glm::ivec2> texels(size_t pixel) const {
    const glm::vec2 at = probe_.map_texels[pixel];
    if (probe_.pattern.bilinear())
      return {probe_.texel_at(at, pixel, 0), probe_.texel_at(at, pixel, probe_.taps() - 1)};
    // As LookupProbe::texel_at() rounds, which keeps the order of the offsets.
    return {LookupProbe::floored(at + low_), LookupProbe::floored(at + high_)};
  }

  // p: the receiver, in the world. nearby: its memory is used again.
  bool none(size_t pixel, glm::dvec3 p, Silhouettes::Nearby& nearby) const {
    const Silhouettes::Rectangle rectangle = around(pixel, p);
    if (silhouettes_.none_in(rectangle)) return true;
    silhouettes_.list_in(rectangle, nearby);
    return nearby.none();
  }
  void list(size_t pixel, glm::dvec3 p, Silhouettes::Nearby& nearby) const {
    silhouettes_.list_in(around(pixel, p), nearby);
  }

  // Holds the receiver's place, those of its taps, and the centres of their texels, as LightFrame computes them except
  // for double's rounding, which is far less than the reach of the silhouettes' lists. LightFrame's own functions serve
  // every kind of light, and took half of the time of a lookup without a filter.
  Silhouettes::Rectangle around(size_t pixel, glm::dvec3 p) const {
    const auto [low, high] = texels(pixel);
    return rectangle(place(p), low_, high_, low, high);
  }
  // The same of the taps of a square between two of its taps, without the receiver's place.
  Silhouettes::Rectangle of_taps(size_t pixel, glm::dvec3 p, int first, int last) const {
    const auto offset = [&](int tap) { return glm::vec2(probe_.pattern.offset(0, tap)); };
    return rectangle(place(p), offset(first), offset(last), probe_.texel(pixel, first), probe_.texel(pixel, last));
  }
  glm::dvec2 place(glm::dvec3 p) const { return {glm::dot(p - origin_m_, right_), glm::dot(p - origin_m_, up_)}; }
  // The ways from the receiver, in texels: none yet, one to a tap's exact place, and one to the centre of its texel.
  void begin(glm::dvec3 p, Silhouettes::Ways& ways) const {
    ways.from = place(p);
    ways.unit_m = texel_m_;
    const auto most = [](glm::dvec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
    ways.most_m = most(p) + most(origin_m_) + most(glm::dvec3(first_texel_, 0));
    ways.clear();
  }
  static void push_exact(glm::dvec3 offset, Silhouettes::Ways& ways) { ways.push(glm::dvec2(offset)); }
  void push_centre(glm::ivec2 texel, Silhouettes::Ways& ways) const {
    ways.push((first_texel_ - ways.from) / texel_m_ + glm::dvec2(texel));
  }

 private:
  Silhouettes::Rectangle rectangle(glm::dvec2 place, glm::dvec2 low, glm::dvec2 high, glm::ivec2 low_texel,
                                   glm::ivec2 high_texel) const {
    return {0, glm::min(place + texel_m_ * low, first_texel_ + texel_m_ * glm::dvec2(low_texel)),
            glm::max(place + texel_m_ * high, first_texel_ + texel_m_ * glm::dvec2(high_texel))};
  }
  const Silhouettes& silhouettes_;
  const LookupProbe& probe_;
  bool applies_;
  glm::vec2 low_{0}, high_{0};  // the least and the largest offset of a tap in each axis; 0 is between them
  glm::dvec3 origin_m_{0}, right_{0}, up_{0};
  glm::dvec2 first_texel_{0};  // the centre of texel (0, 0)
  double texel_m_ = 0;
};

struct LookupTracer::Impl {
  TracedScene& traced;
  const ReceiverImage& receivers;
  const ReceiverTruth& truth;
  MapSettings map;
  Bias bias;
  std::optional<PolygonOffset> offset;
  std::shared_ptr<LightSide> light;
  LightView view;
  TruthMethod method;
  bool by_rays() const { return method == TruthMethod::rays; }
  TexelRays texels{traced, view, map.wrap};
};

LookupTracer::LookupTracer(TracedScene& traced, const ReceiverImage& receivers, const ReceiverTruth& truth,
                           const LightFrame& frame, const MapSettings& map, const Bias& bias, double offset_unit,
                           TruthMethod method) {
  const std::shared_ptr<LightSide> light = traced.lit_by(frame);
  impl_.reset(new Impl{traced, receivers, truth, map, bias, polygon_offset_of(frame, map, bias, offset_unit), light,
                       light->view().with_map_of(frame), method});
}
LookupTracer::LookupTracer(LookupTracer&&) noexcept = default;
LookupTracer& LookupTracer::operator=(LookupTracer&&) noexcept = default;
LookupTracer::~LookupTracer() = default;

const Image<uint8_t>& LookupTracer::facing() const { return impl_->truth.facing; }

void LookupTracer::ask(const Image<uint8_t>& of, const LookupProbe& probe, PixelRange strip, StageTime* stage) {
  const StageWatch watch(stage, impl_->traced.device);
  impl_->texels.ask(of, probe, strip);
}

size_t LookupTracer::asked_texels() const { return impl_->texels.asked(); }

MapDepths LookupTracer::trace_map(StageTime* stage) {
  const StageWatch watch(stage, impl_->traced.device);
  const Impl& l = *impl_;
  const OwnSurface surface(l.traced.embree, l.traced.adjacency, l.view, l.light->silhouettes());
  impl_->texels.trace(l.by_rays() ? &surface : nullptr);
  const DrawnMap drawn(l.traced, l.view, surface, l.light->silhouettes(), l.view.frame(), l.map, l.bias, l.offset);
  MapDepths map(l.texels.texels(), 1);
  l.texels.each_inside([&](int count, size_t first, const glm::dvec3* places, const uint32_t* hits) {
    drawn.depths(count, places, hits, &map.depth[first]);
  });
  return map;
}

TruthAnswers LookupTracer::texel_answers() const { return impl_->texels.answers(); }

TapTruth LookupTracer::trace_taps(const LookupProbe& probe, PixelRange strip, Image<float>& edge_distance_texels,
                                  StageTime* stage) {
  return trace(probe, strip, &edge_distance_texels, stage);
}

TapTruth LookupTracer::trace_places(const LookupProbe& probe, PixelRange strip, StageTime* stage) {
  return trace(probe, strip, nullptr, stage);
}

// One trace of a strip. Receivers that are lit, or dark, for sure at all their taps are answered first. Of the others, blocks of
// taps are; for the taps that remain rays are asked, packet by packet.
class TapTracing {
 public:
  // edge_distance_texels: null if only the exact places are asked (trace_places).
  TapTracing(LookupTracer::Impl& lookup, const LookupProbe& probe, PixelRange strip, Image<float>* edge_distance_texels)
      : l_(lookup),
        probe_(probe),
        strip_(strip),
        edge_distance_texels_(edge_distance_texels),
        cells_(l_.by_rays() ? nullptr : l_.light->cells(l_.receivers)),
        surface_(l_.traced.embree, l_.traced.adjacency, l_.view, l_.light->silhouettes(), cells_),
        among_taps_(l_.view, l_.light->silhouettes(), probe, l_.bias),
        listed_(!l_.by_rays() && among_taps_.applies()),
        square_(listed_ && probe.taps() > 1 ? probe.pattern.texel_side() : 0),
        parallel_(l_.view.rays().have_one_direction()),
        texel_m_(parallel_ ? frame().texel_m({}) : 0) {
    result_.taps.assign(strip.size() * static_cast<size_t>(probe.taps()), 0);
  }

  TapTruth trace() {
    const std::vector<size_t> asked = answer_certain();
    for_each_packet(asked.size(), [&](size_t begin, int active) { trace_packet({&asked[begin], size_t(active)}); });
    answers_.combine_each([&](const TruthAnswers& of_thread) { result_.answers += of_thread; });
    return std::move(result_);
  }

 private:
  // What is known of a tap before rays are asked for it: that it is lit, for sure, or that no silhouette is near, at its exact
  // place and at the centre of its texel; or that it is answered.
  enum Known : uint8_t { exact_lit = 1, texel_lit = 2, answered = 4, exact_away = 8, texel_away = 16 };
  // Up to packet_size receivers.
  struct Packet {
    std::span<const size_t> pixels;
    SurfacePoint points[packet_size];
    glm::dvec3 at[packet_size];                        // P in the light's frame
    glm::dvec3 looked_up[packet_size];                 // P' there; P unless a part moves the lookup
    bool behind[packet_size];                          // P' has no place in the map: behind a spot light
    Silhouettes::Nearby* nearby;                       // of each receiver, if the silhouettes are listed
    std::vector<uint8_t>* known;                       // [tap] of each receiver: which verdicts are known, of Known
    mutable std::optional<LightCells::Reader> reader;  // remembers where it looked last
    mutable TruthAnswers answers;                      // counted here, and added to the thread's once
    int active() const { return static_cast<int>(pixels.size()); }
  };

  const LightFrame& frame() const { return l_.view.frame(); }
  bool may_clip() const { return edge_distance_texels_ && !l_.map.keeps_clipped(); }
  uint8_t* bits_of(size_t pixel) { return &result_.taps[(pixel - strip_.first) * static_cast<size_t>(probe_.taps())]; }
  glm::dvec3 tap_place(glm::dvec3 from, glm::dvec3 offset) const {
    // Of parallel rays the same numbers, without the calls.
    return parallel_ ? glm::dvec3(from.x + offset.x * texel_m_, from.y + offset.y * texel_m_, 1)
                     : l_.view.normal_place(frame().tap_place(from, offset));
  }
  // away: no silhouette is near x, for sure.
  OwnSurface::Verdict lit_at(const Packet& packet, int k, glm::dvec3 x, uint32_t hit, bool away) const {
    return listed_ ? surface_.lit_at(packet.points[k], x, hit, packet.nearby[k], away)
                   : surface_.lit_at(packet.points[k], x, hit);
  }

  // Books the facing receivers that are lit at every tap for sure, or dark at every tap. Returns the pixels of the others,
  // in order.
  std::vector<size_t> answer_certain();
  void answer(size_t pixel, bool lit);
  // The taps of a square in these columns and rows; the last ones are in it.
  struct Block {
    int left, bottom, right, top;
    bool holds(int column, int row) const { return left <= column && column <= right && bottom <= row && row <= top; }
  };
  // Answers blocks of a receiver's taps that are certain, and divides the others.
  void answer_blocks(const Packet& packet, int k, const Block& block, OwnSurface::Pair& pair);
  // Finds the taps beside whose place, or whose texel's centre, no silhouette is, and of a lit receiver those to which none comes
  // in the way: they are lit.
  void answer_clear_ways(const Packet& packet, int k);
  bool clipped(glm::ivec2 texel) const {
    return may_clip() && l_.texels.may_be_clipped(texel, texel) && l_.texels.clipped(texel);
  }
  std::optional<bool> known_in(const Packet& packet, int k, const Block& block, OwnSurface::Pair& pair) const;
  void trace_packet(std::span<const size_t> pixels);
  // ks: the receivers of the packet that are asked.
  void first_hits(const Packet& packet, std::span<const int> ks, const glm::dvec3* x, uint32_t* hits) const;
  void verdicts_at(const Packet& packet, int tap, std::span<const int> ks, const glm::dvec3* from,
                   const glm::dvec3* offsets, OwnSurface::Verdict* verdicts) const;
  void trace_tap(const Packet& packet, int tap);
  // The verdict at the centre of the texel that the tap reads. moved_lit: D of the tap. Where the two differ, returns the search
  // for the edge between them.
  std::optional<OwnSurface::EdgeSearch> add_texel(const Packet& packet, int k, int tap, glm::dvec3 offset,
                                                  bool moved_lit, uint8_t& bits);

  LookupTracer::Impl& l_;
  const LookupProbe& probe_;
  const PixelRange strip_;
  Image<float>* const edge_distance_texels_;
  LightCells* const cells_;
  const OwnSurface surface_;
  const AmongTaps among_taps_;
  const bool listed_;  // silhouettes are listed for each receiver
  const int square_;   // the side of a square of taps that is divided into blocks; 0 if they are not
  const bool parallel_;
  const double texel_m_;  // of parallel rays
  TapTruth result_{probe_.taps(), {}, strip_.first};
  tbb::combinable<TruthAnswers> answers_{[] { return TruthAnswers(); }};  // of each thread
};

std::vector<size_t> TapTracing::answer_certain() {
  constexpr size_t pixels_per_part = 4096;
  // At a tap without an offset V is R1, which is known.
  uint64_t taps_beside = 0;
  for (int tap = 0; listed_ && tap < probe_.taps(); ++tap)
    taps_beside += glm::dvec3(probe_.pattern.offset(0, tap)) != glm::dvec3(0);
  std::vector<std::vector<size_t>> parts((strip_.size() + pixels_per_part - 1) / pixels_per_part);
  tbb::parallel_for(size_t{0}, parts.size(), [&](size_t part) {
    const size_t from = strip_.first + part * pixels_per_part, to = std::min(strip_.end, from + pixels_per_part);
    Silhouettes::Nearby nearby;
    std::optional<LightCells::Reader> reader;
    if (cells_) reader.emplace(*cells_);
    OwnSurface::Pair pair;
    const auto dark = [&](size_t pixel) {
      if (!reader) return false;
      const Silhouettes::Rectangle around = among_taps_.around(pixel, l_.receivers.position[pixel]);
      const SurfacePoint p{.primitive = l_.traced.adjacency.first(l_.receivers.primitive[pixel])};
      return surface_.known_in(p, around.low, around.high, *reader, pair) == std::optional(false);
    };
    uint64_t certain = 0;  // receivers
    for (size_t pixel = from; pixel < to; ++pixel) {
      if (!l_.truth.facing[pixel]) continue;
      if (edge_distance_texels_) (*edge_distance_texels_)[pixel] = 0;
      const bool lit = l_.truth.lit[pixel] != 0;
      if (listed_ && (lit ? among_taps_.none(pixel, l_.receivers.position[pixel], nearby) : dark(pixel))) {
        answer(pixel, lit);
        ++certain;
      } else {
        parts[part].push_back(pixel);
      }
    }
    answers_.local().cells += certain * taps_beside;
  });
  std::vector<size_t> asked;
  for (const std::vector<size_t>& part : parts) asked.insert(asked.end(), part.begin(), part.end());
  return asked;
}

void TapTracing::answer(size_t pixel, bool lit) {
  uint8_t* const bits = bits_of(pixel);
  if (lit)
    std::fill_n(bits, probe_.taps(), static_cast<uint8_t>(tap_exact_lit | (edge_distance_texels_ ? tap_texel_lit : 0)));
  if (!may_clip()) return;
  const auto [low, high] = among_taps_.texels(pixel);
  if (!l_.texels.may_be_clipped(low, high)) return;
  for (int tap = 0; tap < probe_.taps(); ++tap)
    if (l_.texels.clipped(probe_.texel(pixel, tap))) bits[tap] |= tap_near_clipped;
}

// A block of a lit P is lit if no silhouette comes between P and it.
std::optional<bool> TapTracing::known_in(const Packet& packet, int k, const Block& block,
                                         OwnSurface::Pair& pair) const {
  const size_t pixel = packet.pixels[static_cast<size_t>(k)];
  const SurfacePoint& p = packet.points[k];
  const glm::dvec3 position = l_.receivers.position[pixel];
  const Silhouettes::Rectangle taps =
      among_taps_.of_taps(pixel, position, block.bottom * square_ + block.left, block.top * square_ + block.right);
  const glm::dvec2 place = among_taps_.place(position);
  if (p.lit && packet.nearby[k].none_in({0, glm::min(taps.low, place), glm::max(taps.high, place)})) return true;
  if (!packet.reader) return std::nullopt;
  std::optional<bool> known = surface_.known_in(p, taps.low, taps.high, *packet.reader, pair);
  if (!known) known = surface_.known_on_sheet(p, taps.low, taps.high, *packet.reader, pair);
  // The tap at P itself has the verdict R1, which the ray of float gave.
  if (known && *known != p.lit && block.holds(square_ / 2, square_ / 2)) return std::nullopt;
  return known;
}

void TapTracing::answer_blocks(const Packet& packet, int k, const Block& block, OwnSurface::Pair& pair) {
  if (block.left > block.right || block.bottom > block.top) return;
  if (const std::optional<bool> lit = known_in(packet, k, block, pair)) {
    const size_t pixel = packet.pixels[static_cast<size_t>(k)];
    for (int row = block.bottom; row <= block.top; ++row)
      for (int column = block.left; column <= block.right; ++column) {
        const int tap = row * square_ + column;
        const glm::ivec2 texel = probe_.texel(pixel, tap);
        bits_of(pixel)[tap] =
            static_cast<uint8_t>((*lit ? tap_exact_lit | (edge_distance_texels_ ? tap_texel_lit : 0) : 0) |
                                 (clipped(texel) ? tap_near_clipped : 0));
        packet.known[k][static_cast<size_t>(tap)] = answered;
        packet.answers.cells += glm::dvec3(probe_.pattern.offset(0, tap)) != glm::dvec3(0);
      }
    return;
  }
  if (block.left == block.right && block.bottom == block.top) return;
  const int column = (block.left + block.right) / 2, row = (block.bottom + block.top) / 2;
  answer_blocks(packet, k, {block.left, block.bottom, column, row}, pair);
  answer_blocks(packet, k, {column + 1, block.bottom, block.right, row}, pair);
  answer_blocks(packet, k, {block.left, row + 1, column, block.top}, pair);
  answer_blocks(packet, k, {column + 1, row + 1, block.right, block.top}, pair);
}

// OwnSurface::lit_at() of such a place: nothing jumps on the way, and nothing is beside it.
void TapTracing::answer_clear_ways(const Packet& packet, int k) {
  const bool may_be_lit = packet.points[k].lit && !packet.points[k].on_silhouette;
  thread_local Silhouettes::Ways ways;
  const size_t pixel = packet.pixels[static_cast<size_t>(k)];
  std::vector<uint8_t>& known = packet.known[k];
  among_taps_.begin(l_.receivers.position[pixel], ways);
  for (int tap = 0; tap < probe_.taps(); ++tap) {
    if (known[static_cast<size_t>(tap)] == answered) continue;
    AmongTaps::push_exact(probe_.pattern.offset(0, tap), ways);
    if (edge_distance_texels_) among_taps_.push_centre(probe_.texel(pixel, tap), ways);
  }
  packet.nearby[k].answer(ways);
  const int32_t *open = ways.open.data(), *beside = ways.beside.data();
  for (int tap = 0; tap < probe_.taps(); ++tap) {
    uint8_t& of_tap = known[static_cast<size_t>(tap)];
    if (of_tap == answered) continue;
    const auto take = [&](Known lit, Known away) {
      if (!*beside++) of_tap |= away;
      if (!*open++ && may_be_lit) of_tap |= lit;
    };
    take(exact_lit, exact_away);
    if (edge_distance_texels_) take(texel_lit, texel_away);
  }
}

void TapTracing::trace_packet(std::span<const size_t> pixels) {
  thread_local Silhouettes::Nearby nearby[packet_size];  // their memory is used again
  thread_local std::vector<uint8_t> known[packet_size];
  Packet packet;
  packet.pixels = pixels;
  packet.nearby = nearby;
  packet.known = known;
  if (cells_) packet.reader.emplace(*cells_);
  OwnSurface::Pair pair;
  for (int k = 0; k < packet.active(); ++k) {
    const size_t pixel = pixels[static_cast<size_t>(k)];
    const glm::dvec3 p = l_.receivers.position[pixel], normal = l_.receivers.normal[pixel];
    packet.at[k] = frame().to_light(p);
    packet.points[k] = surface_.point(packet.at[k], l_.traced.adjacency.first(l_.receivers.primitive[pixel]),
                                      l_.truth.lit[pixel] != 0);
    packet.looked_up[k] = frame().to_light(l_.bias.looked_up(frame(), p, normal));
    packet.behind[k] = !frame().light().has_place(packet.looked_up[k]);
    if (listed_) among_taps_.list(pixel, p, nearby[k]);
    known[k].assign(static_cast<size_t>(probe_.taps()), 0);
    if (square_ > 0) answer_blocks(packet, k, {0, 0, square_ - 1, square_ - 1}, pair);
    if (listed_) answer_clear_ways(packet, k);
  }
  for (int tap = 0; tap < probe_.taps(); ++tap) trace_tap(packet, tap);
  answers_.local() += packet.answers;
}

// The cells' answers, and rays where they have none.
void TapTracing::first_hits(const Packet& packet, std::span<const int> ks, const glm::dvec3* x, uint32_t* hits) const {
  int unknown[packet_size], rays = 0;
  glm::dvec3 places[packet_size];
  for (const int k : ks) {
    if (const auto hit = packet.reader ? packet.reader->first_hit(x[k]) : std::nullopt) {
      hits[k] = *hit;
    } else {
      places[rays] = x[k];
      unknown[rays++] = k;
    }
  }
  packet.answers += {.cells = ks.size() - static_cast<uint64_t>(rays), .rays = static_cast<uint64_t>(rays)};
  if (rays == 0) return;
  uint32_t found[packet_size];
  l_.view.first_hits(l_.traced.embree, rays, places, found);
  for (int i = 0; i < rays; ++i) hits[unknown[i]] = found[i];
}

void TapTracing::verdicts_at(const Packet& packet, int tap, std::span<const int> ks, const glm::dvec3* from,
                             const glm::dvec3* offsets, OwnSurface::Verdict* verdicts) const {
  glm::dvec3 x[packet_size]{};
  uint32_t hits[packet_size];
  for (const int k : ks) x[k] = tap_place(from[k], offsets[k]);
  first_hits(packet, ks, x, hits);
  for (const int k : ks)
    verdicts[k] = lit_at(packet, k, x[k], hits[k], (packet.known[k][static_cast<size_t>(tap)] & exact_away) != 0);
}

void TapTracing::trace_tap(const Packet& packet, int tap) {
  const auto known = [&](int k, Known what) { return (packet.known[k][static_cast<size_t>(tap)] & what) != 0; };
  int of_packet[packet_size], of_rays[packet_size];
  size_t count = 0, asked = 0;
  for (int k = 0; k < packet.active(); ++k) {
    if (known(k, answered)) continue;
    of_packet[count++] = k;
    if (!known(k, exact_lit)) of_rays[asked++] = k;
  }
  const std::span<const int> ks(of_packet, count);
  if (ks.empty()) return;
  glm::dvec3 offsets[packet_size];
  if (probe_.pattern.variants == 1 && !probe_.pattern.scaled_by_view)  // the same of every receiver
    std::fill_n(offsets, packet.active(), glm::dvec3(probe_.pattern.offset(0, tap)));
  else
    for (const int k : ks) offsets[k] = probe_.offset(packet.pixels[static_cast<size_t>(k)], tap);
  OwnSurface::Verdict exact[packet_size], moved[packet_size];  // F and D
  if (std::all_of(ks.begin(), ks.end(), [&](int k) { return offsets[k] == glm::dvec3(0); }))
    for (const int k : ks) exact[k] = {packet.points[k].lit, true};  // V(P, P) is R1
  else
    verdicts_at(packet, tap, {of_rays, asked}, packet.at, offsets, exact);
  for (const int k : ks)
    if (known(k, exact_lit)) {
      exact[k] = {true, true};
      packet.answers.cells += offsets[k] != glm::dvec3(0);
    }
  if (l_.bias.moves_lookup())
    verdicts_at(packet, tap, ks, packet.looked_up, offsets, moved);
  else
    std::copy_n(exact, packet.active(), moved);
  OwnSurface::EdgeSearch edges[packet_size];
  int searched[packet_size];
  size_t searches = 0;
  for (const int k : ks) {
    if (packet.behind[k]) moved[k] = exact[k];
    const bool exact_lit = exact[k].lit, moved_lit = moved[k].lit;
    uint8_t& bits = bits_of(packet.pixels[static_cast<size_t>(k)])[tap];
    bits = static_cast<uint8_t>((exact_lit ? tap_exact_lit : 0) | (moved_lit != exact_lit ? tap_displaced : 0) |
                                (exact[k].sure ? 0 : tap_exact_unsure) | (moved[k].sure ? 0 : tap_moved_unsure));
    if (!edge_distance_texels_) continue;
    if (const auto search = add_texel(packet, k, tap, offsets[k], moved_lit, bits)) {
      searched[searches] = k;
      edges[searches++] = *search;
    }
  }
  if (searches == 0) return;
  surface_.find_edges({edges, searches});
  for (size_t i = 0; i < searches; ++i)
    (*edge_distance_texels_)[packet.pixels[static_cast<size_t>(searched[i])]] = edges[i].distance_texels;
}

std::optional<OwnSurface::EdgeSearch> TapTracing::add_texel(const Packet& packet, int k, int tap, glm::dvec3 offset,
                                                            bool moved_lit, uint8_t& bits) {
  const size_t pixel = packet.pixels[static_cast<size_t>(k)];
  const glm::ivec2 texel = probe_.texel(pixel, tap);
  const glm::dvec3 centre = l_.view.texel_place(texel);
  const uint8_t known = packet.known[k][static_cast<size_t>(tap)];
  const OwnSurface::Verdict at_texel = known & texel_lit
                                           ? OwnSurface::Verdict{true, true}
                                           : lit_at(packet, k, centre, l_.texels.hit(texel), (known & texel_away) != 0);
  bits = static_cast<uint8_t>(bits | (at_texel.lit ? tap_texel_lit : 0) | (clipped(texel) ? tap_near_clipped : 0) |
                              (at_texel.sure ? 0 : tap_texel_unsure));
  if (moved_lit == at_texel.lit || packet.behind[k]) return std::nullopt;
  const glm::dvec3 from = tap_place(packet.looked_up[k], offset);
  return OwnSurface::EdgeSearch{&packet.points[k], from, centre, moved_lit, (*edge_distance_texels_)[pixel]};
}

TapTruth LookupTracer::trace(const LookupProbe& probe, PixelRange strip, Image<float>* edge_distance_texels,
                             StageTime* stage) {
  const StageWatch watch(stage, impl_->traced.device);
  return TapTracing(*impl_, probe, strip, edge_distance_texels).trace();
}

}  // namespace noonmark::raytrace
