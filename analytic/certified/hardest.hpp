#pragma once

#include <cstdint>
#include <string>

/// The hardest inputs known of each function of the double path: one file a function (what is given, or
/// `traction`), rows as in the table of proven values, which every test run replays.
namespace slipstick::analytic::certified {

struct Search {
  std::string folder;
  int samples = 300;
  std::uint64_t seed = 1;
};

/// Tries random inputs, some uniform and some close to an end of the range, and the neighbourhoods of the
/// worst; adds to each file those that beat all that it has of that profile and quantity, by error over what
/// is allowed.
void search_hardest(const Search& search);

}  // namespace slipstick::analytic::certified
