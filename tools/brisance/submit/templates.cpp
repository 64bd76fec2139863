// Jobs for farms that this program does not talk to. Frames that a task leaves are rendered by the job's last task.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engines.h"

namespace brisance {

namespace {

using Json = nlohmann::ordered_json;

std::string dumped(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

// In the folder that relative paths are relative to.
std::string in_folder(const FarmTasks& tasks, const Words& words) {
    return "cd " + shell_line({tasks.folder}) + " && " + shell_line(words);
}

// The rest and its verification, as one line.
std::string last_line(const FarmTasks& tasks) {
    return in_folder(tasks, tasks.rest()) + "; " + shell_line(tasks.command("verify"));
}

Json shell_step(const std::string& name, const std::string& line) {
    return {{"name", name}, {"script", {{"actions", {{"onRun", {{"command", "bash"}, {"args", {"-c", line}}}}}}}}};
}

}  // namespace

std::string opencue_commands(const FarmTasks& tasks) {
    std::string text;
    for (int i = 0; i < tasks.count; ++i)
        text += in_folder(tasks, tasks.task(std::to_string(i))) + "\n";
    return text;
}

std::string openjd_template(const FarmTasks& tasks) {
    Json render = shell_step("Render", in_folder(tasks, tasks.task("@INDEX@")));
    std::string& line = render["script"]["actions"]["onRun"]["args"][1].get_ref<std::string&>();
    line.replace(line.find("'@INDEX@'") != std::string::npos ? line.find("'@INDEX@'") : line.find("@INDEX@"),
                 line.find("'@INDEX@'") != std::string::npos ? 9 : 7, "{{Task.Param.Task}}");
    render["parameterSpace"] = {
        {"taskParameterDefinitions",
         {{{"name", "Task"}, {"type", "INT"}, {"range", fmt::format("0-{}", tasks.count - 1)}}}}};
    Json last = shell_step("RenderTheRestAndVerify", last_line(tasks));
    last["dependencies"] = Json::array({{{"dependsOn", "Render"}}});
    const Json job = {
        {"specificationVersion", "jobtemplate-2023-09"}, {"name", tasks.name}, {"steps", Json::array({render, last})}};
    return dumped(job) + "\n";
}

std::string flamenco_job_type(const FarmTasks& tasks) {
    Json lines = Json::array();
    for (int i = 0; i < tasks.count; ++i)
        lines.push_back(in_folder(tasks, tasks.task(std::to_string(i))));
    return fmt::format(R"(// A job type of Flamenco 3 for one sequence: put it into the manager's folder `scripts`.
const JOB_TYPE = {{
    label: {},
    settings: [],
}};

const TASKS = {};
const LAST = {};

function shellTask(name, line) {{
    const task = author.Task(name, "misc");
    task.addCommand(author.Command("exec", {{ exe: "bash", args: ["-c", line] }}));
    return task;
}}

function compileJob(job) {{
    const last = shellTask("render the rest and verify", LAST);
    for (let i = 0; i < TASKS.length; ++i) {{
        const task = shellTask("render-" + i, TASKS[i]);
        last.addDependency(task);
        job.addTask(task);
    }}
    job.addTask(last);
}}
)",
                       dumped("Brisance: " + tasks.name), dumped(lines), dumped(last_line(tasks)));
}

}  // namespace brisance
