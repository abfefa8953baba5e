#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace slipstick::solver {

/// Hands bytes on to the process that waits for them.
using Send = std::function<void(const void* bytes, std::size_t size)>;

/// Does a piece of work in a process of its own and returns what it sent, at most `largest` bytes of it. A
/// crash, an endless loop and memory without bound end that process and what it sends, not this one: so the
/// caller must be able to tell whether all has come. What the work prints to stderr is dropped. Empty where
/// no process can be started.
std::string run_apart(const std::function<void(const Send&)>& work, std::size_t largest);

}  // namespace slipstick::solver
