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

/// Throws InputError, naming the option and its file, where a command would overwrite one of its input files,
/// also through a link or another spelling.
void require_inputs_kept(const CLI::App& command, const std::vector<std::filesystem::path>& inputs);

/// The same of one option and its file.
void require_input_kept(const std::string& option, const std::string& output,
                        const std::vector<std::filesystem::path>& inputs);

/// The same for all files that the command line names. Also throws where two outputs are the same file, by
/// name or through links.
void require_inputs_kept(const CLI::App& command);

/// The function that runs a command: calls `run` with the request into which its options were read.
template <typename Request, typename Run>
auto running(const CLI::App* command, const std::shared_ptr<Request>& request, Run run) {
  return [=](std::ostream& text, auto& result) { return run(*command, *request, text, result); };
}

/// Throws InputError for a first word that is neither an option nor a command, naming the nearest command of --help.
void require_command(const CLI::App& app, int argc, const char* const* argv);

/// Throws InputError that names all options of the line that its command does not have, each with the nearest
/// one. For lines that cannot be parsed: other complaints about them may follow from a misspelt option.
void require_known_options(const CLI::App& app, int argc, const char* const* argv);

}  // namespace slipstick::convergence
