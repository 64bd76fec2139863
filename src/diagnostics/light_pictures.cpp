#include "diagnostics/light_pictures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr float kDim = 0.25f;  // of the picture's luminance, behind the discs

// Of a disc [pixels]: three pixels across in a picture of 360 rows.
double disc_radius(int height) {
    return std::max(0.75, height / 240.0);
}

struct Disc {
    std::size_t light;
    glm::dvec2 middle;  // [pixels]
    double distance;    // from the eye [m]
};

// The disc of a light that no surface hides from the camera.
std::optional<Disc> disc_of(const VirtualLights& lights, std::size_t i, const Intersector& surfaces,
                            const Camera& camera) {
    const VirtualLight& light = lights.lights()[i];
    const std::optional<glm::dvec2> middle = camera.project(light.position);
    const dvec3 away = light.position - camera.eye_local();
    if (!middle || !(middle->x >= 0.0 && middle->x < camera.settings().width && middle->y >= 0.0 &&
                     middle->y < camera.settings().height && glm::dot(away, light.frame.normal) < 0.0))
        return std::nullopt;
    // The ray ends just above the light's own surface, at a distance that single precision resolves from the camera.
    const double clear = std::max(1e-3 * light.radius, 1e-5 * glm::length(away));
    const dvec3 to_light = away + clear * light.frame.normal;
    const double distance = glm::length(to_light);
    if (surfaces.occluded({camera.eye_local(), to_light / distance}, distance))
        return std::nullopt;
    return Disc{i, *middle, distance};
}

// The discs of all visible lights, the farthest first.
std::vector<Disc> discs_of(const VirtualLights& lights, const Intersector& surfaces, const Camera& camera) {
    std::vector<std::optional<Disc>> found(lights.lights().size());
    parallel_for(found.size(), [&](std::size_t i) { found[i] = disc_of(lights, i, surfaces, camera); });
    std::vector<Disc> discs;
    for (const std::optional<Disc>& disc : found)
        if (disc)
            discs.push_back(*disc);
    std::stable_sort(discs.begin(), discs.end(), [](const Disc& a, const Disc& b) { return a.distance > b.distance; });
    return discs;
}

// All pixels whose middle lies within the disc, and the one that its own middle lies in.
template <class Paint>
void cover(const Disc& disc, int width, int height, const Paint& paint) {
    const double radius = disc_radius(height);
    const auto first = [&](double at) { return std::max(static_cast<int>(std::floor(at - radius)), 0); };
    const auto last = [&](double at, int size) {
        return std::min(static_cast<int>(std::floor(at + radius)), size - 1);
    };
    for (int y = first(disc.middle.y); y <= last(disc.middle.y, height); ++y)
        for (int x = first(disc.middle.x); x <= last(disc.middle.x, width); ++x) {
            const bool within = std::hypot(x + 0.5 - disc.middle.x, y + 0.5 - disc.middle.y) <= radius;
            const bool own = x == static_cast<int>(disc.middle.x) && y == static_cast<int>(disc.middle.y);
            if (within || own)
                paint(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
        }
}

Layer one_channel(const std::string& name, std::vector<float> pixels) {
    return {name, {name}, true, std::move(pixels)};
}

std::vector<float> counts(const VirtualLights& lights, const Surroundings& surroundings, const Camera& camera) {
    const auto width = static_cast<std::size_t>(camera.settings().width);
    std::vector<float> out(width * static_cast<std::size_t>(camera.settings().height), 0.0f);
    parallel_for(out.size(), [&](std::size_t p) {
        const std::size_t column = p % width, row = p / width;
        const Ray ray = camera.ray(double(column) + 0.5, double(row) + 0.5);
        const std::optional<SurfaceHit> hit = surroundings.intersector().first_hit(ray);
        if (hit)
            out[p] = static_cast<float>(
                lights.count_covering(*hit, surface_point(surroundings.scene(), *hit, -ray.direction)));
    });
    return out;
}

void draw_discs(LightPictures& out, const VirtualLights& lights, const std::vector<Disc>& discs, const Camera& camera,
                const Layer& picture) {
    const auto pixels = static_cast<std::size_t>(out.image.width) * static_cast<std::size_t>(out.image.height);
    Layer beauty{"", {"R", "G", "B", "A"}, false, std::vector<float>(4 * pixels, 1.0f)};
    Layer alone{"lights", {"R", "G", "B", "A"}, false, std::vector<float>(4 * pixels, 0.0f)};
    Layer number = one_channel("light", std::vector<float>(pixels, 0.0f));
    for (std::size_t p = 0; p < pixels; ++p) {
        const float* const from = &picture.pixels[p * picture.channels.size()];
        std::fill_n(&beauty.pixels[4 * p], 3, kDim * luminance(Rgb(from[0], from[1], from[2])));
    }
    for (const Disc& disc : discs) {
        const VirtualLight& light = lights.lights()[disc.light];
        const Rgb sent = lights.radiance(light, glm::normalize(camera.eye_local() - light.position));
        cover(disc, out.image.width, out.image.height, [&](std::size_t p) {
            for (Layer* const layer : {&beauty, &alone}) {
                std::copy_n(&sent.x, 3, &layer->pixels[4 * p]);
                layer->pixels[4 * p + 3] = 1.0f;
            }
            number.pixels[p] = static_cast<float>(disc.light + 1);
        });
    }
    out.image.layers = {std::move(beauty), std::move(alone), std::move(number)};
    out.seen = discs.size();
}

void lay_out_profiles(LightPictures& out, const VirtualLights& lights) {
    const auto count = static_cast<int>(lights.report().profiles);
    if (count == 0)
        return;
    out.tile = lights.profiles().resolution();
    out.columns = static_cast<int>(std::ceil(std::sqrt(double(count))));
    out.profiles.width = out.columns * out.tile;
    out.profiles.height = (count + out.columns - 1) / out.columns * out.tile;
    const auto width = static_cast<std::size_t>(out.profiles.width), side = static_cast<std::size_t>(out.tile);
    Layer layer{"", {"R", "G", "B"}, false, {}};
    layer.pixels.assign(3 * width * static_cast<std::size_t>(out.profiles.height), 0.0f);
    for (const VirtualLight& light : lights.lights()) {
        if (light.profile < 0)
            continue;
        const std::span<const Rgb> map = lights.profiles().map(light);
        const auto left = static_cast<std::size_t>(light.profile % out.columns) * side,
                   top = static_cast<std::size_t>(light.profile / out.columns) * side;
        for (std::size_t t = 0; t < map.size(); ++t)
            std::copy_n(&map[t].x, 3, &layer.pixels[3 * ((top + t / side) * width + left + t % side)]);
    }
    out.profiles.layers = {std::move(layer)};
}

}  // namespace

LightPictures make_light_pictures(const VirtualLights& lights, const Surroundings& surroundings, const Camera& camera,
                                  const Layer& picture, std::vector<float> lengths) {
    LightPictures out;
    const dvec3 origin = surroundings.scene().origin;
    for (const VirtualLight& light : lights.lights())
        out.lights.push_back({light.position + origin, light.frame.normal, light.frame.tangent, light.radius,
                              light.area, light.flux, light.profile});
    out.image.width = camera.settings().width;
    out.image.height = camera.settings().height;
    draw_discs(out, lights, discs_of(lights, surroundings.intersector(), camera), camera, picture);
    out.image.layers.push_back(one_channel("count", counts(lights, surroundings, camera)));
    out.image.layers.push_back(one_channel("path_length", std::move(lengths)));
    lay_out_profiles(out, lights);
    return out;
}

}  // namespace brisance
