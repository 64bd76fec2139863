#include "virtual_lights/flux/octahedral_profiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/parallel.h"
#include "virtual_lights/octahedral_map.h"

namespace brisance {

namespace {

// A table pays off for this many lights of one material.
constexpr std::size_t kWorthTable = 8;

float rounded(float x, float steps) {
    return std::round(x * steps) / steps;
}

// What is no metal scatters by its coat, whatever its base colour, and by its base in proportion to that: lights whose
// materials differ in it alone share tables. Textures change the colour from light to light.
bool is_coated_base(const SurfaceMaterial& m) {
    return m.metallic == 0.0f;
}

SurfaceMaterial white(SurfaceMaterial m) {
    m.base_colour = Rgb(1.0f);
    return m;
}

// All but what is known of a white base.
Lobes lobes_beside_base(const SurfaceMaterial& m) {
    return is_coated_base(m) ? Lobes::Specular : Lobes::All;
}

// Base colours of metal in even steps of their square root: what is dark is scaled up again (LightSet::reflected).
SurfaceMaterial rounded(SurfaceMaterial m) {
    m.metallic = rounded(m.metallic, 32.0f);
    for (int c = 0; c < 3; ++c) {
        const float root = rounded(std::sqrt(m.base_colour[c]), 32.0f);
        if (!is_coated_base(m))
            m.base_colour[c] = m.metallic == 1.0f ? std::max(root * root, 1e-3f) : rounded(m.base_colour[c], 64.0f);
        m.specular_colour[c] = rounded(m.specular_colour[c], 32.0f);
    }
    m.roughness = rounded(m.roughness, 32.0f);
    m.specular = rounded(m.specular, 32.0f);
    return m;
}

std::array<float, 10> key_of(const SurfaceMaterial& m) {
    const Rgb base = is_coated_base(m) ? Rgb(0.0f) : m.base_colour;
    return {base.x,     base.y,      base.z, m.specular_colour.x, m.specular_colour.y, m.specular_colour.z,
            m.metallic, m.roughness, m.ior,  m.specular};
}

// Mean of the BSDF (without cosine) between texels, by one direction in each quarter of either.
class Reflection {
public:
    Reflection(const SurfaceMaterial& material, Lobes lobes, int side) : bsdf_(material, {}, lobes), side_(side) {}

    // For `in`, to all directions: with lobes that are narrower than texels scaled to the power that they reflect,
    // which points of texels may miss or hit by their peaks (at grazing angles 1.9 times of it at a roughness of 0.3).
    template <class Use>  // use(out, Rgb)
    void from(std::size_t in, const Use& use) const {
        const std::size_t texels = static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
        thread_local std::vector<Rgb> row;
        row.resize(texels);
        Rgb found(0.0f);
        for (std::size_t out = 0; out < texels; ++out) {
            row[out] = between(in, out);
            found += row[out] * float(centre(out).z * 2.0 * std::numbers::pi / double(texels));
        }
        const Rgb truth = albedo(in);
        for (std::size_t out = 0; out < texels; ++out)
            use(out, row[out] * Rgb(scale(truth.x, found.x), scale(truth.y, found.y), scale(truth.z, found.z)));
    }

private:
    static float scale(float truth, float found) { return found > 0.0f ? truth / found : 0.0f; }

    // Of the power that arrives from the texel, what is reflected: by directions of the BSDF from each quarter of it.
    Rgb albedo(std::size_t in) const {
        constexpr int kPoints = 32;
        Rgb sum(0.0f);
        for (int quarter = 0; quarter < 4; ++quarter)
            for (int i = 0; i < kPoints; ++i) {
                const dvec3 u = glm::fract(dvec3(0.5) + double(4 * i + quarter) * kLattice);
                if (const std::optional<BsdfSample> sample = bsdf_.sample(direction(in, quarter), u))
                    sum += sample->weight;
            }
        return sum / float(4 * kPoints);
    }

    Rgb between(std::size_t in, std::size_t out) const {
        constexpr int kOpposite[] = {3, 0, 2, 1};
        Rgb sum(0.0f);
        for (int quarter = 0; quarter < 4; ++quarter) {
            const dvec3 wi = direction(in, quarter), wo = direction(out, kOpposite[quarter]);
            sum += bsdf_.evaluate(wo, wi) / float(wi.z);
        }
        return 0.25f * sum;
    }

    dvec3 centre(std::size_t texel) const {
        return hemisphere_of_square((double(texel % static_cast<std::size_t>(side_)) + 0.5) / side_,
                                    (double(texel / static_cast<std::size_t>(side_)) + 0.5) / side_);
    }

    dvec3 direction(std::size_t texel, int quarter) const {
        const std::size_t row = texel / static_cast<std::size_t>(side_),
                          column = texel % static_cast<std::size_t>(side_);
        const double x = double(column) + 0.25 + 0.5 * (quarter & 1), y = double(row) + 0.25 + 0.5 * (quarter >> 1);
        return hemisphere_of_square(x / side_, y / side_);
    }

    // M. Roberts' additive sequence (2018) in three dimensions: powers of 1 / 1.2207440846.
    static constexpr dvec3 kLattice{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};

    Bsdf bsdf_;
    int side_;
};

// Of luminances, over directions in proportion to their cosine, for directions of each cosine.
Profiles::Moments moments_of_photons(const SurfaceMaterial& material) {
    constexpr int kSide = 16;
    const Bsdf coat(material, {}, lobes_beside_base(material)), base(white(material), {}, Lobes::Base);
    const double has_base = is_coated_base(material) ? 1.0 : 0.0;
    Profiles::Moments out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double z = (double(i) + 0.5) / Profiles::kCosines;
        const dvec3 wo(std::sqrt(1.0 - z * z), 0.0, z);
        double weight = 0.0;
        Profiles::MomentsOfCosine& sum = out[i];
        for (int t = 0; t < kSide * kSide; ++t) {
            const dvec3 wi = hemisphere_of_square((t % kSide + 0.5) / kSide, (t / kSide + 0.5) / kSide);
            const double by_coat = luminance(coat.evaluate(wo, wi)),  // f times cosine
                by_base = has_base * luminance(base.evaluate(wo, wi));
            sum.coat += by_coat;
            sum.base += by_base;
            sum.coat_square += by_coat * by_coat / wi.z;
            sum.base_square += by_base * by_base / wi.z;
            sum.product += by_coat * by_base / wi.z;
            weight += wi.z;
        }
        for (double* const moment : {&sum.coat, &sum.base, &sum.coat_square, &sum.base_square, &sum.product})
            *moment /= weight;
    }
    return out;
}

using Group = std::vector<std::size_t>;  // lights of one material

// All pairs, [in][out].
std::vector<Rgb> table_of(const Reflection& reflection, int side) {
    const std::size_t texels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    std::vector<Rgb> table(texels * texels);
    parallel_for(texels, [&](std::size_t in) {
        reflection.from(in, [&](std::size_t out, const Rgb& f) { table[in * texels + out] = f; });
    });
    return table;
}

// What the materials of a group reflect.
class GroupReflection {
public:
    GroupReflection(const SurfaceMaterial& m, int side, bool by_table)
        : texels_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side)),
          coated_(is_coated_base(m)),
          beside_base_(m, lobes_beside_base(m), side),
          base_(white(m), Lobes::Base, side) {
        if (!by_table)
            return;
        table_beside_base_ = table_of(beside_base_, side);
        if (coated_)
            table_of_base_ = table_of(base_, side);
    }

    // Adds to all texels what a material of the group reflects of light from the texel `in`.
    void add(const SurfaceMaterial& m, std::size_t in, const Rgb& irradiance, Rgb* map) const {
        add(beside_base_, table_beside_base_, in, irradiance, map);
        if (coated_)
            add(base_, table_of_base_, in, irradiance * m.base_colour, map);
    }

private:
    void add(const Reflection& reflection, const std::vector<Rgb>& table, std::size_t in, const Rgb& irradiance,
             Rgb* map) const {
        const auto add_to = [&](std::size_t out, const Rgb& f) { map[out] += irradiance * f; };
        if (table.empty())
            return reflection.from(in, add_to);
        for (std::size_t out = 0; out < texels_; ++out)
            add_to(out, table[in * texels_ + out]);
    }

    std::size_t texels_;
    bool coated_;
    Reflection beside_base_, base_;                       // `base_` is white
    std::vector<Rgb> table_beside_base_, table_of_base_;  // empty: lights are too few
};

}  // namespace

Profiles::Profiles(std::span<VirtualLight> lights, const LightAccounts& accounts, int resolution)
    : side_(static_cast<std::size_t>(resolution)) {
    const std::size_t texels = side_ * side_;
    std::map<std::array<float, 10>, Group> groups;
    std::size_t count = 0;
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (lights[i].profile >= 0) {
            lights[i].material = rounded(lights[i].material);
            groups[key_of(lights[i].material)].push_back(i);
            ++count;
        }
    texels_.assign(count * texels, Rgb(0.0f));
    arrived_.resize(count);
    for (const auto& [key, group] : groups) {
        for (const std::size_t i : group)
            arrived_[static_cast<std::size_t>(lights[i].profile)] = {accounts.photons(i), accounts.mean_weight(i),
                                                                     moments_.size()};
        moments_.push_back(moments_of_photons(lights[group.front()].material));
        const GroupReflection reflection(lights[group.front()].material, resolution, group.size() >= kWorthTable);
        parallel_for(group.size(), [&, &group = group](std::size_t g) {
            const VirtualLight& light = lights[group[g]];
            Rgb* const map = texels_.data() + static_cast<std::size_t>(light.profile) * texels;
            for (std::size_t in = 0; in < texels; ++in) {
                const Rgb irradiance = accounts.texel(group[g], in) / float(light.area);
                if (irradiance != Rgb(0.0f))
                    reflection.add(light.material, in, irradiance, map);
            }
        });
    }
}

Rgb base_flux(const VirtualLight& light, std::size_t index, const LightAccounts& accounts, int resolution) {
    const Bsdf bsdf(light.material, {});
    const auto side = static_cast<std::size_t>(resolution);
    Rgb sum(0.0f);
    for (std::size_t y = 0; y < side; ++y)
        for (std::size_t x = 0; x < side; ++x) {
            const dvec3 in = hemisphere_of_square((double(x) + 0.5) / resolution, (double(y) + 0.5) / resolution);
            sum += accounts.texel(index, y * side + x) * bsdf.base_albedo(in);
        }
    return sum;
}

Rgb Profiles::radiance(const VirtualLight& light, const dvec3& toward) const {
    const Rgb* const map = map_of(light);
    const glm::dvec2 p = square_of_hemisphere(light.frame.local_from_world(toward)) * double(side_) - 0.5;
    const double last = double(side_) - 1.0;
    const double x = std::clamp(p.x, 0.0, last), y = std::clamp(p.y, 0.0, last);
    const auto x0 = static_cast<std::size_t>(x), y0 = static_cast<std::size_t>(y);
    const std::size_t x1 = std::min(x0 + 1, side_ - 1), y1 = std::min(y0 + 1, side_ - 1);
    const auto fx = static_cast<float>(x - double(x0)), fy = static_cast<float>(y - double(y0));
    const auto row = [&](std::size_t r) { return (1.0f - fx) * map[r * side_ + x0] + fx * map[r * side_ + x1]; };
    return (1.0f - fy) * row(y0) + fy * row(y1);
}

Profiles::Behind Profiles::photons_behind(const VirtualLight& light, double cosine) const {
    const Arrived& arrived = arrived_[static_cast<std::size_t>(light.profile)];
    const int step = std::clamp(static_cast<int>(cosine * kCosines), 0, kCosines - 1);
    const MomentsOfCosine& m = moments_[arrived.material][static_cast<std::size_t>(step)];
    const double colour = luminance(light.material.base_colour), mean = m.coat + colour * m.base,
                 square = m.coat_square + colour * (2.0 * m.product + colour * m.base_square);
    const double share = square > 0.0 ? std::min(1.0, mean * mean / square) : 1.0;
    return {arrived.photons * share, arrived.one * share};
}

Rgb Profiles::exitance(const VirtualLight& light) const {
    const Rgb* const map = map_of(light);
    const double solid_angle = 2.0 * std::numbers::pi / double(side_ * side_);
    Rgb sum(0.0f);
    for (std::size_t y = 0; y < side_; ++y)
        for (std::size_t x = 0; x < side_; ++x) {
            const dvec3 d = hemisphere_of_square((double(x) + 0.5) / double(side_), (double(y) + 0.5) / double(side_));
            sum += map[y * side_ + x] * float(d.z * solid_angle);
        }
    return sum;
}

float Profiles::brightest(const VirtualLight& light) const {
    float most = 0.0f;
    for (std::size_t t = 0; t < side_ * side_; ++t)
        most = std::max(most, luminance(map_of(light)[t]));
    return most;
}

}  // namespace brisance
