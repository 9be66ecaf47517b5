// Addresses in the pages. Names, folders and addresses come from files of unknown origin, and a browser runs an address
// such as javascript:... as code. So every link that is not an anchor of the page itself goes through these functions.
#pragma once
#include <string>
#include <string_view>

#include "compare/report/element.h"

namespace noonmark::report {

// A link to a file beside the page, and its address, for src. path: relative to the page, any bytes.
Markup file_link(std::string_view path, const Markup& content);
std::string file_address(std::string_view path);

}  // namespace noonmark::report
