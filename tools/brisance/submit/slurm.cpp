#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "core/error.h"
#include "core/printable.h"
#include "engines.h"
#include "film/write_image.h"

namespace brisance {

namespace {

namespace fs = std::filesystem;

constexpr int kUsualArraySize = 1001;  // Slurm's default MaxArraySize; the largest index is one less

struct Ran {
    int code = 0;
    std::string said;  // on both outputs
};

Ran run(const Words& words) {
    Ran ran;
    FILE* const pipe = popen((shell_line(words) + " 2>&1").c_str(), "r");
    if (pipe == nullptr)
        throw Error(ExitCode::Temporary, "cannot start a process: free memory or allow more processes");
    std::array<char, 4096> piece{};
    while (const std::size_t got = fread(piece.data(), 1, piece.size(), pipe))
        ran.said.append(piece.data(), got);
    const int status = pclose(pipe);
    ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
    return ran;
}

bool is_program(const std::string& name) {
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path == nullptr ? "" : path);
    std::error_code error;
    for (std::string folder; std::getline(folders, folder, ':');)
        if (fs::is_regular_file(fs::path(folder) / name, error))
            return true;
    return false;
}

void require_slurm() {
    if (!is_program("sbatch"))
        throw Error(ExitCode::Unavailable,
                    "Slurm is not there: no program sbatch in PATH; install its client, or use --engine local");
}

// Indices go from 0, since an array's largest index is limited, and frame numbers often begin at 1001.
void check_array_size(int count) {
    const Ran config = run({"scontrol", "show", "config"});
    const std::size_t at = config.said.find("MaxArraySize");
    int most = kUsualArraySize;
    if (config.code == 0 && at != std::string::npos)
        most = std::atoi(config.said.c_str() + config.said.find('=', at) + 1);
    if (count > most)
        throw Error(ExitCode::Usage, fmt::format("--tasks {}: this Slurm takes at most {} tasks in a job; give "
                                                 "--frames-per-task, or fewer --tasks",
                                                 count, most));
}

std::string directives(const FarmTasks& tasks, const std::string& name, const std::string& log) {
    std::string text = fmt::format("#!/bin/bash\n#SBATCH --job-name={}\n#SBATCH --chdir={}\n", shell_line({name}),
                                   shell_line({tasks.folder}));
    text += fmt::format("#SBATCH --output={}\n#SBATCH --open-mode=append\n#SBATCH --requeue\n",
                        shell_line({tasks.output_folder + "/logs/" + log}));
    if (tasks.render.threads > 0)
        text += fmt::format("#SBATCH --cpus-per-task={}\n", tasks.render.threads);
    if (tasks.memory_bytes > 0)
        text += fmt::format("#SBATCH --mem={}M\n", (tasks.memory_bytes + (1 << 20) - 1) >> 20);
    return text;
}

// Threads as many as Slurm gave processors.
Words with_threads(Words words) {
    words.insert(words.end(), {"--progress", "plain", "--threads", "${SLURM_CPUS_PER_TASK:-${SLURM_CPUS_ON_NODE:-0}}"});
    return words;
}

// Tries again, but not after errors that would come again: usage, damaged or missing input, no folder.
std::string with_retries(const std::string& line, int retries) {
    return fmt::format(R"(for try in $(seq 0 {}); do
    {} && code=0 && break
    code=$?
    case $code in 2|65|66|73) break ;; esac
    echo "exit code $code in try $try" >&2
done
)",
                       retries, line);
}

std::string submit(const Words& words) {
    const Ran ran = run(words);
    std::istringstream lines(ran.said);
    std::string first;
    std::getline(lines, first);
    if (ran.code != 0)
        throw Error(ExitCode::Unavailable, fmt::format("sbatch refuses the job: {}", printable_line(first)));
    return first.substr(0, first.find(';'));  // the number, and the cluster
}

}  // namespace

SlurmScripts slurm_scripts(const FarmTasks& tasks) {
    SlurmScripts scripts;
    scripts.array =
        directives(tasks, tasks.name, "%x.%A_%a.log") + fmt::format("#SBATCH --array=0-{}\n", tasks.count - 1) +
        with_retries(shell_line(with_threads(tasks.task("${SLURM_ARRAY_TASK_ID}"))), tasks.retries) + "exit $code\n";
    scripts.last = directives(tasks, tasks.name + ".last", "%x.%A.log") +
                   with_retries(shell_line(with_threads(tasks.rest())), tasks.retries) + "exec " +
                   shell_line(tasks.command("verify")) + " --progress plain\n";
    return scripts;
}

void submit_to_slurm(const FarmTasks& tasks, const SubmitOptions& options) {
    const bool submits = options.write.empty();
    if (submits) {
        require_slurm();
        check_array_size(tasks.count);
    }
    const std::string array = submits ? tasks.output_folder + "/" + tasks.name + ".array.sbatch" : options.write;
    const std::string last = submits ? tasks.output_folder + "/" + tasks.name + ".last.sbatch" : array + ".last";
    const SlurmScripts scripts = slurm_scripts(tasks);
    write_text(array, scripts.array);
    write_text(last, scripts.last);
    fmt::print("{}\n{}\n", array, last);
    if (!submits)
        return;
    std::error_code error;
    fs::create_directories(tasks.output_folder + "/logs", error);
    if (error)
        throw Error(ExitCode::CannotCreate,
                    fmt::format("cannot make the folder {}/logs: {}", tasks.output_folder, error.message()));
    Words words = {"sbatch", "--parsable"};
    words.insert(words.end(), options.engine_options.begin(), options.engine_options.end());
    Words first = words, second = words;
    first.push_back(array);
    const std::string job = submit(first);
    second.insert(second.end(), {"--dependency=afterany:" + job, last});
    const std::string after = submit(second);
    fmt::print("job {}: {} tasks of {} frames\njob {}: renders what is missing and verifies all\n", job, tasks.count,
               tasks.frame_list.size(), after);
}

}  // namespace brisance
