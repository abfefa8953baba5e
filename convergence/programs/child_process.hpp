#pragma once

#include <sys/types.h>

namespace slipstick::convergence {

/// fork(), of a child that does not outlive this process, however that ends: on Linux the kernel kills it.
/// Elsewhere it is only of this process's group, so that what reaches the group ends it too. Returns 0 in the
/// child, its number here. Throws std::runtime_error if there can be no further process.
pid_t fork_child();

/// Waits for a child to end. Returns its status as waitpid() gives it; -1, which is neither an exit nor a
/// signal, where nobody is told, as under an ignored SIGCHLD.
int wait_for_child(pid_t child);

}  // namespace slipstick::convergence
