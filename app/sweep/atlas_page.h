// Collects the rows of the atlas while `check` judges experiments, and writes its page.
//
//   AtlasPage page("out");
//   page.add(experiment, "out/grazing-sun", results, held);
//   page.write();    // out/atlas.html, out/atlas.md
#pragma once
#include <string>
#include <vector>

#include "app/definition/experiment.h"
#include "compare/report/atlas.h"

namespace noonmark {

class AtlasPage {
 public:
  // folder: where the page is written.
  explicit AtlasPage(std::string folder) : folder_(std::move(folder)) {}
  // Adds a row if the experiment has an [atlas] section. out: the folder of its results. held: whether all its bounds and
  // laws held.
  void add(const Experiment& experiment, const std::string& out, const Results& results, bool held);
  // Writes the page if there is a row. Returns the line that says where it is; empty: there is no page.
  std::string write() const;

 private:
  std::string folder_;
  std::vector<AtlasRow> rows_;
};

}  // namespace noonmark
