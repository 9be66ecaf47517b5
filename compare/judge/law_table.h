// The laws and their verdicts as text for a terminal.
#pragma once
#include <span>
#include <string>

#include "compare/results/records.h"

namespace noonmark {

// A table for a terminal: law, points, predicted, measured, deviation, verdict. Below each broken law it shows the
// worst sample and the command that reproduces it.
std::string law_table(std::span<const LawResult> laws);

}  // namespace noonmark
