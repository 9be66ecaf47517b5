// What a user probably meant by a wrong name, for the end of a message.
//
//   fmt::format("there is no verb '{}'{}", name, did_you_mean(name, verbs));   // "...; did you mean 'check'?"
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace noonmark {

// "; did you mean 'report' or 'render'?": the names that begin with `wrong` if there are one to three, else the nearest name
// (base/text.h). Empty if no name is near enough.
std::string did_you_mean(std::string_view wrong, std::span<const std::string_view> names);

}  // namespace noonmark
