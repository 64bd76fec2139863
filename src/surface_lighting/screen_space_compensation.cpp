#include "surface_lighting/screen_space_compensation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "virtual_lights/kinds/bounded_geometry.h"

namespace brisance {

namespace {

constexpr int kPatchesOfPixel = 4;  // of a pixel

// A sample belongs to a patch whose normal has at least this cosine to its own, and whose plane is nearer than this
// part of a pixel's width.
constexpr float kPatchNormal = 0.9f, kPatchPlane = 1.0f;

// A node counts as one disc where the diagonal of its box is at most this part of its distance, and its normals have at
// least this mean.
constexpr float kDiscSize = 0.4f, kDiscNormal = 0.97f;

// Rounds of interreflection end where one brings less than this part of what the pixels showed, or after so many.
constexpr double kLastRound = 1e-3;
constexpr int kMostRounds = 12;

constexpr float kOverPi = std::numbers::inv_pi_v<float>;

float length2(const vec3& v) {
    return glm::dot(v, v);
}

}  // namespace

// A point that gets light, and how far the bound takes any.
struct ScreenSpaceCompensation::Receiver {
    LitPoint point;
    vec3 position, normal;
    float reach2;  // [m^2]
};

ScreenSpaceCompensation::ScreenSpaceCompensation(int width, int height, const VirtualLightSettings& settings, int rays)
    : settings_(settings),
      width_(width),
      height_(height),
      rays_(float(std::max(rays, 1))),
      first_(std::size_t(width) * height, kNone) {}

// The last of a full pixel takes what fits none.
ScreenSpaceCompensation::Patch& ScreenSpaceCompensation::patch_of(const Sample& s) {
    std::uint32_t* at = &first_[s.pixel];
    for (int patches = 0; *at != kNone; ++patches) {
        Patch& p = patches_[*at];
        const vec3 normal = glm::normalize(p.normal);
        const float off_plane = glm::dot(s.position - p.position / p.samples, normal);
        const bool same = glm::dot(s.normal, normal) > kPatchNormal && off_plane * off_plane < kPatchPlane * s.area;
        if (same || patches + 1 == kPatchesOfPixel)
            return p;
        at = &p.next;
    }
    *at = static_cast<std::uint32_t>(patches_.size());
    return patches_.emplace_back();
}

// Lists that grow hold up to twice what is in them, and a pyramid has a third more than its first level.
std::uint64_t ScreenSpaceCompensation::bytes_of(int width, int height) {
    constexpr std::uint64_t kGrowth = 2;
    const std::uint64_t patch = kGrowth * sizeof(Patch) + 2 * sizeof(Rgb), nodes = sizeof(Node) + sizeof(Node) / 3;
    return std::uint64_t(width) * std::uint64_t(height) * (sizeof(std::uint32_t) + sizeof(Rgb) + patch + nodes);
}

void ScreenSpaceCompensation::add(const Sample& s) {
    Patch& p = patch_of(s);
    p.position += s.position;
    p.normal += s.normal;
    p.area += s.area / rays_;
    p.light += s.light;
    p.albedo += s.albedo;
    p.weight += s.share * s.albedo;
    p.samples += 1.0f;
}

void ScreenSpaceCompensation::take_means() {
    for (Patch& p : patches_) {
        const float each = 1.0f / p.samples, length = glm::length(p.normal);
        p.position *= each;
        p.normal = length > 0.0f ? p.normal / length : p.normal;
        p.light *= each;
        p.albedo *= each;
    }
}

template <class Visit>
void ScreenSpaceCompensation::for_patches(std::size_t pixel, const Visit& visit) const {
    for (std::uint32_t k = first_[pixel]; k != kNone; k = patches_[k].next)
        visit(patches_[k], k);
}

namespace {

// Adds a part to a node whose means are still sums.
template <class Node>
void add_part(Node& node, const Node& part) {
    if (!(part.area > 0.0f))
        return;
    const bool first = node.area == 0.0f;
    node.low = first ? part.low : glm::min(node.low, part.low);
    node.high = first ? part.high : glm::max(node.high, part.high);
    node.centre += part.area * part.centre;
    node.normal += part.area * part.normal;
    node.light += part.area * part.light;
    node.area += part.area;
}

template <class Node>
Node with_means(Node node) {
    if (node.area > 0.0f) {
        node.centre /= node.area;
        node.normal /= node.area;
        node.light /= node.area;
    }
    return node;
}

}  // namespace

ScreenSpaceCompensation::Node ScreenSpaceCompensation::node_of_pixel(std::size_t pixel) const {
    Node out;
    for_patches(pixel, [&](const Patch& p, std::uint32_t) {
        add_part(out, Node{p.position, p.position, p.position, p.normal, p.area, p.light});
    });
    return with_means(out);
}

ScreenSpaceCompensation::Node ScreenSpaceCompensation::node_of_children(const Level& below, int x, int y) const {
    Node out;
    for (int v = 2 * y; v < std::min(2 * y + 2, below.height); ++v)
        for (int u = 2 * x; u < std::min(2 * x + 2, below.width); ++u)
            add_part(out, below.nodes[std::size_t(v) * below.width + u]);
    return with_means(out);
}

void ScreenSpaceCompensation::build_levels() {
    levels_.clear();
    levels_.push_back({width_, height_, std::vector<Node>(first_.size())});
    parallel_for(
        first_.size(), [&](std::size_t p) { levels_[0].nodes[p] = node_of_pixel(p); }, 256);
    while (levels_.back().width > 1 || levels_.back().height > 1) {
        const int width = (levels_.back().width + 1) / 2, height = (levels_.back().height + 1) / 2;
        Level level{width, height, std::vector<Node>(std::size_t(width) * height)};
        parallel_for(
            level.nodes.size(),
            [&](std::size_t n) {
                level.nodes[n] = node_of_children(levels_.back(), int(n % std::size_t(width)), int(n / width));
            },
            256);
        levels_.push_back(std::move(level));
    }
}

// Calls take(position, normal, area, light) for the discs of a node, or leaves its children open.
template <class Take>
void ScreenSpaceCompensation::send_from(const Place& place, const Receiver& at, std::vector<Place>& open,
                                        const Take& take) const {
    const Level& level = levels_[place.level];
    const Node& node = level.nodes[std::size_t(place.y) * level.width + place.x];
    if (!(node.area > 0.0f) || length2(glm::clamp(at.position, node.low, node.high) - at.position) > at.reach2)
        return;
    const vec3 middle = 0.5f * (node.low + node.high), half = 0.5f * (node.high - node.low);
    if (!(glm::dot(middle - at.position, at.normal) + glm::dot(half, glm::abs(at.normal)) > 0.0f))
        return;  // behind the receiver
    const bool small = length2(node.high - node.low) <= kDiscSize * kDiscSize * length2(node.centre - at.position);
    if (small && length2(node.normal) >= kDiscNormal * kDiscNormal) {
        take(node.centre, node.normal, node.area, node.light);
        return;
    }
    if (place.level == 0) {
        for_patches(std::size_t(place.y) * width_ + place.x,
                    [&](const Patch& p, std::uint32_t) { take(p.position, p.normal, p.area, p.light); });
        return;
    }
    const Level& below = levels_[place.level - 1];
    for (int v = 2 * place.y; v < std::min(2 * place.y + 2, below.height); ++v)
        for (int u = 2 * place.x; u < std::min(2 * place.x + 2, below.width); ++u)
            open.push_back({place.level - 1, u, v});
}

Rgb ScreenSpaceCompensation::irradiance(const Receiver& at) const {
    thread_local std::vector<Place> open;
    open.assign(1, {levels_.size() - 1, 0, 0});
    Rgb sum(0.0f);
    const auto take = [&](const vec3& position, const vec3& normal, float area, const Rgb& light) {
        const vec3 offset = position - at.position;
        const float d2 = length2(offset);
        if (!(d2 > 0.0f) || d2 > at.reach2)
            return;
        const vec3 direction = offset / std::sqrt(d2);
        const float here = glm::dot(at.normal, direction), there = -glm::dot(normal, direction);
        if (!(here > 0.0f) || !(there > 0.0f))
            return;
        const float of_disc = d2 + area * kOverPi;
        const double kept = kept_by_bound(settings_, at.point, dvec3(direction), there, of_disc);
        sum += light * (here * there * area / of_disc * float(1.0 - kept));
    };
    while (!open.empty()) {
        const Place place = open.back();
        open.pop_back();
        send_from(place, at, open, take);
    }
    return sum;
}

std::vector<Rgb> ScreenSpaceCompensation::irradiances() const {
    std::vector<Rgb> out(patches_.size(), Rgb(0.0f));
    // No cosine is above 1: the bound takes nothing from further away.
    const auto reach2 = float(1.0 / settings_.point_bound);
    parallel_for(
        patches_.size(),
        [&](std::size_t k) {
            const Patch& p = patches_[k];
            if (p.albedo == Rgb(0.0f))
                return;
            const LitPoint point{dvec3(p.position), dvec3(p.normal), LitPoint::Kind::Surface};
            out[k] = kOverPi * irradiance({point, p.position, p.normal, reach2});
        },
        64);
    return out;
}

std::vector<Rgb> ScreenSpaceCompensation::take_pixels() {
    std::vector<Rgb> out(first_.size(), Rgb(0.0f));
    take_means();
    const auto power = [&] {
        double sum = 0.0;
        for (const Patch& p : patches_)
            sum += double(p.area) * luminance(p.light);
        return sum;
    };
    const double shown = power();
    for (int round = 0; round < kMostRounds && power() > kLastRound * shown; ++round) {
        build_levels();
        const std::vector<Rgb> arriving = irradiances();
        for (std::size_t pixel = 0; pixel < out.size(); ++pixel)
            for (std::uint32_t k = first_[pixel]; k != kNone; k = patches_[k].next) {
                out[pixel] += patches_[k].weight * arriving[k];
                patches_[k].light = patches_[k].albedo * arriving[k];
            }
    }
    return out;
}

}  // namespace brisance
