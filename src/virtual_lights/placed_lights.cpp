#include "virtual_lights/placed_lights.h"

#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

#include "core/stopwatch.h"
#include "virtual_lights/technique.h"

namespace brisance {

namespace {

std::vector<vec3> positions_of(const std::vector<Deposit>& deposits) {
    std::vector<vec3> positions;
    positions.reserve(deposits.size());
    for (const Deposit& deposit : deposits)
        positions.push_back(deposit.position);
    return positions;
}

static_assert(std::is_trivially_copyable_v<Deposit>);

template <class T>
void append(std::string& bytes, const T* values, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

template <class T>
void take(std::string_view& bytes, std::vector<T>& values, std::size_t count) {
    values.resize(count);
    if (count > 0)
        std::memcpy(values.data(), bytes.data(), count * sizeof(T));
    bytes.remove_prefix(count * sizeof(T));
}

}  // namespace

std::string to_bytes(const PlacedLights& lights) {
    const std::array<std::uint64_t, 3> head = {lights.candidates, lights.deposits.size(),
                                               std::bit_cast<std::uint64_t>(lights.acceptance)};
    std::string bytes;
    append(bytes, head.data(), head.size());
    append(bytes, lights.deposits.data(), lights.deposits.size());
    append(bytes, lights.distance.data(), lights.distance.size());
    return bytes;
}

std::optional<PlacedLights> placed_lights_of(std::string_view bytes) {
    std::array<std::uint64_t, 3> head{};
    constexpr std::size_t each = sizeof(Deposit) + sizeof(float);
    if (bytes.size() < sizeof(head))
        return std::nullopt;
    std::memcpy(head.data(), bytes.data(), sizeof(head));
    bytes.remove_prefix(sizeof(head));
    if (bytes.size() % each != 0 || bytes.size() / each != head[1])
        return std::nullopt;
    PlacedLights out;
    out.candidates = head[0];
    out.acceptance = std::bit_cast<double>(head[2]);
    take(bytes, out.deposits, head[1]);
    take(bytes, out.distance, head[1]);
    return out;
}

PlacedLights place_lights(const DirectLight& scene, std::span<const PixelCamera> cameras,
                          const VirtualLightSettings& settings) {
    const Placement& placement = *technique_of(settings).placement;
    PlacedLights out;
    if (settings.count == 0 || !scene.surroundings())
        return out;
    const Stopwatch watch;
    PlacementReport placed;
    const std::vector<Deposit> deposits = placement.deposits({scene, cameras, settings, placed});
    out.acceptance = placed.acceptance;
    out.candidates = deposits.size();
    out.candidate_seconds = watch.seconds();
    if (deposits.empty())
        return out;
    const Survivors chosen = placement.thin(positions_of(deposits), settings);
    for (std::size_t i = 0; i < chosen.index.size(); ++i)
        if (chosen.distance[i] > 0.0f) {  // else a deposit without another one elsewhere
            out.deposits.push_back(deposits[chosen.index[i]]);
            out.distance.push_back(chosen.distance[i]);
        }
    out.elimination_seconds = watch.seconds() - out.candidate_seconds;
    return out;
}

}  // namespace brisance
