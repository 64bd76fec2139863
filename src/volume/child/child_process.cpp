// A fork without exec: it costs two milliseconds, whereas a program of its own would load OpenVDB again. The child has
// only the thread that forked, and glibc keeps its memory allocator usable there.
#include "volume/child/child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <mutex>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "volume/child/system_calls.h"

namespace brisance {
namespace {

constexpr int kFinished = 0, kThrew = 3;

// Forks one at a time: a child would keep the other's lines open. Holds children that end without anyone waiting.
struct Children {
    std::mutex mutex;
    std::vector<pid_t> ending;
};

Children& children() {
    static Children all;
    return all;
}

void reap_ended() {
    std::erase_if(children().ending, [](pid_t child) { return waitpid(child, nullptr, WNOHANG) != 0; });
}

// Address space of this process [bytes].
std::uint64_t mapped_bytes() {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void lower_limit(decltype(RLIMIT_AS) resource, rlim_t most) {
    rlimit limit{};
    getrlimit(resource, &limit);
    limit.rlim_cur = std::min({limit.rlim_cur, limit.rlim_max, most});
    setrlimit(resource, &limit);
}

void apply_limits(const ChildLimits& limits, std::uint64_t mapped) {
    lower_limit(RLIMIT_CORE, 0);
    lower_limit(RLIMIT_CPU, static_cast<rlim_t>(limits.seconds));
    lower_limit(RLIMIT_AS, mapped + limits.memory_bytes);
}

// What a library or the C library says of a damaged file is no line of ours.
void silence_output() {
    const int nowhere = open("/dev/null", O_WRONLY);
    if (nowhere < 0)
        return;
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
}

void close_all_but(int socket) {
    const auto kept = static_cast<unsigned>(socket);
    if (kept > 3)
        close_range(3, kept - 1, 0);
    close_range(kept + 1, ~0u, 0);
}

// Handlers of this program and of sanitizers would act as if they were in the parent.
void reset_signals(const sigset_t& before) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGALRM})
        std::signal(signal, SIG_DFL);
    sigprocmask(SIG_SETMASK, &before, nullptr);
}

[[noreturn]] void be_the_child(pid_t parent, int socket, const ChildLimits& limits, std::uint64_t mapped,
                               const sigset_t& signals, const std::function<void(const Line&)>& body) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)  // it ended before the line above
        _exit(kThrew);
    reset_signals(signals);
    close_all_but(socket);
    silence_output();
    apply_limits(limits, mapped);
    forbid_system_calls(socket);
    try {
        const ThreadLimit none_beside(1);  // libraries may want parallel loops too
        body(Line(socket));
    } catch (...) {
        _exit(kThrew);
    }
    _exit(kFinished);
}

ChildEnd end_of(int status) {
    if (WIFEXITED(status))
        return WEXITSTATUS(status) == kFinished ? ChildEnd::Finished : ChildEnd::Crashed;
    if (WTERMSIG(status) == SIGXCPU)
        return ChildEnd::OutOfTime;
    return WTERMSIG(status) == SIGKILL ? ChildEnd::Killed : ChildEnd::Crashed;
}

[[noreturn]] void throw_no_process(int error) {
    throw Error(ExitCode::Temporary, std::string("cannot start a process to read volumes: ") + std::strerror(error) +
                                         "; free memory or allow more processes");
}

}  // namespace

bool Line::send(const void* bytes, std::size_t count) const {
    const auto* at = static_cast<const char*>(bytes);
    while (count > 0) {
        const ssize_t sent = ::send(socket_, at, count, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR)
            continue;
        if (sent <= 0)
            return false;
        at += sent;
        count -= static_cast<std::size_t>(sent);
    }
    return true;
}

bool Line::receive(void* bytes, std::size_t count) const {
    auto* at = static_cast<char*>(bytes);
    while (count > 0) {
        const ssize_t got = ::read(socket_, at, count);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        at += got;
        count -= static_cast<std::size_t>(got);
    }
    return true;
}

ChildProcess::ChildProcess(const ChildLimits& limits, const std::function<void(const Line&)>& body) {
    const std::lock_guard lock(children().mutex);
    reap_ended();
    std::array<int, 2> sockets{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0)
        throw_no_process(errno);
    const std::uint64_t mapped = mapped_bytes();
    const pid_t parent = getpid();
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);  // no handler of the parent may run in the child
    child_ = fork();
    if (child_ == 0)
        be_the_child(parent, sockets[1], limits, mapped, before, body);
    const int error = errno;
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    close(sockets[1]);
    line_ = Line(sockets[0]);
    if (child_ < 0) {
        close(sockets[0]);
        throw_no_process(error);
    }
}

ChildProcess::~ChildProcess() {
    close(line_.socket());
    if (child_ < 0)
        return;
    const std::lock_guard lock(children().mutex);
    kill(child_, SIGKILL);
    children().ending.push_back(child_);
    reap_ended();
}

ChildEnd ChildProcess::wait() {
    int status = kFinished;
    pid_t ended = -1;
    do
        ended = waitpid(child_, &status, 0);
    while (ended < 0 && errno == EINTR);
    const bool known = ended == child_;  // where SIGCHLD is ignored, nobody knows
    child_ = -1;
    return known ? end_of(status) : ChildEnd::Crashed;
}

}  // namespace brisance
