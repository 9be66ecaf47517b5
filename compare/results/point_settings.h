// The settings with which a point was measured, from the texts of its record.
#pragma once
#include "compare/results/records.h"
#include "technique/settings.h"

namespace noonmark {

// A setting that the record does not have keeps its default. Throws Error for a text that the setting cannot have.
Settings settings_of(const PointRecord& point);

}  // namespace noonmark
