// Tasks as processes of this machine: one that crashes or runs out of memory takes no other with it, and is run again.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <thread>

#include "core/error.h"
#include "engines.h"
#include "sequence/verify_command.h"

namespace brisance {

namespace {

struct Running {
    int task = 0;
    pid_t process = -1;
};

[[noreturn]] void become(const Words& words, int output) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (output >= 0)
        dup2(output, STDOUT_FILENO);
    std::vector<char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execv(arguments.front(), arguments.data());
    _exit(127);
}

pid_t start(const Words& words, int output) {
    std::fflush(nullptr);
    const pid_t process = fork();
    if (process == 0)
        become(words, output);
    if (process < 0)
        throw Error(ExitCode::Temporary, fmt::format("cannot start a process: {}; free memory or allow more processes",
                                                     std::strerror(errno)));
    return process;
}

int exit_code_of(pid_t process) {
    int status = 0;
    while (waitpid(process, &status, 0) < 0)
        if (errno != EINTR)
            return static_cast<int>(ExitCode::RenderFailed);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// Whether another try may end otherwise.
bool worth_another_try(int code) {
    constexpr std::array hopeless = {ExitCode::Success, ExitCode::Usage, ExitCode::BadData, ExitCode::MissingInput,
                                     ExitCode::CannotCreate};
    return std::none_of(hopeless.begin(), hopeless.end(), [&](ExitCode e) { return code == static_cast<int>(e); });
}

const char* style_name(ProgressStyle style) {
    constexpr std::array names = {"auto", "tty", "plain", "none", "alfred", "ndjson"};
    return names.at(static_cast<std::size_t>(style));
}

// Passes on the paths of finished files, until all processes have ended. Each EXR that has a name of its own counts as
// a frame.
void pass_on_paths(int from, TextProgress& progress) {
    FILE* const in = fdopen(from, "r");
    std::array<char, 8192> line{};
    while (fgets(line.data(), line.size(), in) != nullptr) {
        std::fputs(line.data(), stdout);
        std::fflush(stdout);
        const std::string text = line.data();
        if (text.ends_with(".exr\n") && !text.ends_with(".A.exr\n") && !text.ends_with(".B.exr\n") &&
            text.find(".virtual_lights.") == std::string::npos && text.find(".profiles.") == std::string::npos)
            progress.end_frames(1);
    }
    std::fclose(in);
}

class LocalTasks {
public:
    explicit LocalTasks(const FarmTasks& tasks) : tasks_(tasks), codes_(static_cast<std::size_t>(tasks.count), -1) {}

    // The exit code of the first task that failed for good.
    int run() {
        TextProgress progress(tasks_.count > 1 ? tasks_.render.progress : ProgressStyle::None);
        progress.begin_sequence(tasks_.frame_list.size());
        for (int round = 0; round <= tasks_.retries; ++round) {
            run_unfinished(progress);
            if (std::none_of(codes_.begin(), codes_.end(), worth_another_try))
                break;
        }
        progress.finish();
        const auto bad = std::find_if(codes_.begin(), codes_.end(), [](int code) { return code != 0; });
        return bad == codes_.end() ? 0 : *bad;
    }

private:
    // One task shows its own progress. Several would write over each other.
    Words words_of(int task) const {
        Words words = tasks_.task(std::to_string(task));
        const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
        const int threads = tasks_.render.threads > 0 ? tasks_.render.threads
                            : tasks_.count > 1        ? std::max(1, processors / tasks_.count)
                                                      : 0;
        words.insert(words.end(), {"--threads", std::to_string(threads), "--progress",
                                   tasks_.count > 1 ? "none" : style_name(tasks_.render.progress)});
        return words;
    }

    void run_unfinished(TextProgress& progress) {
        std::array<int, 2> ends{-1, -1};
        if (tasks_.count > 1 && pipe2(ends.data(), O_CLOEXEC) != 0)
            throw Error(ExitCode::Temporary, "cannot make a pipe: allow more open files");
        std::vector<Running> running;
        for (int task = 0; task < tasks_.count; ++task)
            if (worth_another_try(codes_[static_cast<std::size_t>(task)]))
                running.push_back({task, start(words_of(task), ends[1])});
        if (ends[1] >= 0) {
            close(ends[1]);
            pass_on_paths(ends[0], progress);
        }
        for (const Running& one : running) {
            const int code = exit_code_of(one.process);
            codes_[static_cast<std::size_t>(one.task)] = code;
            if (code != 0)
                progress.say(fmt::format("task {} of {} ended with exit code {}", one.task, tasks_.count, code));
        }
    }

    const FarmTasks& tasks_;
    std::vector<int> codes_;
};

}  // namespace

int run_locally(const FarmTasks& tasks) {
    const int code = LocalTasks(tasks).run();
    VerifyOptions options{tasks.render};
    options.render.frames = tasks.frames;
    const int verified = run_verify(options);
    return code != 0 ? code : verified;
}

}  // namespace brisance
