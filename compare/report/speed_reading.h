// What the chart of cost against error says of one cost and one error: a curve for each technique, the front, the three answers,
// and which technique errs least at which cost.
//
//   const SpeedReadings readings(group, results);
//   const SpeedReading reading = readings.of("texel_work", "error_soft", AtBias::best);
//   for (const Phrase& phrase : readings.takeovers(reading, names)) page += phrase.text;
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/judge/answers.h"
#include "compare/judge/least_error.h"
#include "compare/judge/techniques.h"
#include "compare/judge/tradeoff.h"
#include "compare/report/cause_shares.h"
#include "compare/report/speed.h"
#include "compare/results/records.h"

namespace noonmark::report {

// All are indices of the group's choices.
struct SpeedReading {
  std::string cost, error;
  AtBias at = AtBias::best;
  // Of each technique its choices, ascending in the scale: those that count (counts_by), of several with the same value of the
  // scale the one of least error.
  std::vector<std::vector<size_t>> curves;
  std::vector<size_t> front;  // front_of()
  // Of the techniques that have a choice on the front; CheapestStretch::curve is the technique.
  std::vector<CheapestStretch> stretches;
  // Of the choices that count and are good enough; of all that count if none is. Empty while the sweep is incomplete.
  std::optional<ThreeAnswers> answers;
};

// A part of a sentence; the names of techniques stand out.
struct Phrase {
  std::string text;
  bool is_name = false;
};

// For one thread at a time.
class SpeedReadings {
 public:
  // The group must live longer.
  SpeedReadings(const ComparedGroup& group, const Results& results);
  // The same where techniques_of() is known already.
  SpeedReadings(const ComparedGroup& group, Techniques techniques, const Results& results);

  SpeedReading of(const std::string& cost, const std::string& error, AtBias at) const;
  const Techniques& techniques() const { return techniques_; }

  // "Least error by texel work: A up to 1 200 000; B above." Of one technique that errs least at every cost also the next one and,
  // of error and error_soft, why: of which cause that has more. Empty if there is one technique or no front.
  std::vector<Phrase> takeovers(const SpeedReading& reading, const ChoiceNames& names) const;

 private:
  std::string name_of(size_t technique, const ChoiceNames& names) const;
  std::vector<Phrase> why(const SpeedReading& reading, const ChoiceNames& names) const;
  // Where each choice stands; the error is NaN where the choice does not count.
  std::vector<FrontPoint> plane(const std::string& cost, const std::string& error, AtBias at) const;

  const ComparedGroup& group_;
  Techniques techniques_;
  bool is_incomplete_ = false;
  // Of each choice. A page reads all pairs of its costs and errors, so each is asked for many times.
  mutable std::map<std::string, std::vector<MedianInterval>> costs_;
  mutable std::map<std::pair<std::string, AtBias>, std::vector<double>> errors_;
};

// The points of the three answers of every group, for RunInfo::cost and error_shown_first(), each at the condition that is worst;
// those of the first group first. Each id once.
std::vector<int64_t> answer_points(const std::vector<ComparedGroup>& groups, const Results& results);
// The same where techniques_of() of each group is known already.
std::vector<int64_t> answer_points(const std::vector<ComparedGroup>& groups, const std::vector<Techniques>& techniques,
                                   const Results& results);

}  // namespace noonmark::report
