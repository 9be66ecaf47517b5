// Settings that are each in their range and do not go together.
#pragma once
#include "technique/settings.h"

namespace noonmark {

// What no single row can see: near < far, kernel odd and the like. Throws Error(usage).
void validate(const Settings& settings);

// What only the kind of light can tell: filters and biases that need a flat map, or a cube. Throws Error(usage).
void validate_for(LightKind kind, const Settings& settings);

}  // namespace noonmark
