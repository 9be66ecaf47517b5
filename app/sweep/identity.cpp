#include "app/sweep/identity.h"

#include <elf.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <link.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/build_facts.h"
#include "base/clock.h"
#include "base/error.h"
#include "scenes/library.h"
#include "scenes/scene_digest.h"
#include "technique/light_frame.h"

namespace noonmark {
namespace {

// The size of a field of an ELF note (head, name, contents), padded to 4 bytes.
size_t padded(size_t size) { return (size + 3) & ~size_t{3}; }

// Reads the note that ld --build-id writes.
std::string build_id_in(const char* notes, size_t size) {
  for (size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;) {
    ElfW(Nhdr) head;
    std::memcpy(&head, notes + at, sizeof head);
    const char* name = notes + at + sizeof head;
    const char* contents = name + padded(head.n_namesz);
    if (head.n_type == NT_GNU_BUILD_ID && std::string_view(name, head.n_namesz) == std::string_view("GNU", 4)) {
      std::string id;
      for (size_t i = 0; i < head.n_descsz; ++i) id += fmt::format("{:02x}", static_cast<unsigned char>(contents[i]));
      return id;
    }
    at += sizeof head + padded(head.n_namesz) + padded(head.n_descsz);
  }
  return "";
}

std::string build_id() {
  std::string id;
  dl_iterate_phdr(
      [](dl_phdr_info* object, size_t, void* out) {
        auto& found = *static_cast<std::string*>(out);
        for (int i = 0; i < object->dlpi_phnum && found.empty(); ++i) {
          const ElfW(Phdr)& segment = object->dlpi_phdr[i];
          if (segment.p_type == PT_NOTE)
            found = build_id_in(reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr), segment.p_memsz);
        }
        return 1;  // the first object is the program; the libraries follow
      },
      &id);
  return id.empty() ? "unknown" : id;
}

// "street.glb (45;0;...)": the scene's name, and all its other settings.
std::string scene_key(const Settings& point) {
  std::string others;
  for (const Setting& row : settings_table())
    if (row.name.starts_with("scene.") && row.name != "scene.name")
      others += (others.empty() ? "" : ";") + row.get(point);
  return fmt::format("{} ({})", point.scene.name, others);
}

}  // namespace

void SceneDigests::remember(Workbench& bench, const Settings& point) {
  // The same file with another triangulation has the same note, and many points have the same map.
  const auto note = [&](const std::string& text) {
    if (!text.empty() && std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
  };
  const Scene& scene = bench.scene(point.scene);
  for (const std::string& text : light_notes(scene, point)) note(text);
  const std::string key = scene_key(point);
  if (digests_.contains(key)) return;
  note(notes_line(scene));
  digests_[key] = bench.scene_identity(point.scene);
}

const std::string& SceneDigests::of(const Settings& point) const { return digests_.at(scene_key(point)); }

void SceneDigests::require_unchanged(Workbench& bench, const Settings& point) const {
  if (bench.scene_identity(point.scene) != of(point))
    throw Error(ErrorKind::file,
                fmt::format("{}: was changed while the sweep ran, so the points would be of different scenes; "
                            "do not change it during a run, and run again",
                            point.scene.name));
}

std::string host_cpu() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::vector<std::pair<std::string, std::string>> identity(Workbench& bench, const raytrace::TracerInfo& tracer,
                                                          const SceneDigests& scenes) {
  const gl::DeviceInfo& device = bench.device();
  std::vector<std::pair<std::string, std::string>> facts = {
      {"noonmark", fmt::format("{} {}", build_facts().version, build_facts().commit)},
      {"program", build_id()},
      {"opengl", fmt::format("{} {} {}", device.vendor, device.renderer, device.version)},
      {"embree", fmt::format("{} {}", tracer.version, tracer.isa)},
      {"machine", fmt::format("{}, glibc {}", host_cpu(), gnu_get_libc_version())},
  };
  for (const auto& [scene, digest] : scenes.all()) facts.emplace_back("scene " + scene, digest);
  return facts;
}

std::string facts_text(std::span<const std::pair<std::string, std::string>> facts) {
  std::string text;
  for (const auto& [name, value] : facts) text += fmt::format("{} = {}\n", name, value);
  return text;
}

namespace {

constexpr std::string_view machine_lines[] = {"opengl = ", "embree = ", "machine = "};

// `here` with each line of a machine replaced by use(the line, the same line of `there`). A line that becomes empty is left
// out.
template <class Use>
std::string with_machine_lines(const std::string& here, const std::string& there, const Use& use) {
  const auto line_of = [](const std::string& text, std::string_view name) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
      if (line.starts_with(name)) return line;
    return std::string();
  };
  std::string text;
  std::istringstream in(here);
  for (std::string line; std::getline(in, line);) {
    for (const std::string_view name : machine_lines)
      if (line.starts_with(name)) line = use(name, line, line_of(there, name));
    if (!line.empty()) text += line + "\n";
  }
  return text;
}

}  // namespace

std::string with_machine_of(const std::string& here, const std::string& there) {
  return with_machine_lines(here, there, [](std::string_view, const std::string& mine, const std::string& other) {
    return other.empty() ? mine : other;
  });
}

std::string with_both_machines(const std::string& here, const std::string& there) {
  return with_machine_lines(here, there, [](std::string_view name, const std::string& mine, const std::string& other) {
    return other.empty() || other == mine ? mine : std::string(name) + "several";
  });
}

std::string with_scene_names(const std::string& facts, const std::function<std::string(const std::string&)>& name_of) {
  constexpr std::string_view word = "scene ";
  std::string text;
  std::istringstream in(facts);
  for (std::string line; std::getline(in, line);) {
    // "scene NAME (its settings) = digest"; the settings and the digest have no " (".
    const size_t end = line.rfind(" (");
    if (line.starts_with(word) && end != line.npos && end >= word.size())
      line = std::string(word) + name_of(line.substr(word.size(), end - word.size())) + line.substr(end);
    text += line + "\n";
  }
  return text;
}

std::string without_machine(const std::string& facts) {
  return with_machine_lines(facts, "",
                            [](std::string_view, const std::string&, const std::string&) { return std::string(); });
}

Machine this_machine(const gl::DeviceInfo& device, const raytrace::TracerInfo& tracer) {
  char host[256] = "";
  if (gethostname(host, sizeof host - 1) != 0) host[0] = 0;
  return {.host = *host ? host : "unknown",
          .cpu = host_cpu(),
          .driver = fmt::format("{} {} {}", device.vendor, device.renderer, device.version),
          .ray_tracer = fmt::format("{} {}", tracer.version, tracer.isa),
          .clock = ""};
}

}  // namespace noonmark
