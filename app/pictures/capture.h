// Frames of another program, read from a RenderDoc capture by the reader, a Python program of its own (captures/).
//
//   const std::vector<std::string> command = capture_command("frame.rdc", "");
//   for (const std::string& frame : read_capture(command, "out/frames", {"--light=1"}, print_line)) print(frame);
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace noonmark {

bool is_capture(const std::string& path);  // by its ending, .rdc

// Names of the files that the reader and `judge` write into the folder of frames, as patterns of fnmatch.
std::vector<std::string> capture_files();

// The command line of the reader for this capture, without its options. reader: the folder with capture.py; empty: the one that
// was installed or built with this program. Throws Error: file if the capture is not there, usage if the reader is not, device
// if there is no Python.
std::vector<std::string> capture_command(const std::string& capture, const std::string& reader);

// Runs the reader, which fills `folder`; that is made. options: of the reader. said: gets each line about what is found, when it
// is found. Returns the paths of the frame.json of each light, and after it those of its maps. Throws Error: usage if the file is no
// capture, file if it cannot be judged, device if something that the reader needs is missing or if it crashed. No process of the
// reader outlives the call, or the end of this program (base/child_process.h).
std::vector<std::string> read_capture(std::vector<std::string> command, const std::string& folder,
                                      const std::vector<std::string>& options,
                                      const std::function<void(const std::string&)>& said);

// On standard output, at once.
void print_line(const std::string& line);

// What is missing here to read captures, with Debian's packages; empty: nothing.
std::string missing_for_captures();

}  // namespace noonmark
