// brisance-candle: writes a candle's flame as an OpenVDB file.
//
// A steady laminar diffusion flame is no case for a solver of turbulent flow: its shape is known well enough to write
// down. A teardrop 30 mm tall; soot forms in a shell around the dark, cool cone above the wick and fills the flame
// toward its tip, where it burns; the sheet where fuel meets air is the hottest.
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

constexpr double kVoxel = 0.5e-3, kHeight = 30e-3, kRadius = 4.5e-3;  // [m]
constexpr float kLeastDensity = 0.01f;

struct Gas {
    float soot = 0.0f;         // 1 where there is most
    float temperature = 0.0f;  // [K]
};

double smooth(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// `s`: from the wick, 0, to the tip, 1.
double radius_at(double s) {
    return s <= 0.0 || s >= 1.0 ? 0.0 : kRadius * 1.72 * std::pow(s, 0.45) * std::pow(1.0 - s, 0.75);
}

Gas gas_at(double r, double z) {
    const double s = z / kHeight, edge = radius_at(s);
    if (!(edge > 0.0) || r >= edge)
        return {};
    const double part = r / edge;                    // 0 on the axis, 1 at the sheet
    const double cone = 1.0 - smooth(0.15, 0.5, s);  // how much of the dark cone is left
    const double inside = smooth(0.35, 0.75, part);  // out of it
    const double soot = (1.0 - cone * (1.0 - inside)) * (1.0 - smooth(0.8, 1.0, part)) * smooth(0.05, 0.35, s) *
                        (1.0 - smooth(0.8, 1.0, s));
    const double temperature = 1000.0 + 650.0 * (1.0 - cone * (1.0 - part)) + 250.0 * smooth(0.5, 1.0, part);
    return {static_cast<float>(soot), static_cast<float>(temperature)};
}

openvdb::FloatGrid::Ptr empty_grid(const char* name) {
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName(name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setSaveFloatAsHalf(true);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(kVoxel));
    return grid;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: brisance-candle FILE.vdb\n");
        return 2;
    }
    openvdb::initialize();
    const auto density = empty_grid("density"), temperature = empty_grid("temperature");
    auto densities = density->getAccessor(), temperatures = temperature->getAccessor();
    const int side = static_cast<int>(kRadius / kVoxel) + 2, top = static_cast<int>(kHeight / kVoxel);
    for (int x = -side; x <= side; ++x)
        for (int y = -side; y <= side; ++y)
            for (int z = 0; z <= top; ++z) {
                const Gas gas = gas_at(std::hypot(x, y) * kVoxel, z * kVoxel);
                if (gas.soot < kLeastDensity)
                    continue;
                densities.setValue({x, y, z}, gas.soot);
                temperatures.setValue({x, y, z}, gas.temperature);
            }
    try {
        openvdb::io::File out(argv[1]);
        openvdb::MetaMap metadata;
        metadata.insertMeta("creator", openvdb::StringMetadata("brisance-candle"));
        out.write({density, temperature}, metadata);
        out.close();
    } catch (const openvdb::Exception& e) {
        std::fprintf(stderr, "brisance-candle: %s: %s\n", argv[1], e.what());
        return 74;
    }
    return 0;
}
