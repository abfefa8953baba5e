#pragma once

#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// Throws InputError, naming the option and its file, where a command would write to one of the files that it
/// reads, by this name or another (links, other spellings).
void require_inputs_kept(const CLI::App& command, const std::vector<std::filesystem::path>& inputs);

/// The same of one option and its file.
void require_input_kept(const std::string& option, const std::string& output,
                        const std::vector<std::filesystem::path>& inputs);

/// The same for the files that the command line names; and where two outputs would be one file, as given or
/// behind links.
void require_inputs_kept(const CLI::App& command);

/// What runs a command: `run` with the options that were read into its request.
template <typename Request, typename Run>
auto running(const CLI::App* command, const std::shared_ptr<Request>& request, Run run) {
  return [=](std::ostream& text, auto& result) { return run(*command, *request, text, result); };
}

/// Throws InputError for a first word that is neither an option nor a command, naming the nearest command
/// that
/// --help shows.
void require_command(const CLI::App& app, int argc, const char* const* argv);

}  // namespace slipstick::convergence
