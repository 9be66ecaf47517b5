// Joins the stores of shares, measured by noonmark run --shard, into one, and judges it as one run would be.
//
//   Merged merged = merge_stores({"out/x/share-1-of-2", "out/x/share-2-of-2"}, ResultsFolder("out/x", ""), false);
//   merged.missing;  // what no share has measured
#pragma once
#include <string>
#include <vector>

#include "app/definition/experiment.h"
#include "app/sweep/results_folder.h"
#include "compare/results/records.h"

namespace noonmark {

struct Merged {
  Experiment experiment;
  Results results;                   // judged
  std::vector<std::string> missing;  // sentences, each with the command that measures it; empty: all is there
  std::vector<std::string> notes;
  int64_t shared = 0;  // points that more than one store has; they agree
};

// Throws Error(usage), before anything in `out` is touched, if `out` is one of the shares, or (unless overwrite) has a store
// that is no joined one or one of another experiment; and before anything but an earlier verdict is touched, if a folder has no
// store, or if a store has other points, another version of Noonmark or another scene than the first. Throws Error(defect) with both values if a point that two stores have
// differs in more than times; then there is no joined store. Otherwise writes results.sqlite, results.csv, report.html,
// junit.xml, summary.md and the points' pictures. Of a point that several stores have, the first store's times are kept.
Merged merge_stores(const std::vector<std::string>& shares, const ResultsFolder& out, bool overwrite);

}  // namespace noonmark
