#include "base/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

namespace noonmark {
namespace {

std::optional<uint64_t> first_number(const std::string& path) {
  std::ifstream file(path);
  uint64_t value = 0;
  return file >> value ? std::optional(value) : std::nullopt;  // "max" is no number: no limit
}

// The value of a line "name value" or "name: value kB".
std::optional<uint64_t> named_number(const std::string& path, std::string_view name) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string first;
    uint64_t value = 0;
    if (words >> first && first == name && words >> value) return value;
  }
  return std::nullopt;
}

struct GroupFiles {
  const char *limit, *used, *cache;
};
constexpr GroupFiles version_1 = {"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};
constexpr GroupFiles version_2 = {"memory.max", "memory.current", "inactive_file"};

// Of the group at `folder`; none where it has no limit or cannot be read.
std::optional<uint64_t> left_in_group(const std::string& folder, const GroupFiles& files) {
  const auto limit = first_number(folder + "/" + files.limit), used = first_number(folder + "/" + files.used);
  if (!limit || !used) return std::nullopt;
  const uint64_t cache = std::min(*used, named_number(folder + "/memory.stat", files.cache).value_or(0));
  const uint64_t held = *used - cache;
  return *limit > held ? *limit - held : 0;
}

}  // namespace

std::string AvailableMemory::text() const {
  return fmt::format("{} are available ({})", bytes_text(static_cast<double>(bytes)), limit);
}

AvailableMemory free_memory(const std::string& root) {
  AvailableMemory least;
  const auto limit = [&](std::optional<uint64_t> bytes, const std::string& what) {
    if (bytes && *bytes < least.bytes) least = {*bytes, what};
  };
  if (const auto kilobytes = named_number(root + "/proc/meminfo", "MemAvailable:"))
    limit(*kilobytes * 1024, "the machine's free memory");

  // Lines "hierarchy:controllers:path"; version 2 is hierarchy 0. Inside a container the path may be the host's, and
  // then the group that is mounted at the top is the one that counts: it is asked too.
  std::ifstream groups(root + "/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == line.npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const bool unified = controllers == ",,";
    if (!unified && controllers.find(",memory,") == controllers.npos) continue;
    for (std::string path = line.substr(second + 1);; path.resize(path.rfind('/'))) {
      if (path == "/") path.clear();
      const std::string top = root + "/sys/fs/cgroup";
      for (const std::string& mount : unified ? std::vector{top, top + "/unified"} : std::vector{top + "/memory"})
        limit(left_in_group(mount + path, unified ? version_2 : version_1), "the control group's limit");
      if (path.rfind('/') == path.npos) break;
    }
  }
  return least;
}

AvailableMemory free_address_space(const std::string& root) {
  struct rlimit space {};
  if (getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur == RLIM_INFINITY) return {};
  const uint64_t used =
      first_number(root + "/proc/self/statm").value_or(0) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
  return {space.rlim_cur > used ? space.rlim_cur - used : 0, "the limit of the address space, ulimit -v"};
}

AvailableMemory available_memory(const std::string& root) {
  const AvailableMemory memory = free_memory(root), space = free_address_space(root);
  return space.bytes < memory.bytes ? space : memory;
}

uint64_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  uint64_t size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

std::string bytes_text(double bytes) {
  for (const char* unit : {"bytes", "kB", "MB", "GB"}) {
    if (bytes < 999.5) return fmt::format("{:.{}f} {}", bytes, bytes < 9.95 ? 1 : 0, unit);
    bytes /= 1000;
  }
  return fmt::format("{:.{}f} TB", bytes, bytes < 9.95 ? 1 : 0);
}

}  // namespace noonmark
