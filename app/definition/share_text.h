// Shares as people write them: 0.005 or 0.5%.
//
//   share_from("0.5%");        // 0.005
//   above_every_share(5, "5"); // "5 is above every share; did you mean 0.05 or \"5%\"?"
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace noonmark {

// A number, or a number of percent. Empty if the text is neither, or not finite.
std::optional<double> share_from(std::string_view text);

// A share in percent: "0.1%".
std::string percent_text(double share);

// value: above 1, as it was written in `text`. Shares are at most 1, so percent were meant.
std::string above_every_share(double value, std::string_view text);

}  // namespace noonmark
