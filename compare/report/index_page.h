// The page that `check FOLDER` leaves: one row for each experiment, with its verdict and a link to its report.
//
//   write_file_atomically(out + "/index.html", index_page(entries, version));
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "compare/judge/verdict.h"
#include "compare/results/records.h"

namespace noonmark {

struct IndexEntry {
  std::optional<Verdict> verdict;  // empty: not judged
  std::string experiment;          // path as given
  std::string title;
  std::string report;   // the report's path below the index page; empty if there is none
  std::string words;    // the verdict's sentence and what is broken, with its value; or why nothing was judged
  std::string numbers;  // the worst numbers in words; may be empty
};

// "error at most 3.1 %, acne at most 0.2 %": the largest error, acne and Peter Panning over all points. Values that are
// not finite are said.
std::string worst_numbers(const Results& results);

// "Acne is 0.83 % where at most 0.5 % is allowed, at resolution 2048 texels.": the first broken bound. Empty if none is broken.
std::string broken_in_words(const Results& results);

// One HTML file without scripts and without other files. Broken experiments come first, then those that were not judged.
std::string index_page(const std::vector<IndexEntry>& entries, const std::string& version);

// "12 experiments: 10 held, 1 broken, 1 not judged".
std::string index_words(const std::vector<IndexEntry>& entries);

}  // namespace noonmark
