// A document of a test as a file: loaded, or refused.
#pragma once
#include <algorithm>
#include <string>

#include "tests/scenes/gltf/expect.h"
#include "tests/scenes/gltf/files.h"

namespace noonmark::test {

class GltfFile : public ::testing::Test {
 protected:
  // The scene of the file, which must be whole.
  static Scene load_file(const std::string& path, const Pose& pose = {}, bool masks = true) {
    Scene scene = load_gltf(path, pose, masks);
    EXPECT_EQ(defect_of(scene), "");
    return scene;
  }
  Scene load(const json& document, const Pose& pose = {}, bool masks = true) {
    return load_file(folder_.write("scene.gltf", document.dump()), pose, masks);
  }
  // The message with which the file is refused; it must hold the text.
  std::string expect_refusal_of_text(const std::string& bytes, const std::string& text, const Pose& pose = {}) {
    const std::string message = refusal(folder_.write("scene.gltf", bytes), pose);
    EXPECT_PRED_FORMAT2(testing::IsSubstring, text, message);
    return message;
  }
  std::string expect_refusal(const json& document, const std::string& text, const Pose& pose = {}) {
    return expect_refusal_of_text(document.dump(), text, pose);
  }
  static bool noted(const Scene& s, const std::string& text) {
    return std::any_of(s.notes.begin(), s.notes.end(),
                       [&](const std::string& note) { return note.find(text) != std::string::npos; });
  }
  TemporaryFolder folder_;
};

}  // namespace noonmark::test
