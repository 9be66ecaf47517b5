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

// Prints what to type into the engines that are shown, each with what it gave in the engine itself, if it was tried there; where the
// lines of the others are; what to know of the scenes; and which files are written. shown: engine_word(). no_lines: why there are
// no lines; empty: there are.
void print_advice(const Advice& advice, const std::vector<EngineAdvice>& engines, std::span<const std::string> shown,
                  const std::string& no_lines, Workbench& bench, const std::string& out);

}  // namespace noonmark
