// The adapters (examples/engines): each shows a scene in the engine itself, in headless Chromium, and hands over the engine's frame.
//
//   const AdapterTools tools = find_adapters({"three", "babylon"}, "");
//   shoot(tools, engine_adapter("three"), "helmet.glb", "out/view1", {"width=640", "lines=out/lines.txt"});
//   const FrameFile frame = read_frame_file("out/view1/frame.json");
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noonmark {

struct EngineAdapter {
  std::string_view name;                   // for people to type: "three"
  std::string_view engine;                 // EngineAdvice::engine: "three.js"
  std::string_view page;                   // from the adapters' folder
  std::vector<std::string_view> packages;  // of npm
};

// Those that run the lines of a recommendation.
std::span<const EngineAdapter> engine_adapters();

// Throws Error(usage) for another engine. It says why an engine is none of them, or names those that are.
const EngineAdapter& engine_adapter(const std::string& name);

// What the adapters need.
struct AdapterTools {
  std::string folder;   // with shoot.mjs
  std::string modules;  // of npm: NODE_MODULES, or node_modules in the folder
  std::string node;     // the program
};

// folder: the adapters' own; empty: those that were installed or built with this program. Throws Error(usage) that names everything
// that is missing and how to get it, before anything is measured.
AdapterTools find_adapters(const std::vector<std::string>& names, const std::string& folder);

// Makes OUT/frame.json and its pictures. settings: "name=value" of the page. Returns the adapter's notes, sentences for people.
// Throws Error(device) with what the adapter said, which is in OUT/shoot.log. No process of the adapter outlives the call, or the
// end of this program (base/child_process.h).
std::vector<std::string> shoot(const AdapterTools& tools, const EngineAdapter& adapter, const std::string& model,
                               const std::string& out, const std::vector<std::string>& settings);

}  // namespace noonmark
