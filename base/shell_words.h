// Words of printed commands.
//
//   print("noonmark render --set " + shell_quoted("scene.name=" + name));
#pragma once
#include <string>

namespace noonmark {

// A word in a form that a shell reads back as the same word. Plain words stay unchanged, other words get single quotes.
// A word with bytes that a terminal does not show gets $'...' (bash, zsh, ksh, POSIX 2024). So printed commands can be
// pasted.
std::string shell_quoted(const std::string& word);

}  // namespace noonmark
