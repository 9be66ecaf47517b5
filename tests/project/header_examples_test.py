#!/usr/bin/env python3
"""Compiles the examples at the heads of the headers that are read first.

  header_examples_test.py ROOT COMPILER [FLAG...]

The headers are those of the column `read first` in docs/explanation/architecture.md, and measure/workbench.h, which
measure/stages.h names. An example is what stands in the comment before `#pragma once`, indented by three blanks behind an
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
    if sorted(headers) != sorted(DECLARED):
        sys.exit("the headers that are read first and those of this test differ: " +
                 ", ".join(sorted(set(headers) ^ set(DECLARED))))
    text = "".join(f'#include {f"<{h}>" if "." not in h else chr(34) + h + chr(34)}\n' for h in INCLUDES + headers)
    with_example = 0
    for n, header in enumerate(headers):
        lines = example(os.path.join(root, header))
        with_example += bool(lines)
        text += f"namespace noonmark {{\nnamespace example_{n} {{\n{COMMON}\n{DECLARED[header]}\n[[maybe_unused]] void of_header() {{\n"
        for number, line in lines:
            text += f'#line {number} "{header}"\n{line}\n'
        text += "}\n}  // namespace\n}  // namespace noonmark\n"
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
