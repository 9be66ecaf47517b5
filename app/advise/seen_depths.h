// How near and how far an engine's camera sees: its maps are laid over that range.
//
//   const SeenDepths seen = depths_in_views(bench, request.conditions);
#pragma once
#include <span>

#include "app/advise/engines/engine_settings.h"
#include "measure/workbench.h"

namespace noonmark {

// Of what these conditions show. Throws Error.
SeenDepths depths_in_views(Workbench& bench, std::span<const Settings> conditions);

}  // namespace noonmark
