#include "compare/store/phase_tables.h"

#include <stdexcept>

#include "compare/store/table.h"

namespace noonmark {
namespace {

using sqlite::Database;

// What a row of phase_cells holds: the bias, then the row's series at this bias.
struct Cell {
  std::vector<double> values = std::vector<double>(1 + phase_series().size());
};

const Table<PhaseDiagram>& diagrams_table() {
  using D = PhaseDiagram;
  static const Table<D> table(
      "phases", {"phase"},
      {column("part", &D::part), column("refused", &D::refused), column("made_from", &D::made_from),
       column("scene", &D::scene), column("light", &D::light), column("technique", &D::technique),
       column("render", &D::render), column("width_px", &D::width_px), column("height_px", &D::height_px),
       column("placements", &D::placements), column("receivers", &D::receivers),
       column("acne_bound", static_cast<double D::*>(&D::acne_bound)),
       column("peter_panning_bound", static_cast<double D::*>(&D::peter_panning_bound)), column("range_m", &D::range_m),
       column("metres_per_bias", &D::metres_per_bias), column("law_at_bound", &D::law_at_bound),
       column("law_steepest", &D::law_steepest)});
  return table;
}

const Table<PhaseRow>& rows_table() {
  static const Table<PhaseRow> table(
      "phase_rows", {"phase", "i"},
      {column("resolution", &PhaseRow::resolution), column("texel_m", &PhaseRow::texel_m),
       column("last_acne_m", &PhaseRow::last_acne_m)});
  return table;
}

const Table<Cell>& cells_table() {
  static const Table<Cell> table("phase_cells", {"phase", "row", "i"}, [] {
    std::vector<Column<Cell>> columns;
    const auto add = [&](std::string_view name, size_t index) {
      columns.push_back(
          {name, "REAL",
           [index](sqlite::Statement& row, int at, const Cell& cell) { row.bind(at, cell.values[index]); },
           [index](const sqlite::Statement& row, int at, Cell& cell) { cell.values[index] = row.real(at); }});
    };
    add("bias_m", 0);
    for (size_t i = 0; i < phase_series().size(); ++i) add(phase_series()[i].name, i + 1);
    return columns;
  }());
  return table;
}

const Table<PhasePoint>& points_table() {
  static const Table<PhasePoint> table(
      "phase_points", {"phase", "i"},
      {column("point", &PhasePoint::point), column("texel_m", &PhasePoint::texel_m),
       column("bias_m", &PhasePoint::bias_m), column("left_out", &PhasePoint::left_out)});
  return table;
}

}  // namespace

std::string phase_tables() {
  return diagrams_table().create() + rows_table().create() + cells_table().create() + points_table().create();
}

void add_phase_rows(Database& db, int64_t phase, const PhaseDiagram& diagram) {
  Table<PhaseDiagram>::Insert(db, diagrams_table()).row({phase}, diagram);
  Table<PhaseRow>::Insert rows(db, rows_table());
  Table<Cell>::Insert cells(db, cells_table());
  for (size_t r = 0; r < diagram.rows.size(); ++r) {
    const PhaseRow& row = diagram.rows[r];
    const auto index = static_cast<int64_t>(r);
    rows.row({phase, index}, row);
    for (const PhaseSeries& series : phase_series())
      if ((row.*series.values).size() != diagram.bias_m.size())
        throw std::logic_error("a series of a phase diagram has another length than its biases");
    for (size_t i = 0; i < diagram.bias_m.size(); ++i) {
      Cell cell;
      cell.values[0] = diagram.bias_m[i];
      for (size_t s = 0; s < phase_series().size(); ++s) cell.values[s + 1] = (row.*phase_series()[s].values)[i];
      cells.row({phase, index, static_cast<int64_t>(i)}, cell);
    }
  }
  Table<PhasePoint>::Insert points(db, points_table());
  for (size_t i = 0; i < diagram.points.size(); ++i) points.row({phase, static_cast<int64_t>(i)}, diagram.points[i]);
}

std::map<int64_t, PhaseDiagram> load_phase_rows(Database& db) {
  std::map<int64_t, PhaseDiagram> diagrams;
  diagrams_table().read(
      db, [&](std::span<const int64_t> key, PhaseDiagram diagram) { diagrams.emplace(key[0], std::move(diagram)); });
  rows_table().read(
      db, [&](std::span<const int64_t> key, PhaseRow row) { diagrams.at(key[0]).rows.push_back(std::move(row)); });
  cells_table().read(db, [&](std::span<const int64_t> key, Cell cell) {
    PhaseDiagram& diagram = diagrams.at(key[0]);
    if (key[1] == 0) diagram.bias_m.push_back(cell.values[0]);
    for (size_t s = 0; s < phase_series().size(); ++s)
      (diagram.rows.at(static_cast<size_t>(key[1])).*phase_series()[s].values).push_back(cell.values[s + 1]);
  });
  points_table().read(db, [&](std::span<const int64_t> key, PhasePoint point) {
    diagrams.at(key[0]).points.push_back(std::move(point));
  });
  for (const auto& [id, diagram] : diagrams) {
    if (diagram.rows.empty() != !diagram.refused.empty())
      throw std::runtime_error("a phase diagram without rows and without the reason");
    if (!diagram.rows.empty() && diagram.bias_m.size() < 2)
      throw std::runtime_error("a phase diagram with fewer than two biases");
    for (const PhaseRow& row : diagram.rows)
      for (const PhaseSeries& series : phase_series())
        if ((row.*series.values).size() != diagram.bias_m.size())
          throw std::runtime_error("a phase diagram whose rows have other biases than the first");
  }
  return diagrams;
}

}  // namespace noonmark
