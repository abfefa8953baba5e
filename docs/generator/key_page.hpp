#pragma once

#include <string>

#include "solver/input/setting_key.hpp"

namespace slipstick::docs {

/// The head of a page of keys.
struct PageHead {
  std::string title;
  std::string text;  ///< Markdown
};

/// The keys of a kind of file as a page (Markdown): a table for each of its TOML tables.
std::string keys_markdown(const PageHead& head, const solver::SettingKeys& keys);

}  // namespace slipstick::docs
