#!/usr/bin/env python3
"""Compiles the examples at the heads of headers.

  header_examples_test.py ROOT COMPILER [FLAG...]

An example is what stands in the comment before `#pragma once`, indented by three blanks behind an empty line. It is code: nothing in
it is left out. Every header of the program that has one takes part. What an example does not declare itself is its reader's own: it has
the type that TYPES or OWN_TYPES gives it, and is otherwise a stand-in, which can be indexed, iterated and converted to anything, but has
no members. Of functions only CALLED are the reader's own, so that a function of ours that is gone is found. No call runs.
"""
import os
import re
import subprocess
import sys
import tempfile

FOLDERS = ["base", "scenes", "technique", "gl", "raytrace", "frames", "compare", "measure", "app"]
# Of a folder's own namespace.
NAMESPACES = {"compare/report/": "report", "gl/": "gl", "raytrace/": "raytrace", "scenes/gltf/": "gltf"}
INCLUDES = ["algorithm", "cerrno", "memory", "string", "vector", "app/advise/recommend_text.h", "base/threads.h"]
STAND_IN = """
struct StandIn {
  template <class T> operator T&() const;
  template <class T> operator T&&() const;
  template <class... T> StandIn operator()(T&&...) const;
  template <class T> StandIn operator[](const T&) const;
  StandIn* begin() const;
  StandIn* end() const;
};
"""
CALLED = {"command_for", "measure", "print", "use"}
# What examples mean by these names, if no header says otherwise.
TYPES = {
    "adjacency": "raytrace::Adjacency", "app": "CLI::App", "arguments": "ExperimentArguments", "argc": "int", "argv": "char**",
    "bench": "Workbench", "bias": "Bias", "bounds": "std::vector<Bound>", "camera": "Camera", "conditions": "std::vector<Settings>",
    "count": "int", "curve": "BiasCurve", "db": "sqlite::Database", "dir": "std::string", "error": "Error", "evidence": "LookupEvidence",
    "exact": "MapDepths", "experiment": "Experiment", "fingerprint": "std::string", "folder": "std::string", "frame": "LightFrame",
    "given": "GivenMap", "group": "ComparedGroup", "held": "bool", "info": "RunInfo", "ladder": "Ladder", "light": "Light",
    "light_frame": "LightFrame", "m": "Measurement", "metrics": "std::map<std::string, double>", "name": "std::string",
    "names": "report::ChoiceNames", "needed": "uint64_t", "out": "std::string", "outcome": "SweepOutcome", "page": "report::Markup",
    "path": "std::string", "pixel": "size_t", "placements": "Placements", "point": "PointRecord", "points": "std::vector<PointRecord>",
    "probe": "LookupProbe", "programs": "gl::ProgramCache", "quiet": "bool", "receivers": "ReceiverImage", "record": "PointRecord",
    "renderer": "gl::Renderer", "request": "AdviceRequest", "results": "Results", "s": "Settings", "scene": "Scene",
    "settings": "Settings", "store": "ResultStore", "stored": "MapDepths", "stored_map": "MapDepths", "strip": "PixelRange",
    "technique": "Technique", "traced": "raytrace::TracedScene", "tracer": "raytrace::Tracer", "triangles": "uint64_t",
    "truth": "ReceiverTruth", "verb": "CLI::App", "version": "std::string",
}
# The same where a header means something else by the name.
OWN_TYPES = {
    "app/definition/experiment_keys.h": {"bound": "Bound"},
    "app/pictures/picture_files.h": {"picture": "Image<Color>"},
    "app/sweep/failing_pixels.h": {"pictures": "std::vector<SummaryPicture>"},
    "app/sweep/frame_map.h": {"frame": "GivenFrame", "verdict": "FrameVerdict"},
    "app/sweep/sweep_progress.h": {"ahead": "SweepProgress::Ahead", "options": "SweepOptions"},
    "app/verbs/capture_arguments.h": {"arguments": "CaptureArguments"},
    "app/verbs/checked_folder.h": {"list": "ExperimentList"},
    "app/verbs/one_point.h": {"options": "PointOptions"},
    "app/verbs/option_values.h": {"picture": "std::string", "rows": "long"},
    "compare/judge/answers.h": {"points": "std::vector<CostAndError>"},
    "compare/judge/curve_reading.h": {"depth": "double"},
    "compare/judge/techniques.h": {"curve": "std::vector<std::vector<size_t>>"},
    "compare/ladder/flicker.h": {"points": "FlickerPoints"},
    "compare/ladder/flip.h": {"truth": "Image<glm::u8vec3>"},
    "compare/ladder/live_arrays.h": {"lights": "std::vector<float>"},
    "compare/ladder/moment_counts.h": {"counts": "MomentCounts"},
    "compare/ladder/placement_counts.h": {"evidence": "PlacementEvidence", "scale": "BiasScale"},
    "compare/ladder/placement_shares.h": {"counts": "PlacementCounts", "stage": "PlacementStage"},
    "compare/ladder/receiver_taps.h": {"climbing": "ParameterCurve::Adding", "soundness": "ParameterCurve::Adding",
                                       "counts": "ParameterCurve::Adding"},
    "compare/ladder/step_blocks.h": {"sum": "double"},
    "compare/ladder/tap_threshold.h": {"taps": "ReceiverTaps"},
    "compare/ladder/threshold_sums.h": {"all": "ThresholdList"},
    "compare/report/section_picture.h": {"section": "ReceiverSection"},
    "compare/store/sqlite.h": {"id": "int64_t", "value": "double"},
    "compare/store/table.h": {"record": "PictureRecord"},
    "frames/alignment.h": {"frame": "GivenFrame"},
    "frames/checks.h": {"evidence": "CheckEvidence"},
    "frames/judge.h": {"frame": "GivenFrame"},
    "frames/value_curve.h": {"evidence": "CheckEvidence"},
    "gl/spare_maps.h": {"map": "TiledMaps"},
    "measure/given_lookup.h": {"given": "Image<float>"},
    "measure/flicker_stage.h": {"stages": "Pipeline", "loaded": "SceneStage", "r5": "Image<float>", "truth": "TruthStage", "view": "ViewStage"},
    "measure/memory_estimate.h": {"outside_texels": "double"},
    "measure/placement_stage.h": {"input": "PlacementInput", "part": "const BiasPart*"},
    "measure/texel_footprint.h": {"camera": "CameraFrame"},
    "raytrace/drawn_map.h": {"depth": "float", "hit": "uint32_t", "view": "LightView", "x": "glm::dvec3"},
    "raytrace/placement_tracer.h": {"probe": "PlacedProbe"},
    "raytrace/texel_lattice.h": {"taps": "PlacedTaps", "points": "std::vector<TexelLattice::Point>"},
    "scenes/gltf/accessor.h": {"index": "int"},
    "scenes/scene_digest.h": {"remembered": "std::string"},
    "scenes/view_clip.h": {"frame": "CameraFrame", "a": "glm::vec3", "b": "glm::vec3", "c": "glm::vec3"},
    "technique/corner_fits.h": {"camera": "CameraFrame"},
    "technique/cost.h": {"other": "FrameCost"},
    "technique/map_depths.h": {"texels": "std::shared_ptr<const TexelSet>"},
    "technique/map_tile.h": {"light": "glm::dvec3"},
    "technique/moment_lookup.h": {"depths": "TruthInDouble"},
    "technique/setting_rules.h": {"key": "std::string"},
}
MISSING = re.compile(r"^(\S+?\.h):\d+:\d+: error: (?:use of undeclared identifier )?'(\w+)'(?: was not declared in this scope)?", re.M)


def example(path):
    """The lines of the example, each with its number in the header."""
    found, before = [], ""
    with open(path, encoding="utf-8") as header:
        for number, line in enumerate(header, 1):
            line = line.rstrip("\n")
            if line.startswith("#pragma once"):
                break
            goes_on = found and found[-1][0] == number - 1
            if line.startswith("//   ") and (before == "//" or goes_on):
                found.append((number, line[5:]))
            before = line
    return found


def examples(root):
    found = {}
    for folder in FOLDERS:
        for at, _, files in os.walk(os.path.join(root, folder)):
            for name in files:
                path = os.path.relpath(os.path.join(at, name), root)
                if name.endswith(".h") and (lines := example(os.path.join(root, path))):
                    found[path] = lines
    return dict(sorted(found.items()))


def is_called(name, lines):
    return any(re.search(rf"(?<![.>])\b{name}\(", line) for _, line in lines)


def headers(of):
    text = "".join(f'#include {f"<{h}>" if "." not in h else chr(34) + h + chr(34)}\n' for h in [*INCLUDES, *of])
    return text + f"namespace noonmark {{{STAND_IN}}}\n"


def program(of, missing):
    text = ""
    for n, (header, lines) in enumerate(of.items()):
        used = "".join(f"using namespace {name};" for folder, name in NAMESPACES.items() if header.startswith(folder))
        code = "\n".join(line for _, line in lines)
        types = {name: type for name, type in TYPES.items() if re.search(rf"(?<![.>\w])\b{name}\b(?!\s*\()", code)}
        types |= dict.fromkeys(missing.get(header, []), "StandIn") | OWN_TYPES.get(header, {})
        declared = "".join(f"extern {type} {name};" for name, type in sorted(types.items()))
        text += f"namespace noonmark {{\nnamespace example_{n} {{\n{used}\n{declared}\n[[maybe_unused]] auto of_header() {{\n"
        for number, line in lines:
            text += f'#line {number} "{header}"\n{line}\n'
        text += ";}\n}  // namespace\n}  // namespace noonmark\n"
    return text


def main():
    root, compiler, flags = sys.argv[1], sys.argv[2], sys.argv[3:]
    of, missing = examples(root), {}
    if len(of) < 200:
        sys.exit(f"only {len(of)} headers have an example: is the test looking at the right lines?")
    with tempfile.TemporaryDirectory() as folder:
        common, file = os.path.join(folder, "common.h"), os.path.join(folder, "examples.cpp")
        command = [compiler, "-std=c++20", "-w", f"-I{root}", *flags]
        with open(common, "w", encoding="utf-8") as out:
            out.write(headers(of))
        # GCC reads it from there; others read the header.
        subprocess.run([*command, "-x", "c++-header", common, "-o", common + ".gch"], check=True)
        while True:
            with open(file, "w", encoding="utf-8") as out:
                out.write(program(of, missing))
            run = subprocess.run([*command, "-fsyntax-only", "-include", common, file], capture_output=True, text=True, check=False,
                                 env={**os.environ, "LC_ALL": "C"})
            new = {(header, name) for header, name in MISSING.findall(run.stderr)
                   if name not in missing.get(header, []) and (name in CALLED or not is_called(name, of[header]))}
            if not new:
                break
            for header, name in new:
                missing.setdefault(header, set()).add(name)
    if run.returncode != 0:
        errors = "\n".join(line for line in run.stderr.splitlines() if "error" in line)
        sys.exit(f"an example does not compile:\n{errors or run.stderr}")
    print(f"{len(of)} examples compile")


main()
