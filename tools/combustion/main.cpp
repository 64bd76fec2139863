// brisance-combustion: simulates a gasoline explosion and writes it as a sequence of OpenVDB files.
#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <string>

#include "core/error.h"
#include "simulation.h"
#include "write_vdb.h"

namespace {

using namespace brisance;
using namespace brisance::combustion;

// explosion.####.vdb, 7 -> explosion.0007.vdb. A pattern without # names a single file.
std::string file_of_frame(const std::string& pattern, int frame) {
    const std::size_t last = pattern.find_last_of('#');
    if (last == std::string::npos)
        return pattern;
    std::size_t first = last;
    while (first > 0 && pattern[first - 1] == '#')
        --first;
    std::string number = std::to_string(frame);
    const std::size_t width = last - first + 1;
    if (number.size() < width)
        number.insert(0, width - number.size(), '0');
    return pattern.substr(0, first) + number + pattern.substr(last + 1);
}

struct Options {
    Settings simulation;
    WriteSettings writing;
    std::string out = "explosion.####.vdb";
    std::string inner_out;  // empty: the states between frames are not written
    int frames = 40;
    int only_frame = 0;
    int threads = 0;
    bool quiet = false;
};

void declare_options(CLI::App& app, Options& o) {
    app.add_option("--out", o.out, "File pattern; # stands for a digit of the frame")->capture_default_str();
    app.add_option("--resolution", o.simulation.resolution, "Voxels across the box, in steps of 16")
        ->check(CLI::Range(16, 512))
        ->capture_default_str();
    app.add_option("--frames", o.frames, "Frames to simulate, 24 each second")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--substeps", o.simulation.substeps,
                   "States at equal distances that a frame is made of. Another number is another flow")
        ->check(CLI::Range(1, 64))
        ->capture_default_str();
    app.add_option("--inner-out", o.inner_out,
                   "File pattern: writes every state. Number n is at n / substeps frames, so that with 8 substeps "
                   "number 80 is frame 10 and 81 an eighth of a frame later");
    app.add_option("--only-frame", o.only_frame, "Simulate up to this frame and write no other")
        ->check(CLI::PositiveNumber);
    app.add_option("--seed", o.simulation.seed, "Another number, another explosion")->capture_default_str();
    app.add_option("--threads", o.threads, "0: all processors. Does not change the result")->capture_default_str();
    app.add_flag("--half", o.writing.half, "Write 16-bit floats");
    app.add_flag("!--no-velocity", o.writing.velocity, "Leave the velocity grid out");
    app.add_option("--min-density", o.writing.density_threshold, "Where density is less, store nothing ...")
        ->capture_default_str();
    app.add_option("--min-gas", o.writing.gas_threshold, "... unless the burst's gas makes up this share of the cell")
        ->capture_default_str();
    app.add_flag("--quiet", o.quiet, "Print nothing but errors");
}

void report_frame(const Simulation& simulation, int frame, const std::vector<StepReport>& steps, double seconds) {
    int cycles = 0;
    float fastest = 0.0f;
    for (const StepReport& s : steps) {
        cycles += s.pressure_cycles;
        fastest = std::max(fastest, s.maximum_speed);
    }
    std::printf("frame %3d  %.3f s  %zu steps  %d cycles  %.1f m/s  soot %.2f m3  %.1f s\n", frame, simulation.time(),
                steps.size(), cycles, double(fastest), simulation.soot_mass(), seconds);
    std::fflush(stdout);
}

// One frame, with its inner states written where they are asked for.
std::vector<StepReport> advance(Simulation& simulation, int frame, const Options& o) {
    std::vector<StepReport> reports;
    for (int s = 1; s <= o.simulation.substeps; ++s) {
        for (const StepReport& report : simulation.advance_substep())
            reports.push_back(report);
        if (!o.inner_out.empty())
            write_vdb(simulation, o.writing, file_of_frame(o.inner_out, (frame - 1) * o.simulation.substeps + s));
    }
    return reports;
}

void run(Options o) {
    const ThreadLimit limit(o.threads);
    const int last = o.only_frame > 0 ? o.only_frame : o.frames;
    if (o.out.find('#') == std::string::npos && o.only_frame == 0 && last > 1)
        throw Error(ExitCode::Usage, "--out " + o.out + ": " + std::to_string(last) +
                                         " frames need a # in the name, or choose one with --only-frame");
    if (!o.inner_out.empty() && o.inner_out.find('#') == std::string::npos)
        throw Error(ExitCode::Usage, "--inner-out " + o.inner_out + ": states need a # in the name");
    o.writing.creator = "brisance-combustion, resolution " + std::to_string(o.simulation.resolution) + ", seed " +
                        std::to_string(o.simulation.seed) + ", substeps " + std::to_string(o.simulation.substeps);
    Simulation simulation(o.simulation);
    for (int frame = 1; frame <= last; ++frame) {
        const auto start = std::chrono::steady_clock::now();
        const std::vector<StepReport> steps = advance(simulation, frame, o);
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        if (!o.quiet)
            report_frame(simulation, frame, steps, elapsed.count());
        if (o.only_frame == 0 || frame == o.only_frame)
            write_vdb(simulation, o.writing, file_of_frame(o.out, frame));
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Simulates a gasoline explosion and writes density, temperature [K], flame and velocity [m/s].");
    declare_options(app, options);
    try {
        app.parse(argc, argv);
        run(options);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : static_cast<int>(ExitCode::Usage);
    } catch (const Error& e) {
        std::fprintf(stderr, "brisance-combustion: %s\n", e.what());
        return static_cast<int>(e.code());
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "brisance-combustion: out of memory; a lower --resolution needs less\n");
        return static_cast<int>(ExitCode::Temporary);
    }
    return 0;
}
