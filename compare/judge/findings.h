// What the results say, read once. Every printer (the page, summary.md, junit.xml, JSON, annotations, the terminal) prints it, and
// decides nothing itself.
//
//   const Findings found(results);
//   fmt::print("{}\n", found.sentence);
//   for (const Promise& one : found.promises) if (one.state == Promise::State::broken) fmt::print("{}", one.text);
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "compare/judge/recommendation.h"
#include "compare/judge/techniques.h"
#include "compare/judge/tradeoff.h"
#include "compare/judge/verdict.h"
#include "compare/results/records.h"

namespace noonmark {

// What is promised, and what became of it.
struct Promise {
  enum class Of { delivery, bound, law, baseline } of;
  enum class State { held, warning, broken, refused } state;
  std::string title;                          // "acne <= 1%"; it can hold any bytes of a file, as the next two can
  std::string found;                          // in one line: "found 3%"
  std::string text;                           // all that is known of it, in lines
  std::string location;                       // where the experiment gives it: "file:line:column"; empty: not known
  const PointRecord* point = nullptr;         // where it is worst; null: at none
  std::optional<PointRecord::WorstOf> pixel;  // there, of what is broken and has one
};
// "held", "warning", "broken", "refused"
std::string_view word_of(Promise::State state);
std::vector<Promise> promises_of(const Results& results);

// What a reader must know beside the numbers: a clause without its full stop.
struct Note {
  enum class Of {
    picture,   // a point's picture says little: a doubt about the numbers
    sweep,     // a swept setting that nothing reads, or points of several machines that are joined
    machines,  // which ones they are
    scene
  } of;
  std::string text;
  bool warns() const { return of == Of::picture || of == Of::sweep; }
};

// It refers to the results.
struct Findings {
  // Implicit: wherever findings are asked for, results have them.
  Findings(const Results& of);

  const Results& all;
  Verdict verdict;
  std::string sentence;           // verdict_sentence()
  std::vector<Promise> promises;  // deliveries of frames, bounds, laws, the baseline
  std::vector<Note> notes;
  const LawResult* headline = nullptr;  // the first law with a sentence of its own (LawResult::found); null: none
  // The answer, and what it was chosen from. Of thousands of choices this takes its time.
  std::vector<ComparedGroup> groups;
  std::vector<Techniques> techniques;  // of each group
  Recommendation recommended;          // recommend()
};

}  // namespace noonmark
