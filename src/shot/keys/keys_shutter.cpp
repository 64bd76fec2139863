#include <algorithm>

#include "shot/keys/keys.h"

namespace brisance {
namespace {

// [[time, openness], ...]: from time 0 to 1, rising, and open at some time.
Codec<std::vector<vec2>> openness_curve() {
    const Codec<vec2> pair = pair_of({0.0, 1.0});
    const auto read = [pair](const Json& json) -> std::optional<std::vector<vec2>> {
        if (!json.is_array())
            return std::nullopt;
        std::vector<vec2> curve;
        float most = 0.0f;
        for (const Json& item : json) {
            const std::optional<vec2> point = pair.read(item);
            if (!point || (!curve.empty() && !(point->x > curve.back().x)))
                return std::nullopt;
            most = std::max(most, point->y);
            curve.push_back(*point);
        }
        const bool whole = curve.empty() || (curve.front().x == 0.0f && curve.back().x == 1.0f && most > 0.0f);
        return whole ? std::optional(std::move(curve)) : std::nullopt;
    };
    return {{{"type", "array"}, {"items", pair.schema}},
            "a list of [time, openness] with times rising from 0 to 1 and openness in [0, 1], above 0 somewhere; "
            "empty: open throughout",
            read,
            [pair](const std::vector<vec2>& curve) {
                Json list = Json::array();
                for (const vec2& point : curve)
                    list.push_back(pair.write(point));
                return list;
            }};
}

}  // namespace

void add_shutter_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "shutter.length", "motion blur: for how long the shutter is open [frames]; 0: none", real({0.0, 1.0}),
        [](Shot & s) -> auto& { return s.shutter.length; }));
    keys.push_back(make_key(
        "shutter.position", "when it is open: from the frame on, about the frame, or up to the frame",
        choice<ShutterPosition>(
            {{"start", ShutterPosition::Start}, {"centre", ShutterPosition::Centre}, {"end", ShutterPosition::End}}),
        [](Shot & s) -> auto& { return s.shutter.position; }));
    keys.push_back(make_key(
        "shutter.curve", "how far it is open over that time, linear in between", openness_curve(),
        [](Shot & s) -> auto& { return s.shutter.curve; }));
    keys.push_back(make_key(
        "shutter.most_moments", "the most moments at which a frame is drawn; as many as movement has pixels are needed",
        whole(2, 256), [](Shot & s) -> auto& { return s.shutter.most_moments; }));
    keys.push_back(make_key(
        "shutter.lighting_times", "for how many of them light is computed anew; the others take the nearest",
        whole(1, 64), [](Shot & s) -> auto& { return s.shutter.lighting_times; }));
}

}  // namespace brisance
