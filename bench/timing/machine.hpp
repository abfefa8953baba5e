#pragma once

#include <istream>
#include <string>

namespace slipstick::bench {

/// What tells this machine from others as far as times go: its processor's name, family and model, their
/// number and the largest cache, as in "intel-xeon-family6-model143-2cpus-l3-105m". No host's name.
std::string machine_key();

/// The same of /proc/cpuinfo's text and the bytes of the largest cache (0: not known).
std::string machine_key(std::istream& cpuinfo, long cache_bytes);

}  // namespace slipstick::bench
