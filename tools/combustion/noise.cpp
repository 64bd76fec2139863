#include "noise.h"

namespace brisance::combustion {

namespace {

constexpr int kTile = 64;       // samples of the curl noise tile, each way
constexpr int kTilePeriod = 8;  // features across it

// The finaliser of MurmurHash3 [Appleby 2011], applied to a combination of its inputs.
std::uint32_t hash(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    std::uint32_t h = a * 0x9e3779b1u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu ^ (c + 0x165667b1u) * 0xc2b2ae35u ^
                      (d + 0x27d4eb2fu) * 0x2545f491u;
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    h *= 0xc2b2ae35u;
    h ^= h >> 16;
    return h;
}

// Dot product of a hashed direction (towards the twelve edges of a cube) with d.
float gradient_dot(std::uint32_t h, const vec3& d) {
    const float u = (h & 1u) ? -1.0f : 1.0f, v = (h & 2u) ? -1.0f : 1.0f;
    switch ((h >> 2) % 3) {
        case 0:
            return u * d.x + v * d.y;
        case 1:
            return u * d.y + v * d.z;
        default:
            return u * d.z + v * d.x;
    }
}

int wrapped(int i, int period) {
    return period > 0 ? ((i % period) + period) % period : i;
}

}  // namespace

float hashed_uniform(std::uint32_t seed, std::uint32_t key, std::uint32_t purpose) {
    return static_cast<float>(hash(seed, key, purpose, 0u) >> 8) * 0x1p-24f;
}

// Perlin, Improving Noise, SIGGRAPH 2002: quintic fade between gradients on the integer lattice.
float gradient_noise(const vec3& x, std::uint32_t seed, int period) {
    const vec3 floor_x = glm::floor(x);
    const ivec3 cell(floor_x);
    const vec3 f = x - floor_x;
    const vec3 w = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
    float sum = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
        const ivec3 o(corner & 1, (corner >> 1) & 1, corner >> 2);
        const std::uint32_t h = hash(seed, static_cast<std::uint32_t>(wrapped(cell.x + o.x, period)),
                                     static_cast<std::uint32_t>(wrapped(cell.y + o.y, period)),
                                     static_cast<std::uint32_t>(wrapped(cell.z + o.z, period)));
        const vec3 near(o);
        const vec3 weight = near * w + (1.0f - near) * (1.0f - w);
        sum += weight.x * weight.y * weight.z * gradient_dot(h, f - near);
    }
    return sum;
}

float fractal_noise(const vec3& x, std::uint32_t seed, int octaves, float gain) {
    float sum = 0.0f, amplitude = 1.0f, frequency = 1.0f;
    for (int o = 0; o < octaves; ++o) {
        sum += amplitude * gradient_noise(x * frequency, seed + static_cast<std::uint32_t>(o) * 101u);
        amplitude *= gain;
        frequency *= 2.0f;
    }
    return sum;
}

CurlNoise::CurlNoise(std::uint32_t seed) : tile_(ivec3(kTile + 1)) {
    Field<vec3> potential{ivec3(kTile)};
    const float spacing = float(kTilePeriod) / kTile;
    for_slabs(kTile, [&](int k) {
        for (int j = 0; j < kTile; ++j)
            for (int i = 0; i < kTile; ++i)
                for (std::uint32_t c = 0; c < 3; ++c)
                    potential(i, j, k)[int(c)] = gradient_noise(vec3(i, j, k) * spacing, seed * 3u + c, kTilePeriod);
    });
    const auto psi = [&](int i, int j, int k) {
        return potential(wrapped(i, kTile), wrapped(j, kTile), wrapped(k, kTile));
    };
    double square = 0.0;
    for (int k = 0; k <= kTile; ++k)
        for (int j = 0; j <= kTile; ++j)
            for (int i = 0; i <= kTile; ++i) {
                const vec3 dx = psi(i + 1, j, k) - psi(i - 1, j, k);
                const vec3 dy = psi(i, j + 1, k) - psi(i, j - 1, k);
                const vec3 dz = psi(i, j, k + 1) - psi(i, j, k - 1);
                const vec3 curl(dy.z - dz.y, dz.x - dx.z, dx.y - dy.x);
                tile_(i, j, k) = vec4(curl, 0.0f);
                square += glm::dot(curl, curl);
            }
    const float scale = 1.0f / static_cast<float>(std::sqrt(square / double(tile_.values.size())));
    for (vec4& v : tile_.values)
        v *= scale;
}

vec3 CurlNoise::operator()(const vec3& x) const {
    const vec3 turns = x / float(kTilePeriod);
    const vec3 position = (turns - glm::floor(turns)) * float(kTile);
    return vec3(sample(tile_, position, vec3(0.0f)));
}

}  // namespace brisance::combustion
