// The tornado chart of a recommendation: what each setting does around it.
//
//   write_file_atomically(out + "/recommended.html", to_tornado_page(tornado, version));
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace noonmark {

// One value of a setting, all others as recommended.
struct TornadoEnd {
  std::string value;    // canonical text
  double error = 0;     // the largest over conditions and placements, a fraction
  bool held = false;    // the bounds hold under every condition and at every placement
  std::string why_not;  // why it was not measured; empty: it was
};

struct TornadoRow {
  std::string setting, unit;  // "map.resolution", "texels"
  std::string value;          // the recommended one
  TornadoEnd half, twice;
  // The least and the largest value at which the bounds hold, without a gap to the recommended one. open: the bounds still
  // hold there, and no value beyond it was tried.
  TornadoEnd low, high;
  bool low_open = false, high_open = false;
};

struct Tornado {
  double error = 0;      // of the recommended settings
  bool held = false;     // these keep the bounds
  std::string accuracy;  // the metric of all errors
  int placements = 1;    // of the grid, or turns of a cube, for each condition
  size_t conditions = 1;
  bool placed = true;            // the error is the largest over the placements too
  std::vector<TornadoRow> rows;  // the largest change of the error at half or double first
};

// One sentence for each row, and one before them.
std::vector<std::string> tornado_text(const Tornado& tornado);

// One HTML file without scripts: the chart, and all its numbers as a table.
std::string to_tornado_page(const Tornado& tornado, const std::string& version);

}  // namespace noonmark
