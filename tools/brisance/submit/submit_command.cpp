#include "submit_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <map>

#include "core/error.h"
#include "engines.h"
#include "film/write_image.h"

namespace brisance {

const std::vector<std::string>& farm_engines() {
    static const std::vector<std::string> engines = {"local", "slurm", "opencue", "openjd", "flamenco"};
    return engines;
}

int run_submit(const SubmitOptions& options) {
    const std::map<std::string, std::function<std::string(const FarmTasks&)>> templates = {
        {"opencue", opencue_commands}, {"openjd", openjd_template}, {"flamenco", flamenco_job_type}};
    const auto made = templates.find(options.engine);
    if (made != templates.end() && options.write.empty())
        throw Error(ExitCode::Usage,
                    fmt::format("--engine {}: its job is written for you to submit; give --write FILE", made->first));
    if (options.engine != "slurm" && !options.engine_options.empty())
        throw Error(ExitCode::Usage, "--sbatch-option is for --engine slurm");
    if (options.engine == "local" && !options.write.empty())
        throw Error(ExitCode::Usage, "--write: engine local runs at once; name another --engine");
    const FarmTasks tasks = plan_tasks(options);
    if (options.engine == "local")
        return run_locally(tasks);
    if (options.engine == "slurm") {
        submit_to_slurm(tasks, options);
    } else {
        write_text(options.write, made->second(tasks));
        fmt::print("{}\n", options.write);
    }
    return static_cast<int>(ExitCode::Success);
}

}  // namespace brisance
