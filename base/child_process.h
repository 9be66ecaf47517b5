// Runs another program and waits for it.
//
//   if (const auto node = find_program("node")) run_program({*node, "shoot.mjs"}, "out/shoot.log");
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace noonmark {

// The path of a program: as it is given if it has a "/", otherwise in the first folder of PATH that has it. Empty if there is
// none that may be executed.
std::optional<std::string> find_program(const std::string& name);

// The path of the program that runs now, with links resolved. Empty if the system does not say.
std::string own_program();

// Starts arguments[0], which is a path, with these arguments. What it prints on both streams goes to the file `log`, and each line,
// without its end, soon after it is printed to `said`. Returns its exit code, or minus the signal that ended it. Throws Error if it
// cannot be started or its log cannot be written.
// The program and all that it starts are a process group of their own. What is left of the group when the program has ended is
// killed. When this process ends first, in whatever way, the group gets SIGTERM, and a second later SIGKILL.
int run_program(const std::vector<std::string>& arguments, const std::string& log,
                const std::function<void(const std::string&)>& said = {});

}  // namespace noonmark
