#pragma once

#include <dlfcn.h>

#include <stdexcept>
#include <string>

namespace slipstick {

/// Opens the library lib<name>.so at the first call, by the run path of the calling program or library, and
/// keeps it open. Returns the result of its function `name`: a pointer to its table of functions.
/// scope: RTLD_GLOBAL if plug-ins of the library need its symbols. Throws std::runtime_error, which names the
/// missing library: this one or one that it needs.
template <class Offered>
Offered* loaded_library(const std::string& name, int scope = RTLD_LOCAL) {
  void* const library = dlopen(("lib" + name + ".so").c_str(), RTLD_LAZY | scope);
  void* const offer = library != nullptr ? dlsym(library, name.c_str()) : nullptr;
  if (offer == nullptr) throw std::runtime_error(dlerror());
  return reinterpret_cast<Offered* (*)()>(offer)();
}

}  // namespace slipstick
