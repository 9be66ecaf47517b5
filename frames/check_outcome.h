// What one check of a frame finds, and the checks: of places (frames/place_checks.cpp), of values (frames/value_checks.cpp) and
// of samples (frames/sample_checks.cpp). The rows stand in frames/checks.cpp.
#pragma once
#include <string>
#include <string_view>
#include <utility>

#include "frames/check_statistics.h"
#include "frames/checks.h"

namespace noonmark {

// A region is judged by at least so many pixels.
inline constexpr size_t enough = 100;

struct Outcome {
  CheckState state = CheckState::passed;
  std::string says;
  // Of a failure that spoils what the checks below it read: what they say in place of a second failure.
  std::string_view spoils = {};
};
inline Outcome passed(std::string says) { return {CheckState::passed, std::move(says)}; }
inline Outcome failed(std::string says, std::string_view spoils = {}) {
  return {CheckState::failed, std::move(says), spoils};
}
inline Outcome not_checked(std::string why) { return {CheckState::not_checked, std::move(why)}; }

Outcome check_positions(const CheckEvidence& e, const FrameStatistics&);
Outcome check_alignment(const CheckEvidence& e, const FrameStatistics&);
Outcome check_coverage(const CheckEvidence& e, const FrameStatistics&);

Outcome check_values(const CheckEvidence& e, const FrameStatistics&);
Outcome check_inverted(const CheckEvidence&, const FrameStatistics& s);
Outcome check_shaded(const CheckEvidence&, const FrameStatistics& s);
Outcome check_intensity(const CheckEvidence& e, const FrameStatistics& s);
Outcome check_match(const CheckEvidence& e, const FrameStatistics& s);
Outcome check_encoding(const CheckEvidence&, const FrameStatistics& s);
Outcome check_levels(const CheckEvidence& e, const FrameStatistics&);

Outcome check_samples(const CheckEvidence& e, const FrameStatistics&);

}  // namespace noonmark
