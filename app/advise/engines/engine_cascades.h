// How engines lay cascades: what a file of an engine says of them, and what their advice shares.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "app/advise/engines/engine.h"

namespace noonmark {

// The places at which the advice holds, one for each cascade, the nearest first. Their frames are of the maps that the engine
// lays, with their depths; texel_m is the recommended one.
struct AdvisedCascades {
  std::vector<AdvicePlace> places;
  double near_m = 0;           // the camera's near plane, where the first begins
  std::vector<double> ends_m;  // where each ends along the view, as recommended; the last is the reach
  double blend = 0;            // cascades.blend, if the engine can have it; otherwise 0
  double scene_depth_m = 0;    // of the whole scene, along the light
  Settings laid = {};          // laid_by() of the engine

  size_t count() const { return places.size(); }
  double reach_m() const { return ends_m.back(); }
  const Settings& settings() const { return places.front().settings; }
  // What `of` makes of all ends but the last.
  std::vector<std::string> inner(const std::function<double(double end_m)>& of) const;
};

// The lambda from 0 to 1 of practical splits whose ends are nearest to these, by least squares.
double nearest_lambda(double near_m, std::span<const double> ends_m);

// Which of the recommended ends a lambda misses, as a sentence; empty if it is right to a thousandth.
std::string missed_ends(const AdvisedCascades& cascades, double lambda);

// The settings with the maps that the engine lays for these ends.
Settings laid_by(const Engine& engine, Settings settings, double near_m, std::span<const double> ends_m);

// cascades.blend, if the engine can blend so, evenly; otherwise 0.
double blend_in(const EngineCascades& engine, const CascadeSettings& asked);

// Of what the engine does otherwise when it chooses, blends and fits cascades, and how wide their texels are.
std::vector<std::string> unexpressed_cascades(const Engine& engine, const AdvisedCascades& cascades);

// Of a field that is there once: what its greatest number is too much by in the cascade that needs least. Empty if all need
// the same. typed: of each cascade.
std::string one_for_all(std::string_view field, std::span<const double> typed);

}  // namespace noonmark
