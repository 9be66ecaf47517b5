// The rows of the settings of lookup, filter and truth, for the table in technique/settings.cpp.
#include "technique/filters.h"
#include "technique/lookups.h"
#include "technique/setting_rows.h"
#include "technique/setting_rules.h"

namespace noonmark::setting_rows {

using namespace setting_rules;

#define MEMBER(path) [](Settings& s) -> decltype((s.path)) { return s.path; }

std::vector<Setting> lookup_rows() {
  std::vector<Setting> rows = {
      named("filter.kind", "The filter: where the lookup reads the map.", filters(), MEMBER(filter.kind))
          .refused(filter_of_another_map),
  };
  for (const KindParameter* parameter : FilterTable::parameters())
    rows.push_back(kind_row(filters(), *parameter, MEMBER(filter)));
  rows.push_back(
      named("lookup.kind", "How the lookup answers from what it reads in the map.", lookups(), MEMBER(lookup.kind))
          .refused(filtered_without_a_blur));
  for (const KindParameter* parameter : LookupTable::parameters()) {
    const Setting row = kind_row(lookups(), *parameter, MEMBER(lookup));
    if (parameter->name() == "level")
      rows.push_back(row.only_read_by({Stage::map, Stage::lookup}));  // LightFrame::texel_block
    else
      rows.push_back(parameter->of_blur ? row : row.only_read_by({Stage::ladder}));
  }
  return rows;
}

std::vector<Setting> truth_rows() {
  return {
      real("truth.standard_error", "", 1e-3, 0.5,
           "Largest standard error of R0 at a receiver, for a light with a size. A smaller value takes more rays.",
           MEMBER(truth.standard_error))
          .idle(without_size_of_light),
      choice("truth.method", {"auto", "rays"},
             "auto: what certified squares of the light's plane answer needs no ray, and the exact map of a flat map "
             "is found by scan conversion in double. rays: every answer comes from Embree's rays. The verdicts are the "
             "same; rays takes longer.",
             MEMBER(truth.method))
          .only_read_by({Stage::scene}),
      text("given.frame", "Which frame of another renderer is judged; only [[frame]] of an experiment gives it.",
           MEMBER(given.frame)),
  };
}

#undef MEMBER

}  // namespace noonmark::setting_rows
