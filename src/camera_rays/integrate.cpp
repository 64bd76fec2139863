#include "camera_rays/integrate.h"

#include <algorithm>
#include <cmath>

#include "camera_rays/primary_ray.h"
#include "camera_rays/refine_edges.h"
#include "core/parallel.h"

namespace brisance {

namespace {

// Where on a segment the parts are sampled: Gauss points for two, so that a cubic extinction's integral is exact; the
// middles otherwise.
float sample_place(int part, int parts) {
    if (parts == 2)
        return part == 0 ? 0.21132487f : 0.78867513f;
    return (part + 0.5f) / parts;
}

// What is seen of a thick cell is its near end: sources that vary along it want more parts than extinction does.
constexpr double kThickVoxel = 1.0;
constexpr int kThickVoxelParts = 8;

Rgb slot(const float* record, int at) {
    return {record[at], record[at + 1], record[at + 2]};
}

vec3 sample_position(const VoxelSegment& s, double t) {
    return glm::clamp(vec3(s.origin + s.direction * t), vec3(0.0f), vec3(float(BrickLattice::kSize)));
}

// A part of a cell's segment: constant coefficients, `length` metres at `distance`.
struct Part {
    SourceRecord record;
    SimilarRecord similar;       // where the field has one
    SurroundingsRecord outside;  // the same
    float length, distance;
};

// What such a part shows: the integral of transmittance along it [m], and that times its extinction.
struct Shown {
    float path, opacity;
};

Shown shown(float extinction, float length, float& depth) {
    const float tau = extinction * length;
    const float path = std::exp(-depth) * length * phi1(tau);
    depth += tau;
    return {path, path * extinction};
}

void add_part(RaySum& sum, const SourceField& field, const Part& p) {
    const float* r = p.record.value;
    const Shown own = shown(r[SourceRecord::Extinction], p.length, sum.depth);
    const Rgb v = slot(r, SourceRecord::V) * (field.direct_emission() ? own.path : own.opacity);
    Shown scattering = own;
    if (field.has_similar()) {
        const float* s = p.similar.value;
        scattering = shown(s[SimilarRecord::Extinction], p.length, sum.similar_depth);
        // Fire seen by one scattering that did not turn it: by all smoke before it.
        const Rgb forward = slot(s, SimilarRecord::Forward);
        const float tau = r[SourceRecord::Extinction] * p.length;
        sum.cells.at(Cell::MV) += v * (sum.forward + forward * mean_depth(tau));
        sum.forward += forward * tau;
        // The similar medium shows more of the fire by what counts as not scattered there.
        sum.cells.at(Cell::MV) +=
            slot(s, SimilarRecord::V) * (field.direct_emission() ? scattering.path : scattering.opacity) - v;
    } else {
        sum.similar_depth = sum.depth;
    }
    sum.cells.at(Cell::V) += v;
    sum.cells.at(Cell::MV) += slot(r, SourceRecord::MV) * scattering.opacity;
    sum.cells.at(Cell::MM) += slot(r, SourceRecord::MM) * scattering.opacity;
    if (field.has_outside()) {
        sum.cells.at(Cell::MS) += slot(p.outside.value, SurroundingsRecord::MS) * scattering.opacity;
        sum.cells.at(Cell::MA) += slot(p.outside.value, SurroundingsRecord::MA) * scattering.opacity;
    }
    sum.albedo_sum += Rgb(own.opacity * r[SourceRecord::Albedo]);
    sum.distance_weight += own.opacity;
    sum.distance_sum += own.opacity * p.distance;
}

// Visits every part of every cell until visit(part) returns false.
template <class Visit>
void walk_parts(const SourceField& field, const Ray& ray, int parts, double end, const Visit& visit) {
    const auto visit_parts = [&](const VoxelSegment& s) {
        const double length = s.end - s.begin;
        const bool thick = field.majorant(s.brick) * length > kThickVoxel;
        const int n = thick ? std::max(parts, kThickVoxelParts) : parts;
        for (int k = 0; k < n; ++k) {
            const double t = s.begin + length * sample_place(k, n);
            const vec3 p = sample_position(s, t);
            Part part{field.sample(s.brick, p), {}, {}, static_cast<float>(length / n), static_cast<float>(t)};
            if (field.has_outside())
                part.outside = field.sample_outside(s.brick, p);
            if (field.has_similar())
                part.similar = field.sample_similar(s.brick, p);
            if (!visit(part))
                return false;
        }
        return true;
    };
    walk_voxels(field, ray, visit_parts, end);
}

// One row of pixels with lighting asked for at the march's own points: collect, light, integrate.
void marched_row(const SourceField& field, const Camera& camera, int y, const std::vector<PixelSample>& samples,
                 int parts, const LightPoints& light_points, PictureWriter& writer) {
    std::vector<MarchPoint> points;
    const auto for_rays = [&](const auto& body) {
        for (int x = 0; x < camera.settings().width; ++x)
            for (const PixelSample& s : samples)
                body(x, s, camera.ray(x + 0.5 + s.x, y + 0.5 + s.y));
    };
    for_rays([&](int, const PixelSample&, const Ray& ray) {
        RaySum sum;
        walk_parts(field, ray, parts, std::numeric_limits<double>::infinity(), [&](const Part& part) {
            points.push_back({vec3(ray.origin + ray.direction * double(part.distance)), -vec3(ray.direction)});
            add_part(sum, field, part);
            return sum.similar_depth < kOpaqueDepth;
        });
    });
    std::vector<PointLighting> lighting(points.size());
    light_points(points, lighting);
    std::size_t next = 0;
    std::vector<RaySum> row(camera.settings().width);
    for_rays([&](int x, const PixelSample& s, const Ray& ray) {
        RaySum sum;
        walk_parts(field, ray, parts, std::numeric_limits<double>::infinity(), [&](Part part) {
            const PointLighting& l = lighting[next++];
            for (int c = 0; c < 3; ++c) {
                part.record.value[SourceRecord::MV + c] = l.single[c];
                part.record.value[SourceRecord::MM + c] = l.multiple[c];
            }
            add_part(sum, field, part);
            return sum.similar_depth < kOpaqueDepth;
        });
        sum.alpha = -std::expm1(-sum.depth);
        add_weighted(row[x], sum, s.weight);
    });
    for (int x = 0; x < camera.settings().width; ++x)
        writer.pixel(x, y, row[x]);
}

// A surface that one of a pixel's rays found, with how much of its light arrives.
struct FoundSurface {
    SurfaceSample sample;
    float weight;
};

// Rows of a picture together: their surfaces are lit in one call.
class Band {
public:
    Band(const SourceField& field, const Camera& camera, const PictureSettings& settings,
         const std::vector<PixelSample>& samples, const LightSurfaces& light_surfaces, std::vector<Glare>& glare)
        : field_(field),
          camera_(camera),
          settings_(settings),
          samples_(samples),
          light_surfaces_(light_surfaces),
          glare_(glare) {}

    void draw(int begin, int end, PictureWriter& writer) {
        const int width = camera_.settings().width;
        sums_.assign(std::size_t(end - begin) * width, RaySum{});
        std::vector<std::vector<FoundSurface>> rows(end - begin);
        parallel_for(end - begin, [&](std::size_t row) { draw_row(begin, static_cast<int>(row), rows[row]); });
        if (light_surfaces_)
            light(rows, begin);
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < width; ++x)
                writer.pixel(x, y, sums_[std::size_t(y - begin) * width + x]);
    }

private:
    void draw_row(int begin, int row, std::vector<FoundSurface>& found) {
        const int width = camera_.settings().width, y = begin + row;
        for (int x = 0; x < width; ++x)
            for (std::uint32_t k = 0; k < samples_.size(); ++k) {
                const PixelSample& s = samples_[k];
                const std::uint64_t number = static_cast<std::uint64_t>(settings_.pass) << 32 | k;
                const auto pixel = static_cast<std::uint32_t>(y * width + x);
                const PixelRay ray{pixel, number, camera_.ray(x + 0.5 + s.x, y + 0.5 + s.y)};
                const PrimaryRay seen = trace_primary_ray(field_, ray, settings_);
                add_weighted(sums_[std::size_t(row) * width + x], seen.sum, s.weight);
                if (!glare_.empty())
                    glare_[pixel].add(seen.sum.cells);
                if (seen.surface)
                    found.push_back({{pixel, number, ray.ray, *seen.surface}, s.weight * std::exp(-seen.sum.depth)});
            }
    }

    void light(const std::vector<std::vector<FoundSurface>>& rows, int begin) {
        std::vector<SurfaceSample> all;
        for (const auto& row : rows)
            for (const FoundSurface& f : row)
                all.push_back(f.sample);
        std::vector<CellSum> lit(all.size());
        light_surfaces_(all, lit);
        std::size_t next = 0;
        const std::size_t first = std::size_t(begin) * camera_.settings().width;
        for (const auto& row : rows)
            for (const FoundSurface& f : row)
                sums_[f.sample.pixel - first].cells.add(lit[next++], Rgb(f.weight));
    }

    const SourceField& field_;
    const Camera& camera_;
    const PictureSettings& settings_;
    const std::vector<PixelSample>& samples_;
    const LightSurfaces& light_surfaces_;
    std::vector<Glare>& glare_;  // empty: nobody wants to know
    std::vector<RaySum> sums_;
};

// Rays whose surfaces are lit together: enough for gathers to be efficient, few enough to hold.
constexpr std::size_t kRaysAtOnce = 1 << 18;

}  // namespace

RaySum integrate(const SourceField& field, const Ray& ray, int parts, double end) {
    RaySum sum;
    walk_parts(field, ray, parts, end, [&](const Part& part) {
        add_part(sum, field, part);
        return sum.similar_depth < kOpaqueDepth;
    });
    sum.alpha = -std::expm1(-sum.depth);
    return sum;
}

int automatic_samples(const Camera& camera, const SourceField& field) {
    if (field.bricks().empty())
        return 1;
    const Medium& medium = field.medium();
    double nearest = 1e300;
    for (std::size_t b = 0; b < field.bricks().brick_count(); ++b) {
        const dvec3 centre(medium.local_of_node(field.bricks().first_node(b) + BrickLattice::kSize / 2));
        nearest = std::min(nearest, std::max(0.0, glm::dot(centre - camera.eye_local(), camera.forward())));
    }
    const double footprint = camera.pixel_angle() * nearest / medium.spacing;  // voxels per pixel
    return std::clamp(static_cast<int>(std::ceil(5.0 * std::min(footprint, 1e3))), 1, 8);
}

Image render_picture(const SourceField& field, const Camera& camera, const PictureSettings& settings,
                     const LightPoints& light_points, Progress& progress, const LightSurfaces& light_surfaces) {
    PictureWriter writer(camera, settings);
    const std::vector<PixelSample> samples = pixel_samples(camera.settings(), settings.samples_per_axis);
    const int width = camera.settings().width, height = camera.settings().height;
    if (light_points) {
        for (int y = 0; y < height; ++y) {
            marched_row(field, camera, y, samples, settings.parts, light_points, writer);
            progress.fraction(double(y + 1) / height);
        }
        return writer.take();
    }
    const std::size_t per_row = std::max<std::size_t>(1, std::size_t(width) * samples.size());
    const int rows = static_cast<int>(std::clamp<std::size_t>(kRaysAtOnce / per_row, 1, height));
    const bool refines = settings.surroundings && settings.edge_refinement > 1;
    std::vector<Glare> glare(refines ? std::size_t(width) * height : 0);
    Band band(field, camera, settings, samples, light_surfaces, glare);
    for (int y = 0; y < height; y += rows) {
        band.draw(y, std::min(y + rows, height), writer);
        progress.fraction(double(std::min(y + rows, height)) / height);
    }
    if (refines)
        refine_edges(field, camera, settings, samples, glare, writer);
    return writer.take();
}

}  // namespace brisance
