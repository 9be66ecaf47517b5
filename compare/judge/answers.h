// Which of several settings that hold their bounds to take: three answers between cost and error.
//
//   const std::optional<ThreeAnswers> answers = three_answers(points, std::nullopt);
//   if (answers) print(points[answers->least], points[answers->balanced], points[answers->best]);
#pragma once
#include <cstddef>
#include <optional>
#include <span>

namespace noonmark {

// Of settings that hold their bounds. Both are at least 0. An infinite or NaN value takes the settings out of the choice.
struct CostAndError {
  double cost = 0, error = 0;
};

// `best` may cost this factor of `least` if no budget is given.
inline constexpr double budget_of_least = 4;
// A step to dearer settings pays if it divides the error by more than this factor.
inline constexpr double error_that_pays = 1.5;

// Indices. Of equal costs the one of less error is taken, of equal errors the cheaper one, otherwise the first. So all three lie
// on the front: none is both dearer and less accurate than another.
struct ThreeAnswers {
  size_t least = 0;  // the cheapest
  size_t balanced =
      0;  // the most accurate one within the budget for which no cheaper one is within error_that_pays of its error
  size_t best = 0;    // the most accurate one within the budget
  double budget = 0;  // as given, or budget_of_least times the cost of `least`
};

// budget: the most cost. Empty if nothing costs at most that.
std::optional<ThreeAnswers> three_answers(std::span<const CostAndError> settings, std::optional<double> budget);

}  // namespace noonmark
