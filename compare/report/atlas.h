// The page of the atlas of failures: a matrix of failure and technique with verdict, cliff, cure and picture.
//
//   write_file_atomically(out + "/atlas.html", to_atlas_page(rows, version));
#pragma once
#include <span>
#include <string>
#include <vector>

#include "compare/judge/atlas.h"

namespace noonmark {

struct AtlasRow {
  AtlasEntry entry;
  std::string report;   // path of the row's report, relative to the page
  std::string picture;  // path of a picture of its worst point, relative to the page; empty: none
  std::string command;  // the command that checks the row
  bool held = false;    // every bound and law of the row held
  std::vector<AtlasCell> cells;
  std::vector<LawResult> laws;  // the predictions of the row
};

// One HTML file without scripts. A row stands in the order given; a column is a technique, in the order in which the
// rows name them; a technique that a row does not try has an empty cell.
std::string to_atlas_page(std::span<const AtlasRow> rows, const std::string& version);

// The same matrix as a Markdown table, one line for each failure: for a README or a summary of CI.
std::string to_atlas_table(std::span<const AtlasRow> rows);

}  // namespace noonmark
