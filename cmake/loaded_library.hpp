#pragma once

#include <dlfcn.h>

#include <stdexcept>
#include <string>

namespace slipstick {

/// What the function `name` of the library lib<name>.so returns: a pointer to what it offers. The library is
/// opened by the first call, found by the run path of the program or library that asks, and stays open.
/// scope: RTLD_GLOBAL for one whose own plug-ins look for its symbols. Throws std::runtime_error, which names
/// the library that is missing, this one or one that it needs.
template <class Offered>
Offered* loaded_library(const std::string& name, int scope = RTLD_LOCAL) {
  void* const library = dlopen(("lib" + name + ".so").c_str(), RTLD_LAZY | scope);
  void* const offer = library != nullptr ? dlsym(library, name.c_str()) : nullptr;
  if (offer == nullptr) throw std::runtime_error(dlerror());
  return reinterpret_cast<Offered* (*)()>(offer)();
}

}  // namespace slipstick
