// What `noonmark recommend` says of an answer, on the terminal and in a file.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "app/advise/engines/engine_settings.h"
#include "app/advise/recommend.h"

namespace noonmark {

// Of recommended.txt: the whole text of an answer, also why what is simpler does not do.
std::string whole_text(const Advice& advice);

// Prints, for each engine in `shown`, the lines to type into it, and the error that the engine itself had with them if it was
// run. Then it prints where the lines of the other engines are, notes about the scenes, and the files that are written.
// shown: names as engine_word() gives them. no_lines: the reason if there are no lines; otherwise empty.
void print_advice(const Advice& advice, const std::vector<EngineAdvice>& engines, std::span<const std::string> shown,
                  const std::string& no_lines, Workbench& bench, const std::string& out);

}  // namespace noonmark
