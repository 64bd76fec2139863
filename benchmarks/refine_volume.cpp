// brisance_refine IN.vdb OUT.vdb N [AMPLITUDE]
//
// Writes a volume again with voxels N times smaller along each axis, to see how cost grows with resolution. Float grids
// are interpolated linearly, which adds no detail; grids named "density" are then multiplied by noise of mean 1 whose
// wavelengths lie between two of the old voxels and two of the new ones, equally strong in each octave. It is a
// function of position alone, so that refining twice gives the same volume as on any machine. AMPLITUDE (default 0.35)
// is its standard deviation; 0 adds nothing.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/ValueTransformer.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

// Uniform in [-1, 1], by the lattice point and the octave.
double random_value(int x, int y, int z, int octave) {
    std::uint64_t h = 0x9e3779b97f4a7c15ull * std::uint64_t(octave + 1);
    for (const int v : {x, y, z}) {
        h ^= std::uint32_t(v);
        h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
        h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
        h ^= h >> 31;
    }
    return double(h >> 11) * 0x1.0p-52 - 1.0;
}

double smooth(double t) {
    return t * t * (3.0 - 2.0 * t);
}

// Value noise of wavelength two lattice spacings and standard deviation about 0.35.
double value_noise(const openvdb::Vec3d& p, int octave) {
    const int x = int(std::floor(p.x())), y = int(std::floor(p.y())), z = int(std::floor(p.z()));
    const double fx = smooth(p.x() - x), fy = smooth(p.y() - y), fz = smooth(p.z() - z);
    double sum = 0.0;
    for (int k = 0; k < 8; ++k) {
        const int i = k >> 2, j = k >> 1 & 1, l = k & 1;
        sum +=
            (i ? fx : 1.0 - fx) * (j ? fy : 1.0 - fy) * (l ? fz : 1.0 - fz) * random_value(x + i, y + j, z + l, octave);
    }
    return sum;
}

// At a point of the old voxels' index space: octaves of spacing 1, 1/2, ... 1/n of an old voxel.
double detail(const openvdb::Vec3d& p, int n, double amplitude) {
    constexpr double kDeviationOfOctave = 0.32;
    double sum = 0.0;
    int octaves = 0;
    for (int spacing = 1; spacing < n; spacing *= 2, ++octaves)
        sum += value_noise(p * double(spacing), octaves);
    return std::exp(amplitude / (kDeviationOfOctave * std::sqrt(double(octaves))) * sum - 0.5 * amplitude * amplitude);
}

openvdb::FloatGrid::Ptr refined(const openvdb::FloatGrid& old, int n, double amplitude) {
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(old.background());
    grid->insertMeta(old);
    grid->setName(old.getName());
    // New voxel i lies at (i + 1/2) / n - 1/2 of the old ones: n new voxels fill an old one.
    openvdb::math::Transform::Ptr transform = old.transform().copy();
    transform->preTranslate(openvdb::Vec3d(0.5 / n - 0.5));
    transform->preScale(1.0 / n);
    grid->setTransform(transform);
    const bool noisy = amplitude > 0.0 && n > 1 && old.getName() == "density";
    openvdb::FloatGrid::ConstAccessor from = old.getConstAccessor();
    openvdb::FloatGrid::Accessor to = grid->getAccessor();
    for (auto value = old.cbeginValueOn(); value; ++value) {
        openvdb::CoordBBox box;
        value.getBoundingBox(box);
        const openvdb::Coord low = box.min(), high = box.max();
        const openvdb::CoordBBox inside(low.x() * n, low.y() * n, low.z() * n, high.x() * n + n - 1,
                                        high.y() * n + n - 1, high.z() * n + n - 1);
        for (auto at = inside.begin(); at; ++at) {
            const openvdb::Vec3d p = (((*at).asVec3d() + 0.5) / n) - 0.5;
            float v = openvdb::tools::BoxSampler::sample(from, p);
            if (noisy)
                v *= float(detail(p, n, amplitude));
            to.setValueOn(*at, v);
        }
    }
    grid->setGridClass(old.getGridClass());
    return grid;
}

}  // namespace

int main(int count, char** arguments) {
    const int n = count >= 4 ? std::atoi(arguments[3]) : 0;
    const double amplitude = count >= 5 ? std::atof(arguments[4]) : 0.35;
    if (count < 4 || count > 5 || n < 1 || n > 32 || !(amplitude >= 0.0 && amplitude <= 2.0)) {
        std::fprintf(stderr, "usage: brisance_refine IN.vdb OUT.vdb N [AMPLITUDE]   N: 1 to 32, AMPLITUDE: 0 to 2\n");
        return 2;
    }
    try {
        openvdb::initialize();
        openvdb::io::File in(arguments[1]);
        in.open();
        openvdb::GridPtrVec out;
        const openvdb::GridPtrVecPtr grids = in.getGrids();
        for (const openvdb::GridBase::Ptr& grid : *grids) {
            const openvdb::FloatGrid::Ptr old = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
            if (!old) {
                std::fprintf(stderr, "brisance_refine: %s: left out grid %s: only float grids are refined\n",
                             arguments[1], grid->getName().c_str());
                continue;
            }
            out.push_back(refined(*old, n, amplitude));
            std::printf("%s: %llu voxels, now %llu\n", old->getName().c_str(),
                        static_cast<unsigned long long>(old->activeVoxelCount()),
                        static_cast<unsigned long long>(out.back()->activeVoxelCount()));
        }
        openvdb::io::File(arguments[2]).write(out);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "brisance_refine: %s\n", error.what());
        return 65;
    }
    return 0;
}
