// What an engine gives with its lines, promised and measured, for recommended.json. Only source files include it, because the JSON
// library's header is large.
#pragma once
#include <nlohmann/json.hpp>

#include "app/advise/engines/engine_settings.h"

namespace noonmark {

nlohmann::json promise_json(const EnginePromise& promise);
nlohmann::json trial_json(const EngineTrial& trial);

}  // namespace noonmark
