// Random numbers named by who draws them, never by what was drawn before: no thread or order can change them.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace brisance {

// One name per independent source of randomness. Append only: the value seeds the stream.
enum class Stream : std::uint32_t {
    EscapeRay = 1,
    Path,
    PathRotation,
    Certificate,
    Cutout,
    Surface,
    NodeEmitter,
    Points,
    LightCandidate,
    LightArea,
    Photon,
    RayLight,
    RayLightRoulette,
    RayLightPair,
    RayLightSurface,
    VolumetricVpl,
    VolumetricVplRoulette,
    RayLightPass,
    Mirror,
    SpecularPhotons,
    SpecularPhotonRoulette,
    VolumetricPhoton,
    StoredTrack,
    PathMoment
};

// The stream of a module that names its own, apart from those above: FNV-1a (Fowler, Noll, Vo) of the name.
constexpr Stream stream_of(std::string_view name) {
    std::uint32_t hash = 0x811c9dc5u;
    for (const char c : name)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193u;
    return static_cast<Stream>(hash | 0x80000000u);
}

// SplitMix64 (Steele, Lea, Flood 2014), keyed by identity.
class Rng {
public:
    Rng(Stream stream, std::uint64_t a, std::uint64_t b = 0) {
        for (std::uint64_t word : {static_cast<std::uint64_t>(stream), a, b})
            state_ = mix(state_ + kGolden + word);
    }

    // Uniform in [0, 1).
    float next() { return static_cast<float>(mix(state_ += kGolden) >> 40) * 0x1p-24f; }
    double next_double() { return static_cast<double>(mix(state_ += kGolden) >> 11) * 0x1p-53; }
    // Exponentially distributed, of mean 1: an optical depth to a collision.
    double next_exponential() { return -std::log1p(-next_double()); }

private:
    static constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15;

    static constexpr std::uint64_t mix(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return z ^ (z >> 31);
    }

    std::uint64_t state_ = 0;
};

}  // namespace brisance
