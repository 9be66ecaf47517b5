// Compares fingerprints of experiments (app/definition/experiment.h). A fingerprint is text with one "name = value" per line.
#pragma once
#include <string>

namespace noonmark {

// "now 'map.resolution = 512', there 'map.resolution = 1024'" for the first name that differs. For a scene's digest
// (app/sweep/identity.h): "the contents of the scene street.glb have changed since these were stored".
std::string first_difference(const std::string& here, const std::string& there);

// Whether the two say the same of every name; a scene may be in one of the two only.
bool same_facts(const std::string& here, const std::string& there);

// The text without the lines of scenes: what all points of a store have in common. Each point has the digest of its own scene.
std::string without_scenes(const std::string& facts);

// The lines of `here`, and the scenes that only `there` has.
std::string joined_facts(const std::string& here, const std::string& there);

}  // namespace noonmark
