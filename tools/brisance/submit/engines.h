// The engines of `brisance submit`.
#pragma once

#include <string>

#include "farm_tasks.h"

namespace brisance {

// Runs all tasks at once by processes of this machine, those that fail again, and verifies the frames. Returns the exit
// code: that of `brisance verify`, or of a task that failed.
int run_locally(const FarmTasks& tasks);

// The scripts of an array job and of the job after it.
struct SlurmScripts {
    std::string array, last;
};
SlurmScripts slurm_scripts(const FarmTasks& tasks);

// Writes the scripts to files, and submits them if `submits`. Prints their paths, and the numbers of the jobs. Throws
// Error Unavailable where sbatch is not there or refuses.
void submit_to_slurm(const FarmTasks& tasks, const SubmitOptions& options);

// The job for a farm that this program does not talk to: a file of commands for OpenCue's cuecmd, a job template of
// Open Job Description, as Deadline Cloud reads it, or a job type of Flamenco 3.
std::string opencue_commands(const FarmTasks& tasks);
std::string openjd_template(const FarmTasks& tasks);
std::string flamenco_job_type(const FarmTasks& tasks);

}  // namespace brisance
