// Settings that were given and change nothing: of another light, filter or bias than the one at hand.
#pragma once
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "technique/settings.h"

namespace noonmark {

struct IdleSetting {
  std::string name;  // "map.extent_m"
  std::string why;   // "on a point light"
};

// Every setting that differs from its default and is not read.
std::vector<IdleSetting> idle_settings(LightKind light, const Settings& settings);

}  // namespace noonmark
