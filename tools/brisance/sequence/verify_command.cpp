#include "verify_command.h"

#include <fmt/format.h>

#include <cstdio>

#include "core/parallel.h"
#include "farm/frame_stamp.h"
#include "finished_frame.h"
#include "sequence/shared_choice.h"

namespace brisance {

int run_verify(const VerifyOptions& options) {
    TextProgress progress(options.render.progress);
    const ThreadLimit limit(options.render.threads);
    const Shot shot = load_for(options.render, progress).shot;
    Failures failures;
    const FrameJob job = usable_frames(shot, options.render, progress, failures);
    const std::vector<FrameOutput> outputs = name_outputs(shot, options.render.output, job.frames, job.several);
    FrameStamps stamps(shot, BRISANCE_VERSION, deciding_files(shot));
    std::vector<int> unfinished;
    progress.begin_sequence(job.frames.size());
    progress.stage("verifying");
    for (std::size_t i = 0; i < job.frames.size(); ++i) {
        const FrameFile& frame = job.frames[i];
        if (const auto why = why_unfinished(outputs[i], shot, stamps.of(frame))) {
            unfinished.push_back(frame.frame);
            fmt::print("frame {}: {}\n", frame.frame,
                       *why == kNotThere ? fmt::format("{}: {}", outputs[i].exr.string(), *why) : *why);
        }
        progress.fraction(double(i + 1) / double(job.frames.size()));
    }
    std::fflush(stdout);
    progress.finish();
    const std::size_t all = job.frames.size(), good = all - unfinished.size();
    const std::string head = fmt::format("{} of {} frame{} finished, verified", good, all, all == 1 ? "" : "s");
    std::string tail;
    if (!unfinished.empty())
        tail += fmt::format("; `brisance render --skip-existing` renders {}", describe_frames(unfinished));
    progress.summary(head, tail, {{"finished", good}, {"frames", all}, {"unfinished", unfinished}});
    return static_cast<int>(unfinished.empty() ? ExitCode::Success : ExitCode::RenderFailed);
}

}  // namespace brisance
