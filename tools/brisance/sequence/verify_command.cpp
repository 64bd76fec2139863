#include "verify_command.h"

#include <fmt/format.h>

#include <cstdio>

#include "core/parallel.h"
#include "farm/frame_stamp.h"
#include "finished_frame.h"
#include "sequence/shared_choice.h"
#include "sequence/steadiness.h"

namespace brisance {

namespace {

// Prints the frames that change by more than `limit`; how many they are.
std::size_t print_unsteady(const Steadiness& steadiness, double limit) {
    std::size_t count = 0;
    for (const Steadiness::OfFrame& f : steadiness.frames())
        if (limit >= 0.0 && !(f.change <= limit)) {
            fmt::print("frame {}: it changes by {:.3g} against both neighbours, above {:g}\n", f.frame, f.change,
                       limit);
            ++count;
        }
    return count;
}

}  // namespace

int run_verify(const VerifyOptions& options) {
    TextProgress progress(options.render.progress);
    const ThreadLimit limit(options.render.threads);
    const Shot shot = load_for(options.render, progress).shot;
    Failures failures;
    const FrameJob job = usable_frames(shot, options.render, progress, failures);
    const std::vector<FrameOutput> outputs = name_outputs(shot, options.render.output, job.frames, job.several);
    FrameStamps stamps(shot, BRISANCE_VERSION, deciding_files(shot));
    std::vector<int> unfinished;
    Steadiness steadiness;
    progress.begin_sequence(job.frames.size());
    progress.stage("verifying");
    for (std::size_t i = 0; i < job.frames.size(); ++i) {
        const FrameFile& frame = job.frames[i];
        if (const auto why = why_unfinished(outputs[i], shot, stamps.of(frame))) {
            unfinished.push_back(frame.frame);
            fmt::print("frame {}: {}\n", frame.frame,
                       *why == kNotThere ? fmt::format("{}: {}", outputs[i].exr.string(), *why) : *why);
        } else {
            steadiness.add(frame.frame, outputs[i].exr);
        }
        progress.fraction(double(i + 1) / double(job.frames.size()));
    }
    const std::size_t unsteady = print_unsteady(steadiness, options.fail_above);
    std::fflush(stdout);
    progress.finish();
    const std::size_t all = job.frames.size(), good = all - unfinished.size();
    const std::string head = fmt::format("{} of {} frame{} finished, verified", good, all, all == 1 ? "" : "s");
    std::string tail = steadiness.frames().empty() ? "" : "; " + steadiness.summary();
    if (!unfinished.empty())
        tail += fmt::format("; `brisance render --skip-existing` renders {}", describe_frames(unfinished));
    progress.summary(head, tail,
                     {{"finished", good}, {"frames", all}, {"unfinished", unfinished}, {"unsteady", unsteady}});
    return static_cast<int>(unfinished.empty() && unsteady == 0 ? ExitCode::Success : ExitCode::RenderFailed);
}

}  // namespace brisance
