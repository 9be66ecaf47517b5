#!/usr/bin/env python3
"""Compiles the examples at the heads of headers.

  header_examples_test.py ROOT COMPILER [FLAG...]

The headers are those of the column `read first` in docs/explanation/architecture.md, measure/workbench.h, which
measure/stages.h names, and others whose example needs no more than stand-ins. An example is what stands in the comment before `#pragma once`, indented by three blanks behind an
empty line. It is code: nothing in it is left out. What it does not declare itself is declared here, and no call runs.
"""
import os
import re
import subprocess
import sys
import tempfile

# Functions that stand for the reader's own.
COMMON = """
template <class... T> void print(const T&...);
template <class... T> void use(const T&...);
template <class... T> void write(const T&...);
template <class... T> void save(const T&...);
extern Scene scene;
extern Settings settings, s;
extern Camera camera;
extern ReceiverImage receivers;
extern LightFrame light_frame;
"""
STAND_IN = """
struct StandIn {
  template <class T> operator T&() const;
  template <class T> operator T&&() const;
};
"""
# Of a folder's own namespace.
NAMESPACES = {"compare/report/": "report", "gl/": "gl"}
# What an example calls `frame`, `measure` and so on differs from header to header.
DECLARED = {
    "base/error.h": "",
    "scenes/scene.h": "",
    "technique/settings.h": "",
    "gl/renderer.h": "extern Technique technique;",
    "raytrace/tracer.h": "extern LightFrame frame; extern Light light; extern Bias bias;",
    "frames/judge.h": "extern GivenFrame frame; extern raytrace::Tracer tracer;",
    "compare/results/records.h": "",
    "compare/store/store.h": "PointRecord measure(int64_t); extern std::string fingerprint; extern RunInfo info; extern int64_t planned; "
                             "extern std::vector<int64_t> wanted;",
    "compare/ladder/ladder.h": "extern ReceiverTruth truth; extern LookupProbe probe; extern TapTruth taps; extern MapDepths exact_map; "
                               "extern Bias bias; extern Image<float> r4, r5;",
    "compare/judge/bounds.h": "extern std::vector<PointRecord> points; extern std::vector<Bound> bounds; "
                              "std::string command_for(const PointRecord&);",
    "compare/report/report.h": "extern std::string dir; extern Results results; "
                               "std::string bytes_of(const std::string&, const std::string&);",
    "measure/stages.h": "",
    "measure/workbench.h": "extern CurveOptions curve_options;",
    "app/definition/experiment.h": "void measure(const Settings&);",
    "app/pictures/point_pictures.h": "extern Experiment experiment; extern Results results; extern std::string out; "
                                     "extern Measurement measurement; extern PictureFormats formats;",
    "app/advise/recommend.h": "extern Workbench bench; extern AdviceRequest request;",
    "app/sweep/sweep.h": "extern Experiment experiment;",
    "app/live/live_page.h": "extern std::string version;",
    "app/verbs/verbs.h": "",
    "compare/report/element.h": "extern int count; extern bool held;",
}
# Further headers with an example that is whole, and the names in it that stand for the reader's own objects: a stand-in converts to
# anything, and has no members. So what these examples call must be there, with as many arguments.
STAND_INS = {
    "app/advise/engine_adapters.h": "",
    "app/advise/engines/cover.h": "",
    "app/advise/engines/engine_settings.h": "",
    "app/advise/texel_budget.h": "bench lights say",
    "app/definition/experiment_file.h": "",
    "app/definition/experiment_schema.h": "",
    "app/definition/experiment_text.h": "",
    "app/definition/first_experiment.h": "",
    "app/definition/share_text.h": "",
    "app/pictures/given_frame.h": "",
    "app/pictures/png_encoder.h": "picture",
    "app/sweep/frame_map.h": "frame tracer verdict",
    "app/sweep/frame_run.h": "experiment folder options",
    "app/sweep/identity.h": "bench path tracer",
    "app/sweep/judging.h": "experiment results",
    "app/sweep/survey.h": "bench experiment wanted",
    "app/verbs/command_line.h": "argc argv command",
    "app/verbs/model_report.h": "",
    "app/verbs/settings_page.h": "",
    "base/build_facts.h": "",
    "base/child_process.h": "",
    "base/file.h": "max_picture_bytes text",
    "compare/judge/baseline.h": "now",
    "compare/judge/choices.h": "results",
    "compare/judge/moment_cures.h": "point",
    "compare/judge/recommendation.h": "results",
    "compare/ladder/flip.h": "drawn truth",
    "compare/ladder/lasting_steps.h": "",
    "compare/ladder/live_picture.h": "evidence height part stored_map strip width",
    "compare/ladder/reduction_window.h": "",
    "compare/ladder/section.h": "evidence ladder stored stored_rows technique",
    "compare/ladder/threshold_bins.h": "bias_depth depth depth_per_unit reference threshold",
    "compare/report/blocks.h": "rows",
    "compare/results/number_text.h": "",
    "compare/results/quantities.h": "point",
    "frames/checks.h": "evidence",
    "frames/frame_file.h": "height text width",
    "frames/frame_memory.h": "height width",
    "gl/page_text.h": "bias files_of_the_page",
    "measure/flicker_stage.h": "loaded r5 renderer stages techniques truth view",
    "measure/map_offset.h": "exact format given",
    "raytrace/vertex_rounding.h": "place triangle",
    "scenes/camera_fit.h": "",
    "scenes/floor.h": "",
    "scenes/gltf/contents.h": "",
    "scenes/gltf/gltf.h": "",
    "scenes/gltf/write_glb.h": "light",
    "scenes/interior.h": "",
    "scenes/library.h": "",
    "scenes/mask_cell.h": "",
    "scenes/view_matrix.h": "height matrix width x y",
    "technique/bias_parts.h": "",
    "technique/cascade_blends.h": "",
    "technique/cascade_splits.h": "",
    "technique/chosen_light.h": "",
    "technique/depth_format.h": "depths",
    "technique/filters.h": "",
    "technique/lookup_parameters.h": "",
    "technique/lookups.h": "",
    "technique/spread_blur.h": "depths",
    "technique/sun.h": "",
    "technique/tap_pattern.h": "pixel",
}
# What the examples name beside their own header.
INCLUDES = ["algorithm", "memory", "string", "vector", "scenes/library.h", "scenes/receivers.h", "technique/technique.h",
            "technique/settings.h", "technique/light_frame.h", "app/advise/recommend_text.h", "app/definition/experiment_file.h",
            "app/pictures/pictures.h", "app/sweep/results_folder.h", "app/live/live_page.h", "app/definition/experiment.h"]


def read_first(root):
    headers = []
    with open(os.path.join(root, "docs/explanation/architecture.md"), encoding="utf-8") as page:
        for line in page:
            row = re.match(r"\| `([a-z/]+/)`.*\| `(\w+\.h)` \|$", line.strip())
            if row:
                headers.append(row[1] + row[2])
    return headers + ["measure/workbench.h"]


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


def main():
    root, compiler, flags = sys.argv[1], sys.argv[2], sys.argv[3:]
    headers = read_first(root)
    if lacking := set(headers) - set(DECLARED):
        sys.exit("headers that are read first and not known to this test: " + ", ".join(sorted(lacking)))
    headers += sorted((set(DECLARED) | set(STAND_INS)) - set(headers))
    text = "".join(f'#include {f"<{h}>" if "." not in h else chr(34) + h + chr(34)}\n' for h in INCLUDES + headers)
    text += f"namespace noonmark {{{STAND_IN}}}\n"
    with_example = 0
    for n, header in enumerate(headers):
        lines = example(os.path.join(root, header))
        with_example += bool(lines)
        declared = DECLARED.get(header, "") + "".join(f"extern StandIn {name};" for name in STAND_INS.get(header, "").split())
        used = "".join(f"using namespace {name};" for folder, name in NAMESPACES.items() if header.startswith(folder))
        text += f"namespace noonmark {{\nnamespace example_{n} {{\n{used}\n{COMMON}\n{declared}\n[[maybe_unused]] auto of_header() {{\n"
        for number, line in lines:
            text += f'#line {number} "{header}"\n{line}\n'
        text += ";}\n}  // namespace\n}  // namespace noonmark\n"
        if not lines and header in STAND_INS:
            sys.exit(f"{header} has no example: is the test looking at the right lines?")
    if with_example < 12:
        sys.exit(f"only {with_example} of {len(headers)} headers have an example: is the test looking at the right lines?")
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "examples.cpp")
        with open(file, "w", encoding="utf-8") as out:
            out.write(text)
        run = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", "-w", f"-I{root}", *flags, file],
                             capture_output=True, text=True, check=False)
    if run.returncode != 0:
        errors = "\n".join(line for line in run.stderr.splitlines() if "error" in line)
        sys.exit(f"an example does not compile:\n{errors or run.stderr}")
    print(f"{with_example} examples compile")


main()
