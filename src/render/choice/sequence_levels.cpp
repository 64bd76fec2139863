#include "render/choice/sequence_levels.h"

#include <fmt/format.h>

#include "forecast/correction_plan.h"
#include "forecast/mean_escape.h"
#include "forecast/scattering_choice.h"
#include "medium_lighting/automatic_levels.h"
#include "render/input/frame_input.h"

namespace brisance {
namespace {

// Keeps warnings; what is read here is read and told of again with its own frame.
class WarningsAlone : public Progress {
public:
    explicit WarningsAlone(Progress& to) : to_(to) {}
    void stage(const std::string& name) override { to_.stage(name); }
    void warning(const std::string& code, const std::string& line) override { to_.warning(code, line); }

private:
    Progress& to_;
};

bool leaves_lattices_open(const Shot& shot) {
    return shot.method != RenderMethod::Path &&
           (shot.lighting.lattice_level < 0 || shot.lighting.smoke_lattice_level < 0 || shot.lighting.levels <= 0);
}

void choose_lattices(Shot& shot, const FrameInput& input, const std::string& file, Progress& progress) {
    Shot by_grid = shot;
    by_grid.method = RenderMethod::LightingGrid;
    const Plan plan = plan_cells(by_grid, input.medium, input.surroundings.get());
    const LightingSettings lights =
        shot_of_lights(by_grid, plan, {input.medium, input.surroundings.get(), input.camera}).lighting;
    const AutomaticLevels levels = automatic_levels_of(input.medium, input.surroundings.get(), lights);
    if (shot.lighting.smoke_lattice_level < 0)
        shot.lighting.smoke_lattice_level = levels.smoke;
    if (shot.lighting.lattice_level < 0)
        shot.lighting.lattice_level = levels.light;
    if (shot.lighting.levels <= 0)
        shot.lighting.levels = levels.lighting;
    progress.notice(
        fmt::format("lattices of all frames, by the largest file, {}: lighting.levels={}, lighting.lattice_level={}, "
                    "lighting.smoke_lattice_level={}",
                    file, shot.lighting.levels, shot.lighting.lattice_level, shot.lighting.smoke_lattice_level));
}

void choose_escape(Shot& shot, const Medium& medium, const std::string& file, Progress& progress) {
    shot.scattering.escape = static_cast<float>(mean_escape(medium));
    progress.notice(
        fmt::format("mean escape probability of all frames, by the largest file, {}: scattering.escape={:.4g}", file,
                    shot.scattering.escape));
}

}  // namespace

bool leaves_levels_open(const Shot& shot) {
    return leaves_lattices_open(shot) || leaves_escape_open(shot);
}

Shot with_levels_of(Shot shot, const std::filesystem::path& volume, int frame, Progress& progress) {
    if (!leaves_levels_open(shot))
        return shot;
    WarningsAlone quiet(progress);
    Statistics unused;
    const FrameInput input = load_frame(shot, volume, frame, unused, quiet);
    const std::string file = volume.filename().string();
    if (leaves_lattices_open(shot))
        choose_lattices(shot, input, file, progress);
    if (leaves_escape_open(shot))
        choose_escape(shot, input.medium, file, progress);
    return shot;
}

}  // namespace brisance
