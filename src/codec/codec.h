// A codec converts one JSON value to one setting and back. It states what it accepts: in code, in words and as JSON
// Schema.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/vec.h"
#include "medium/settings.h"

namespace brisance {

using Json = nlohmann::ordered_json;

// The part of a value that was not accepted.
struct Mismatch {
    std::string path;  // from the value: "[2].radius"; empty: the value itself
    std::string expected;
    Json value;
};

template <class T>
struct Codec {
    Json schema;                                        // JSON Schema of the accepted values
    std::string expected;                               // the same in words, after "expected"
    std::function<std::optional<T>(const Json&)> read;  // absent: not accepted
    std::function<Json(const T&)> write;
    std::function<std::optional<Mismatch>(const Json&)> find_mismatch = {};  // of values with parts; else empty
};

// Bounds are included unless the flag beside them says otherwise.
struct Range {
    double low;
    double high;
    bool without_low = false;
    bool without_high = false;
    bool contains(double value) const;
    std::string words() const;  // "in [0, 1]", "at least 0", "of any size"
    void add_to(Json& schema) const;
};

Range at_least(double low);
Range above(double low);
Range any_number();

// What light transport multiplies and sums in single precision, which ends at 3.4e38.
Range radiometric();  // strengths, powers, radiance, extinction: up to 1e20
Range tint();         // colours that multiply those: up to 1e6
Range grid_value();   // up to 1e20, of either sign
Range kelvin();       // up to 1e8
Range coordinate();   // up to 1e15 m, of either sign

Codec<double> real(const Range& range);
Codec<float> real_float(const Range& range);
Codec<int> whole(int low, int high);
Codec<std::uint64_t> mebibytes(double low, double high);  // given as MiB, held as bytes
Codec<bool> flag();
Codec<std::string> text(bool may_be_empty);
Codec<std::optional<std::string>> optional_text();  // null: absent
Codec<Rgb> rgb(const Range& range);                 // one number for gray, or three
Codec<dvec3> point();
Codec<vec2> pair_of(const Range& range);
Codec<dmat4> matrix();                // 16 numbers, row after row
Codec<std::vector<RampStop>> ramp();  // [[value, [r, g, b]], ...], values rising

Codec<char> up_axis();  // 'y' or 'z'
Codec<FireModel> fire_model();

// A value that may be absent: null.
template <class T>
Codec<std::optional<T>> if_given(const Codec<T>& codec) {
    Codec<std::optional<T>> result;
    result.expected = codec.expected + ", or null";
    result.schema = {{"anyOf", Json::array({codec.schema, Json{{"type", "null"}}})}};
    result.read = [codec](const Json& json) -> std::optional<std::optional<T>> {
        if (json.is_null())
            return std::optional<T>();
        std::optional<T> value = codec.read(json);
        return value ? std::optional<std::optional<T>>(std::move(value)) : std::nullopt;
    };
    result.write = [codec](const std::optional<T>& value) -> Json { return value ? codec.write(*value) : Json(); };
    return result;
}

// The shortest decimal that reads back as this float.
double shortest_decimal(float value);

// One of several words. A value may have several words: all of them are read, and the first is written.
template <class E>
Codec<E> choice(std::vector<std::pair<std::string, E>> words) {
    Codec<E> codec;
    Json names = Json::array();
    for (const auto& [word, value] : words) {
        codec.expected += (names.empty() ? "\"" : ", \"") + word + "\"";
        names.push_back(word);
    }
    codec.expected = "one of " + codec.expected;
    codec.schema = {{"enum", names}};
    codec.read = [words](const Json& json) -> std::optional<E> {
        for (const auto& [word, value] : words)
            if (json == word)
                return value;
        return std::nullopt;
    };
    codec.write = [words](const E& wanted) -> Json {
        for (const auto& [word, value] : words)
            if (value == wanted)
                return word;
        return nullptr;
    };
    return codec;
}

// Either a word that denotes `value`, or a value that `codec` accepts.
template <class T>
Codec<T> or_word(Codec<T> codec, const std::string& word, const T& value) {
    Codec<T> result;
    result.expected = "\"" + word + "\" or " + codec.expected;
    result.schema = {{"anyOf", Json::array({Json{{"const", word}}, codec.schema})}};
    result.read = [codec, word, value](const Json& json) -> std::optional<T> {
        return json == word ? std::optional<T>(value) : codec.read(json);
    };
    result.write = [codec, word, value](const T& t) -> Json { return t == value ? Json(word) : codec.write(t); };
    return result;
}

}  // namespace brisance
