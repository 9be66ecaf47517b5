// The settings with which a point was measured, from the texts of its record.
#pragma once
#include "compare/results/records.h"
#include "technique/settings.h"

namespace noonmark {

struct LookupKind;

// A setting that the record does not have keeps its default. Throws Error for a text that the setting cannot have.
Settings settings_of(const PointRecord& point);
// The row of the record's lookup in a filtered map; null if it compares depths, or is not known.
const LookupKind* filtered_lookup_of(const PointRecord& point);

}  // namespace noonmark
