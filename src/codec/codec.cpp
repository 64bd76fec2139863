#include "codec/codec.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace brisance {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMebibyte = 1048576.0;

std::optional<double> number(const Json& json, const Range& range) {
    if (!json.is_number())
        return std::nullopt;
    const auto value = json.get<double>();
    return std::isfinite(value) && range.contains(value) ? std::optional<double>(value) : std::nullopt;
}

// As number, and representable in single precision.
std::optional<float> float_number(const Json& json, const Range& range) {
    const std::optional<double> value = number(json, range);
    if (!value || std::abs(*value) > static_cast<double>(std::numeric_limits<float>::max()))
        return std::nullopt;
    return static_cast<float>(*value);
}

template <class Read>
auto numbers(const Json& json, std::size_t count, Read read) {
    std::vector<typename decltype(read(json))::value_type> values;
    if (json.is_array() && json.size() == count)
        for (const Json& item : json)
            if (const auto value = read(item))
                values.push_back(*value);
    if (values.size() != count)
        values.clear();
    return values;
}

Json number_schema(const Range& range) {
    Json schema = {{"type", "number"}};
    range.add_to(schema);
    return schema;
}

Json array_schema(const Json& items, std::size_t count) {
    return {{"type", "array"}, {"items", items}, {"minItems", count}, {"maxItems", count}};
}

std::optional<Rgb> read_rgb(const Json& json, const Range& range) {
    if (const std::optional<float> gray = float_number(json, range))
        return Rgb(*gray);
    const auto values = numbers(json, 3, [&](const Json& item) { return float_number(item, range); });
    return values.empty() ? std::nullopt : std::optional<Rgb>(Rgb(values[0], values[1], values[2]));
}

Json write_rgb(const Rgb& value) {
    return {shortest_decimal(value.x), shortest_decimal(value.y), shortest_decimal(value.z)};
}

Json rgb_schema(const Range& range) {
    return {{"anyOf", Json::array({number_schema(range), array_schema(number_schema(range), 3)})}};
}

std::optional<std::vector<RampStop>> read_ramp(const Json& json) {
    if (!json.is_array())
        return std::nullopt;
    std::vector<RampStop> stops;
    for (const Json& item : json) {
        if (!item.is_array() || item.size() != 2)
            return std::nullopt;
        const std::optional<float> value = float_number(item[0], grid_value());
        const std::optional<Rgb> colour = read_rgb(item[1], tint());
        if (!value || !colour || (!stops.empty() && !(*value > stops.back().value)))
            return std::nullopt;
        stops.push_back({*value, *colour});
    }
    return stops;
}

}  // namespace

double shortest_decimal(float value) {
    return std::stod(fmt::format("{}", value));
}

Range at_least(double low) {
    return {low, kInfinity};
}
Range above(double low) {
    return {low, kInfinity, true};
}
Range any_number() {
    return {-kInfinity, kInfinity};
}

Range radiometric() {
    return {0.0, 1e20};
}
Range tint() {
    return {0.0, 1e6};
}
Range grid_value() {
    return {-1e20, 1e20};
}
Range kelvin() {
    return {0.0, 1e8};
}
Range coordinate() {
    return {-1e15, 1e15};
}

bool Range::contains(double value) const {
    return (without_low ? value > low : value >= low) && (without_high ? value < high : value <= high);
}

std::string Range::words() const {
    const bool below = std::isfinite(high);
    if (!std::isfinite(low))
        return below ? fmt::format("{} {}", without_high ? "below" : "at most", high) : "of any size";
    if (!below)
        return fmt::format("{} {}", without_low ? "above" : "at least", low);
    return fmt::format("in {}{}, {}{}", without_low ? '(' : '[', low, high, without_high ? ')' : ']');
}

void Range::add_to(Json& schema) const {
    if (std::isfinite(low))
        schema[without_low ? "exclusiveMinimum" : "minimum"] = low;
    if (std::isfinite(high))
        schema[without_high ? "exclusiveMaximum" : "maximum"] = high;
}

Codec<double> real(const Range& range) {
    return {number_schema(range), "a number " + range.words(),
            [range](const Json& json) { return number(json, range); }, [](const double& value) { return Json(value); }};
}

Codec<float> real_float(const Range& range) {
    return {number_schema(range), "a number " + range.words(),
            [range](const Json& json) { return float_number(json, range); },
            [](const float& value) { return Json(shortest_decimal(value)); }};
}

Codec<int> whole(int low, int high) {
    const Range range{static_cast<double>(low), static_cast<double>(high)};
    Json schema = {{"type", "integer"}, {"minimum", low}, {"maximum", high}};
    return {schema, "a whole number " + range.words(),
            [range](const Json& json) -> std::optional<int> {
                const std::optional<double> value = number(json, range);
                return value && *value == std::floor(*value) ? std::optional<int>(static_cast<int>(*value))
                                                             : std::nullopt;
            },
            [](const int& value) { return Json(value); }};
}

Codec<std::uint64_t> mebibytes(double low, double high) {
    const Range range{low, high};
    return {number_schema(range), "a number of MiB " + range.words(),
            [range](const Json& json) -> std::optional<std::uint64_t> {
                const std::optional<double> value = number(json, range);
                return value ? std::optional<std::uint64_t>(std::llround(*value * kMebibyte)) : std::nullopt;
            },
            [](const std::uint64_t& bytes) { return Json(static_cast<double>(bytes) / kMebibyte); }};
}

Codec<bool> flag() {
    return {{{"type", "boolean"}},
            "true or false",
            [](const Json& json) { return json.is_boolean() ? std::optional<bool>(json.get<bool>()) : std::nullopt; },
            [](const bool& value) { return Json(value); }};
}

Codec<std::string> text(bool may_be_empty) {
    Json schema = {{"type", "string"}};
    if (!may_be_empty)
        schema["minLength"] = 1;
    return {schema, may_be_empty ? "text in quotes" : "text in quotes that is not empty",
            [may_be_empty](const Json& json) -> std::optional<std::string> {
                if (!json.is_string() || (json.get_ref<const std::string&>().empty() && !may_be_empty))
                    return std::nullopt;
                return json.get<std::string>();
            },
            [](const std::string& value) { return Json(value); }};
}

Codec<std::optional<std::string>> optional_text() {
    using Value = std::optional<std::string>;
    return {{{"type", {"string", "null"}}},
            "text in quotes or null",
            [](const Json& json) -> std::optional<Value> {
                if (json.is_null())
                    return std::optional<Value>(Value());
                return json.is_string() ? std::optional<Value>(json.get<std::string>()) : std::nullopt;
            },
            [](const Value& value) { return value ? Json(*value) : Json(nullptr); }};
}

Codec<Rgb> rgb(const Range& range) {
    return {rgb_schema(range), "a number " + range.words() + " or three of them [r, g, b]",
            [range](const Json& json) { return read_rgb(json, range); },
            [](const Rgb& value) { return write_rgb(value); }};
}

Codec<dvec3> point() {
    return {array_schema(number_schema(coordinate()), 3), "three numbers [x, y, z] " + coordinate().words(),
            [](const Json& json) -> std::optional<dvec3> {
                const auto v = numbers(json, 3, [](const Json& item) { return number(item, coordinate()); });
                return v.empty() ? std::nullopt : std::optional<dvec3>(dvec3(v[0], v[1], v[2]));
            },
            [](const dvec3& value) {
                return Json{value.x, value.y, value.z};
            }};
}

Codec<vec2> pair_of(const Range& range) {
    return {array_schema(number_schema(range), 2), "two numbers " + range.words(),
            [range](const Json& json) -> std::optional<vec2> {
                const auto v = numbers(json, 2, [&](const Json& item) { return float_number(item, range); });
                return v.empty() ? std::nullopt : std::optional<vec2>(vec2(v[0], v[1]));
            },
            [](const vec2& value) {
                return Json{shortest_decimal(value.x), shortest_decimal(value.y)};
            }};
}

Codec<dmat4> matrix() {
    return {array_schema(number_schema(coordinate()), 16), "16 numbers " + coordinate().words() + ", row after row",
            [](const Json& json) -> std::optional<dmat4> {
                const auto v = numbers(json, 16, [](const Json& item) { return number(item, coordinate()); });
                dmat4 m(1.0);
                for (std::size_t i = 0; i < v.size(); ++i)
                    m[static_cast<int>(i % 4)][static_cast<int>(i / 4)] = v[i];
                return v.empty() ? std::nullopt : std::optional<dmat4>(m);
            },
            [](const dmat4& m) {
                Json numbers = Json::array();
                for (int i = 0; i < 16; ++i)
                    numbers.push_back(m[i % 4][i / 4]);
                return numbers;
            }};
}

Codec<char> up_axis() {
    return choice<char>({{"y", 'y'}, {"z", 'z'}});
}

Codec<FireModel> fire_model() {
    return choice<FireModel>({{"none", FireModel::None},
                              {"flame", FireModel::Flame},
                              {"blackbody", FireModel::Blackbody},
                              {"blackbody_normalized", FireModel::NormalizedBlackbody}});
}

Codec<std::vector<RampStop>> ramp() {
    const Json stop = {{"type", "array"},
                       {"prefixItems", Json::array({number_schema(grid_value()), rgb_schema(tint())})},
                       {"items", false},
                       {"minItems", 2},
                       {"maxItems", 2}};
    return {{{"type", "array"}, {"items", stop}},
            "a list of [value, [r, g, b]] with rising values and colours " + tint().words(),
            read_ramp,
            [](const std::vector<RampStop>& stops) {
                Json list = Json::array();
                for (const RampStop& stop : stops)
                    list.push_back(Json::array({shortest_decimal(stop.value), write_rgb(stop.colour)}));
                return list;
            }};
}

}  // namespace brisance
