#include "inspect_velocity.h"

#include <fmt/format.h>

#include "core/error.h"
#include "render/input/read_volume.h"
#include "retiming/choose_retiming.h"
#include "volume/frame_path.h"
#include "volume/velocity_mapping.h"

namespace brisance {
namespace {

std::string form_of(const std::filesystem::path& file, const VelocityMapping& mapping) {
    VdbReader reader(file);
    VelocityGrids grids;
    for (const GridChoice& choice : mapping.grids)
        grids.push_back(reader.read(choice.name, choice.index, std::uint64_t{16} << 30));
    const CentredVelocity velocity = centred_velocity(grids);
    const GridInfo& info = grids.front().info;
    std::string text =
        fmt::format("{}{}, class {}; lengths up to {:.4g}, 99 % below {:.4g}", grids.size() == 3 ? "three of " : "",
                    info.value_type, info.grid_class, velocity.largest, velocity.typical);
    if (velocity.outliers > 0)
        text += fmt::format(", {} outlier{} above {:.4g}", velocity.outliers, velocity.outliers == 1 ? "" : "s",
                            velocity.limit);
    return text;
}

std::string unit_of(const std::string& pattern, const std::vector<int>& frames) {
    if (frames.size() < 2)
        return "not known: the file stands alone, and its unit shows in how neighbouring frames differ; set "
               "velocity.unit";
    const VolumeSettings volume;
    const DecidingField field = deciding_field(pattern, frames, volume, MediumSettings{});
    RetimingQuestion question;
    question.retime = Retime::Advect;
    question.on_disk = frames;
    question.has_velocity = field.has_velocity;
    question.why_no_velocity = field.why_no_velocity;
    question.where = pattern;
    Progress silent;
    const RetimingChoice choice = choose_retiming(
        question, [&](int frame) { return read_deciding(resolve_frame(pattern, frame), volume, field, silent); });
    return choice.fit->describe(question.velocity.frames_per_second);
}

}  // namespace

InspectedVelocity inspect_velocity(const std::filesystem::path& file, const std::string& pattern,
                                   const std::vector<int>& frames) {
    InspectedVelocity out;
    try {
        const VelocityMapping mapping = map_velocity(list_grids(file), {}, file.string());
        if (mapping.grids.empty())
            return out;
        out.mapping = mapping.describe();
        out.form = form_of(file, mapping);
        out.unit = unit_of(pattern, frames);
    } catch (const Error& error) {
        out.unit = std::string("not known: ") + error.what();
    }
    return out;
}

std::string velocity_text(const InspectedVelocity& velocity) {
    if (velocity.mapping.empty())
        return "velocity   none\n";
    return fmt::format("velocity   {}\n  {}\n  unit: {}\n", velocity.mapping, velocity.form, velocity.unit);
}

}  // namespace brisance
