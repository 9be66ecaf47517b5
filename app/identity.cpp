#include "app/identity.h"

#include <elf.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "app/build_facts.h"
#include "scenes/error.h"
#include "scenes/library.h"
#include "scenes/scene_digest.h"

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
  const std::string key = scene_key(point);
  if (digests_.contains(key)) return;
  digests_[key] = bench.scene_identity(point.scene);
  // The same file with another triangulation has the same note.
  if (const std::string note = notes_line(bench.scene(point.scene));
      !note.empty() && std::find(notes_.begin(), notes_.end(), note) == notes_.end())
    notes_.push_back(note);
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

std::vector<std::pair<std::string, std::string>> identity(Workbench& bench, std::span<const Settings> points,
                                                          const raytrace::TracerInfo& tracer, SceneDigests& scenes) {
  const gl::DeviceInfo& device = bench.device();
  std::vector<std::pair<std::string, std::string>> facts = {
      {"noonmark", fmt::format("{} {}", build_facts().version, build_facts().commit)},
      {"program", build_id()},
      {"opengl", fmt::format("{} {} {}", device.vendor, device.renderer, device.version)},
      {"embree", fmt::format("{} {}", tracer.version, tracer.isa)},
      {"machine", fmt::format("{}, glibc {}", host_cpu(), gnu_get_libc_version())},
  };
  for (const Settings& point : points) scenes.remember(bench, point);
  for (const auto& [scene, digest] : scenes.all()) facts.emplace_back("scene " + scene, digest);
  return facts;
}

std::string facts_text(std::span<const std::pair<std::string, std::string>> facts) {
  std::string text;
  for (const auto& [name, value] : facts) text += fmt::format("{} = {}\n", name, value);
  return text;
}

}  // namespace noonmark
