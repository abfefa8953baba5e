#pragma once

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// Throws InputError for a first word that is neither an option nor a command, naming the nearest command
/// that
/// --help shows.
void require_command(const CLI::App& app, int argc, const char* const* argv);

}  // namespace slipstick::convergence
