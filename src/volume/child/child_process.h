// A child process with limits, so that what a damaged file does to memory and time ends with it.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>

namespace brisance {

struct ChildLimits {
    std::uint64_t memory_bytes = 0;  // beyond what this process holds already
    int seconds = 0;                 // of processor time: waiting for a disk or for other programs is free
};

enum class ChildEnd { Finished, OutOfTime, Killed, Crashed };  // Killed: as the system does when memory runs out

// One end of a line between two processes. False: the other process has ended.
class Line {
public:
    explicit Line(int socket) : socket_(socket) {}
    bool send(const void* bytes, std::size_t count) const;
    bool receive(void* bytes, std::size_t count) const;
    int socket() const { return socket_; }

private:
    int socket_;
};

class ChildProcess {
public:
    // Forks, and runs `body` in the child; one whose body throws has crashed. The child may read files and use the
    // line, prints nothing, and ends with this process. Parallel loops run on its one thread: threads do not survive a
    // fork. Throws Error Temporary when no process can be started.
    ChildProcess(const ChildLimits& limits, const std::function<void(const Line&)>& body);

    // Ends the child, and does not wait for it.
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    const Line& line() const { return line_; }

    // Waits for the child and says how it ended. To be called once.
    ChildEnd wait();

private:
    Line line_{-1};
    pid_t child_ = -1;
};

}  // namespace brisance
