// What a process that reads a file from outside may still ask of the system.
#pragma once

namespace brisance {

// From here on this process may read files, manage its own memory and send to `socket`. Every other call of the system
// fails with EPERM: it writes nothing, starts nothing and reaches no network. Does nothing where the system has no such
// filter, and in builds with sanitizers, which need more calls.
void forbid_system_calls(int socket);

}  // namespace brisance
