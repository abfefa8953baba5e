#include "convergence/runs/shard_option.hpp"

#include <CLI/CLI.hpp>

#include "solver/input/input_error.hpp"

namespace slipstick::convergence {

void ShardOption::add_to(CLI::App& command, const std::vector<std::string>& of_judgement) {
  CLI::Option* const shard =
      command
          .add_option("--shard", shard_,
                      "I/N: solve the I-th of N parts of the runs, of about equal predicted work, keep their "
                      "results in --output and judge nothing; --merge does, of all parts")
          ->type_name("I/N");
  CLI::Option* const merge = command
                                 .add_option("--merge", merged_,
                                             "folders in which shards kept their results: join them in "
                                             "--output and judge; stands last")
                                 ->type_name("FOLDER");
  shard->excludes(merge);
  for (const std::string& option : of_judgement) shard->excludes(command.get_option(option));
}

std::optional<Shard> ShardOption::shard() const {
  return shard_.empty() ? std::nullopt : std::optional(read_shard(shard_));
}

std::vector<std::filesystem::path> ShardOption::merged() const {
  std::vector<std::filesystem::path> folders;
  for (const std::string& folder : merged_) {
    if (!std::filesystem::is_directory(folder)) {
      throw solver::InputError("--merge " + folder, "is no folder; allowed: the --output folders of shards");
    }
    folders.emplace_back(folder);
  }
  return folders;
}

}  // namespace slipstick::convergence
