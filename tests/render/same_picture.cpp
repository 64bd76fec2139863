#include "same_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "medium_lighting/lit_lattice.h"
#include "metrics/differences.h"
#include "metrics/layers.h"

namespace brisance::testing {

namespace {

// Haze is told from dense smoke voxel by voxel, and the outermost voxels are others on another lattice.
constexpr double kRim = 0.03;

Medium medium_of(const SameScene& scene) {
    std::vector<MediumGrids> grids;
    for (const Recipe& r : scene.volumes) {
        grids.emplace_back();
        if (r.density)
            grids.back().density = scalar_grid("density", r.world_from_index, r.box, r.density);
        if (r.flame)
            grids.back().flame = scalar_grid("flame", r.world_from_index, r.box, r.flame);
    }
    std::vector<MediumPart> parts;
    parts.reserve(grids.size());
    for (const MediumGrids& g : grids)
        parts.push_back({g, scene.shot.medium, false});
    Progress silent;
    return build_medium(parts, silent);
}

// Not stages that read files or only measure what is left, nor the same stages once more on the next coarser lattice,
// whose share of the light fades in.
bool lights(const std::string& stage) {
    return !stage.ends_with("on the next coarser lattice") && !stage.starts_with("reading") && stage != "medium" &&
           stage != "between the stages";
}

std::string listed(const std::vector<std::string>& names) {
    std::string all;
    for (const std::string& name : names)
        all += (all.empty() ? "" : ", ") + name;
    return all;
}

void expect_same_mechanism(const Mechanism& a, const Mechanism& b, const std::string& what) {
    EXPECT_EQ(listed(a.stages), listed(b.stages)) << what;
    EXPECT_EQ(listed(a.skipped), listed(b.skipped)) << what;
    EXPECT_EQ(a.haze_spacing, b.haze_spacing) << what;
    ASSERT_EQ(a.haze_nodes.size(), b.haze_nodes.size()) << what;
    for (std::size_t i = 0; i < a.haze_nodes.size(); ++i)
        EXPECT_NEAR(a.haze_nodes[i], b.haze_nodes[i], kRim) << what;
}

}  // namespace

Mechanism mechanism_of(const Statistics& statistics, const Medium& medium) {
    Mechanism m;
    const std::vector<std::uint8_t> lit = nodes_beside_extinction(medium);
    const double nodes = double(std::count(lit.begin(), lit.end(), std::uint8_t{1}));
    for (const SkippedPart& part : statistics.skipped)
        m.skipped.push_back(part.name);
    for (const StageCost& stage : statistics.stages) {
        if (!lights(stage.name))
            continue;
        m.stages.push_back(stage.name);
        if (stage.name != "light in haze")
            continue;
        m.haze_nodes.push_back(stage.detail["nodes"].get<double>() / nodes);
        m.haze_spacing.push_back(0.0f);
        for (const auto& level : stage.detail["levels"])
            m.haze_spacing.back() =
                std::max(m.haze_spacing.back(), medium.spacing * float(1 << level["level"].get<int>()));
    }
    return m;
}

LitPicture light(const SameScene& scene) {
    const Medium medium = medium_of(scene);
    Progress silent;
    LitPicture out{render_medium(scene.shot, medium, silent), {}};
    out.mechanism = mechanism_of(out.frame.statistics, medium);
    return out;
}

void expect_near_light(const LitPicture& picture, const LitPicture& other, const std::vector<std::string>& cells,
                       double error, const std::string& what) {
    for (const std::string& cell : cells) {
        const Picture a = picture_of(picture.frame.image, {cell}).picture;
        const Picture b = picture_of(other.frame.image, {cell}).picture;
        const Differences d = measure_differences(b.pixels, a.pixels);
        std::printf("%s, %s: rRMSE %.5f, mean %+.5f\n", what.c_str(), cell.c_str(), d.rrmse, d.mean);
        EXPECT_LT(d.rrmse, error) << what << ", " << cell;
    }
}

void expect_same_light(const LitPicture& picture, const LitPicture& other, const std::vector<std::string>& cells,
                       double error, const std::string& what) {
    expect_near_light(picture, other, cells, error, what);
    expect_same_mechanism(picture.mechanism, other.mechanism, what);
}

void expect_same_picture(const SameScene& scene, const SameScene& other, const std::string& what) {
    expect_same_light(light(scene), light(other), {"V", "MV", "MM"}, scene.shot.lighting.error,
                      scene.name + ", " + what);
}

}  // namespace brisance::testing
