// The tables of the store that hold phase diagrams: phases, phase_rows, phase_cells and phase_points. The first column of
// each is the number of the diagram, which is the number of its part in the experiment.
#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "compare/results/phase_record.h"

namespace noonmark {

namespace sqlite {
class Database;
}

// The SQL that makes them.
std::string phase_tables();

void add_phase_rows(sqlite::Database& db, int64_t phase, const PhaseDiagram& diagram);
// Throws std::exception if the rows contradict each other.
std::map<int64_t, PhaseDiagram> load_phase_rows(sqlite::Database& db);

}  // namespace noonmark
