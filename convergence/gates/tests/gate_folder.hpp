#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "convergence/programs/run_program.hpp"
#include "convergence/tests/scratch_folder.hpp"

namespace slipstick::convergence {

inline constexpr const char* kResultGate = R"([[gate]]
id = "counted"
result = "work.json"
quantity = "counts.some-case.applications"
above = 17
below = 21
basis = "counted 19"
)";

/// What Python's parser finds in JUnit XML: a line for every element.
inline std::string parse_xml(const std::filesystem::path& file) {
  const std::filesystem::path script = file.string() + ".py";
  std::ofstream(script) << "import sys, xml.etree.ElementTree as tree\n"
                           "for e in tree.parse(sys.argv[1]).iter():\n"
                           "    print(e.tag, dict(e.attrib), repr(e.text))\n";
  const ProgramEnd end = run_program({SLIPSTICK_PYTHON, script, file}, {.captured = Captured::output});
  return end.code == 0 ? end.output : "not XML";
}

}  // namespace slipstick::convergence
