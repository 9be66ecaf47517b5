// A simulated disk that loses power. It replays what a program did to its files (tests/program/disk_trace.h) and makes
// the states that are possible afterwards. It guarantees what POSIX guarantees and no more:
// - Bytes are certain only if their file was synced after they were written. Until then each sector of each write may
//   be there or not. If a file grew, the part that was not written may contain anything.
// - A name is certain (made, moved or removed) only if its folder was synced. Until then any number of the first
//   changes to the folder may have happened, in their order, as on every file system with a journal.
#pragma once
#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/file.h"
#include "tests/program/disk_trace.h"

namespace noonmark::test {

namespace fs = std::filesystem;

struct DiskStep : DiskRecord {
  std::string path, data;
};

inline std::vector<DiskStep> read_trace(const std::string& log) {
  const std::string bytes = read_file(log);
  std::vector<DiskStep> steps;
  for (size_t at = 0; at < bytes.size();) {
    DiskStep step;
    std::memcpy(static_cast<DiskRecord*>(&step), bytes.data() + at, sizeof(DiskRecord));
    at += sizeof(DiskRecord);
    step.path = bytes.substr(at, step.path_size);
    at += step.path_size;
    step.data = bytes.substr(at, step.data_size);
    at += step.data_size;
    steps.push_back(std::move(step));
  }
  return steps;
}

class LossyDisk {
 public:
  // root: the folder of the trace. Before the trace it exists on the disk and is empty.
  explicit LossyDisk(const std::string& root) : root_(fs::path(root).lexically_normal().string()) {
    struct stat status {};
    ::stat(root.c_str(), &status);
    folders_[status.st_ino] = root_;
  }

  void play(const DiskStep& step) {
    const std::string path = fs::path(step.path).lexically_normal().string();
    switch (step.op) {
      case DiskOp::create:
        files_[step.inode] = names_now_[path] = std::make_shared<File>();
        changes_.push_back({path, "", names_now_[path]});
        break;
      case DiskOp::folder:
        folders_[step.inode] = path;
        changes_.push_back({path, "", nullptr});
        break;
      case DiskOp::rename: {
        const std::string to = fs::path(step.data).lexically_normal().string();
        names_now_[to] = names_now_.at(path);
        names_now_.erase(path);
        changes_.push_back({path, to, nullptr});
        break;
      }
      case DiskOp::remove:
        names_now_.erase(path);
        changes_.push_back({"", path, nullptr});
        break;
      case DiskOp::write:
      case DiskOp::truncate:
        files_.at(step.inode)->pending.push_back(step);
        break;
      case DiskOp::sync:
        if (folders_.contains(step.inode)) {
          sync_folder(folders_.at(step.inode));
        } else {
          File& file = *files_.at(step.inode);
          for (const DiskStep& write : file.pending) apply(file.durable, write);
          file.pending.clear();
        }
        break;
      case DiskOp::said:
        break;
    }
  }

  // The files as the program sees them, with nothing lost.
  std::map<std::string, std::string> whole() const {
    std::map<std::string, std::string> files;
    for (const auto& [path, file] : names_now_) {
      std::string bytes = file->durable;
      for (const DiskStep& write : file->pending) apply(bytes, write);
      files[path] = bytes;
    }
    return files;
  }

  // Writes one of the states that are possible after a power cut below another folder.
  void cut_power(const std::string& into, std::mt19937& random) const {
    Names names = names_;
    const size_t happened = std::uniform_int_distribution<size_t>(0, changes_.size())(random);
    for (size_t i = 0; i < happened; ++i) apply(names, changes_[i]);
    const auto moved = [&](const std::string& path) { return into + path.substr(root_.size()); };
    for (const auto& [path, file] : names) {  // a folder comes before what is in it
      // If the name of a folder was lost, its contents are lost too.
      if (!fs::is_directory(fs::path(moved(path)).parent_path())) continue;
      if (!file) {
        fs::create_directory(moved(path));
        continue;
      }
      std::string bytes = file->durable;
      const int kept = std::uniform_int_distribution(0, 3)(random);  // none, all, or some of what was not synced
      for (const DiskStep& write : file->pending) {
        if (kept == 0) continue;
        if (kept == 1)
          apply(bytes, write);
        else
          apply_in_part(bytes, write, random);
      }
      write_plainly(moved(path), bytes);
    }
  }

 private:
  struct File {
    std::string durable;
    std::vector<DiskStep> pending;
  };
  using Names = std::map<std::string, std::shared_ptr<File>>;  // a folder has no file
  struct Change {  // {path, "", file}: made; {from, to}: moved; {"", path}: removed
    std::string path, other;
    std::shared_ptr<File> file;
  };

  static std::string changed_folder(const Change& change) {
    return fs::path(change.path.empty() ? change.other : change.path).parent_path().string();
  }
  static void apply(Names& names, const Change& change) {
    if (change.other.empty()) {
      names[change.path] = change.file;
    } else if (change.path.empty()) {
      names.erase(change.other);
    } else {
      names[change.other] = names.at(change.path);
      names.erase(change.path);
    }
  }
  static void apply(std::string& bytes, const DiskStep& step) {
    if (step.op == DiskOp::truncate) return bytes.resize(step.offset);
    if (bytes.size() < step.offset + step.data.size()) bytes.resize(step.offset + step.data.size());
    bytes.replace(step.offset, step.data.size(), step.data);
  }
  static void apply_in_part(std::string& bytes, const DiskStep& step, std::mt19937& random) {
    const auto coin = [&] { return (random() & 1) != 0; };
    if (step.op == DiskOp::truncate) {
      if (coin()) bytes.resize(step.offset);
      return;
    }
    constexpr size_t sector = 512;
    const size_t end = step.offset + step.data.size();
    if (bytes.size() < end && coin()) bytes.resize(end, coin() ? '\x55' : '\0');
    for (size_t at = step.offset; at < end && at < bytes.size();) {
      const size_t next = std::min({end, (at / sector + 1) * sector, bytes.size()});
      if (coin()) bytes.replace(at, next - at, step.data, at - step.offset, next - at);
      at = next;
    }
  }
  void sync_folder(const std::string& folder) {
    std::vector<Change> later;
    for (Change& change : changes_) {
      if (changed_folder(change) == folder)
        apply(names_, change);
      else
        later.push_back(std::move(change));
    }
    changes_ = std::move(later);
  }
  static void write_plainly(const std::string& path, const std::string& bytes) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file || std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size())
      throw std::runtime_error("cannot write " + path);
    std::fclose(file);
  }

  std::string root_;
  std::map<uint64_t, std::shared_ptr<File>> files_;  // by inode; a number may be used again for another file
  std::map<uint64_t, std::string> folders_;
  Names names_, names_now_;      // durable names; names as the program sees them (files only)
  std::vector<Change> changes_;  // changes that no sync has made durable
};

}  // namespace noonmark::test
