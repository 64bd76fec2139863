#include "volume/child/system_calls.h"

#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__)) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define BRISANCE_FILTER 1
#endif

#ifdef BRISANCE_FILTER
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <cerrno>
#include <cstddef>
#include <vector>
#endif

namespace brisance {

#ifdef BRISANCE_FILTER
namespace {

#ifdef __x86_64__
constexpr unsigned kArchitecture = AUDIT_ARCH_X86_64;
#else
constexpr unsigned kArchitecture = AUDIT_ARCH_AARCH64;
#endif

constexpr int kAllowed[] = {
    SYS_read,           SYS_readv,        SYS_pread64,      SYS_lseek,       SYS_close,
    SYS_fstat,          SYS_newfstatat,   SYS_statx,        SYS_mmap,        SYS_munmap,
    SYS_mremap,         SYS_mprotect,     SYS_brk,          SYS_madvise,     SYS_futex,
    SYS_rt_sigprocmask, SYS_rt_sigaction, SYS_rt_sigreturn, SYS_sigaltstack, SYS_clock_gettime,
    SYS_gettimeofday,   SYS_getpid,       SYS_gettid,       SYS_sched_yield, SYS_sysinfo,
    SYS_getrandom,      SYS_exit,         SYS_exit_group,   SYS_nanosleep,   SYS_clock_nanosleep,
    SYS_faccessat,      SYS_readlinkat,   SYS_getdents64,   SYS_fadvise64,   SYS_sched_getaffinity,
#ifdef __x86_64__
    SYS_stat,           SYS_access,       SYS_readlink,
#endif
};

constexpr sock_filter statement(unsigned code, unsigned value) {
    return {static_cast<unsigned short>(code), 0, 0, value};
}

// Jumps over `yes` or `no` instructions.
constexpr sock_filter jump(unsigned code, unsigned value, unsigned char yes, unsigned char no) {
    return {static_cast<unsigned short>(code), yes, no, value};
}

constexpr sock_filter kLoadCall = statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr));
constexpr sock_filter kAllow = statement(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
constexpr sock_filter kRefuse = statement(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM);

// The low word of an argument: flags and descriptors have no more.
constexpr sock_filter load_argument(unsigned which) {
    return statement(BPF_LD | BPF_W | BPF_ABS, static_cast<unsigned>(offsetof(seccomp_data, args)) +
                                                   which * static_cast<unsigned>(sizeof(__u64)));
}

std::vector<sock_filter> make_filter(int socket) {
    std::vector<sock_filter> filter = {
        statement(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
        jump(BPF_JMP | BPF_JEQ | BPF_K, kArchitecture, 1, 0),
        kRefuse,
        kLoadCall,
    };
    for (const int call : kAllowed) {
        filter.push_back(jump(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(call), 0, 1));
        filter.push_back(kAllow);
    }
    // A file may be opened for reading.
    filter.push_back(jump(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat, 0, 4));
    filter.push_back(load_argument(2));
    filter.push_back(jump(BPF_JMP | BPF_JSET | BPF_K, O_WRONLY | O_RDWR | O_CREAT | O_TRUNC, 1, 0));
    filter.push_back(kAllow);
    filter.push_back(kRefuse);
    filter.push_back(jump(BPF_JMP | BPF_JEQ | BPF_K, SYS_sendto, 0, 3));
    filter.push_back(load_argument(0));
    filter.push_back(jump(BPF_JMP | BPF_JEQ | BPF_K, static_cast<unsigned>(socket), 0, 1));
    filter.push_back(kAllow);
    filter.push_back(kRefuse);
    return filter;
}

}  // namespace

void forbid_system_calls(int socket) {
    std::vector<sock_filter> filter = make_filter(socket);
    const sock_fprog program = {static_cast<unsigned short>(filter.size()), filter.data()};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0)
        prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

#else

void forbid_system_calls(int) {}

#endif

}  // namespace brisance
